//! Sections 2 to 6: elements, coordinates, contact, integration, and the set-up.

use super::Decide;
use crate::ensembles::MESHES;
use crate::evidence::ALUMINIUM;
use crate::runs::DURATION;
use crate::signal::peak;
use crate::variants::mesh_name;
use crate::verdict::{CriterionVerdict, above, between, holds};
use minijinja::context;

/// The predicates.
pub const DECISIONS: [Decide; 20] = [
    ("coordinates", |e| {
        holds(e.number("coordinates") == 27.0).alone()
    }),
    // the integrand of eq. 10 contains only the shape functions
    ("mass", |_| CriterionVerdict::Holds.alone()),
    ("invariants", |e| {
        holds(e.number("invariants_worst") < 1e-14).alone()
    }),
    ("efficiency", |e| {
        let times = &e.ensembles().timings;
        holds(times.literal < times.gauss).alone()
    }),
    ("most time", |e| {
        let t = &e.ensembles().timings;
        let part = |one: f64| {
            let elastic = t.evaluations * one;
            elastic / (t.step - t.evaluations * t.reduced + elastic)
        };
        let (literal, reduced) = (part(t.literal), part(t.reduced));
        (holds(literal > 0.5), context! { literal, reduced })
    }),
    ("no constraints", |e| {
        holds(e.number("multipliers") == 0.0).alone()
    }),
    ("located", |e| {
        let all = e.both("unlocated");
        let missed = all.iter().sum::<f64>();
        let values = context! { runs => all.len(), missed => missed as u32 };
        (holds(missed == 0.0), values)
    }),
    ("dissipates", |e| {
        above(&e.means("contact_dissipated"), 0.0).alone()
    }),
    ("restitution", |e| {
        let part = e.number("delivered") / e.number("restitution");
        holds((part - 1.0).abs() < 0.01).alone()
    }),
    ("two sources", |e| {
        let meshes = MESHES.map(|n| e.single(&mesh_name(n), "deviation_frequency"));
        let change = peak(&meshes.map(|f| f / meshes[0] - 1.0));
        let impacts = above(&[e.chaotic(3).mean("deviation_frequency")], 50.0);
        (impacts.min(holds(change > 0.1)), context! { meshes })
    }),
    ("bathe", |e| {
        // the last row of a run is an interval from its end at most
        let reached = e.number("reached") > DURATION - 1e-4;
        holds(reached && e.number("first_substep") == 0.5).alone()
    }),
    ("geometry", |e| {
        let printed = [
            ("crank", 0.245),
            ("link", 0.242),
            ("moving", 0.112),
            ("fixed", 0.4),
            ("clearance", 2e-5),
        ];
        // digits as printed in Tables 1 and 2; numbers are kept to nine digits
        let same = |(name, length): &(&str, f64)| (e.number(name) / length - 1.0).abs() < 1e-8;
        holds(printed.iter().all(same)).alone()
    }),
    ("sections", |e| {
        let same = |name: &str, printed: f64| (e.number(name) / printed - 1.0).abs() < 1e-8;
        let met = same("driving_area", 0.015 * 0.03)
            && same("passive_area", 0.005 * 0.03)
            && same("second_moment", 0.03 * 0.005_f64.powi(3) / 12.0);
        holds(met).alone()
    }),
    ("cases", |e| {
        let of = |what: &str| [1, 2, 3, 4].map(|case| e.number(&format!("{what}_{case}")) as u32);
        let (flexible, loose) = (of("flexible_links"), of("loose_joints"));
        let met = flexible == [0, 3, 0, 3] && loose == [0, 0, 6, 6];
        (holds(met), context! { flexible, loose })
    }),
    ("normal clearance", |e| {
        let relative = e.number("clearance") / e.number("bearing_radius");
        between(relative, 0.0005, 0.003).alone()
    }),
    ("modulus", |e| {
        between(e.number("modulus") / ALUMINIUM, 0.8, 1.2).alone()
    }),
    ("trajectory", |e| {
        holds(e.number("path_error") < 1e-9 && e.number("path") == 0.1).alone()
    }),
    ("concentric", |e| {
        let limit = 1e-6 * e.number("clearance");
        holds(e.run("both", "start_eccentricity") < limit).alone()
    }),
    ("velocities", |e| {
        holds(e.number("start_speed_error") < 1e-9).alone()
    }),
    ("steady", |e| {
        holds(e.steps("settling").iter().all(|s| *s < 0.1)).alone()
    }),
];

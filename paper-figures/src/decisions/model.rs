//! Sections 2 to 6: elements, coordinates, contact, integration, and the set-up.

use super::{Decide, above, between, holds};
use crate::ensembles::{MESHES, mesh_name};
use crate::runs::DURATION;
use crate::verdict::CriterionVerdict;
use minijinja::context;

/// Young's modulus of aluminium \[Pa\].
const ALUMINIUM: f64 = 70e9;

/// The predicates.
pub const DECISIONS: [Decide; 20] = [
    ("coordinates", |e| {
        let count = e.number("coordinates");
        (holds(count == 27.0), context! { count => count as u32 })
    }),
    // the integrand of eq. 10 contains only the shape functions
    ("mass", |e| {
        let elements = e.number("elements") as u32;
        (CriterionVerdict::Holds, context! { elements })
    }),
    ("invariants", |e| {
        let worst = e.number("invariants_worst");
        (holds(worst < 1e-14), context! { worst })
    }),
    ("efficiency", |e| {
        let t = e.timings();
        let (literal, reduced) = (t.literal / t.gauss, t.reduced / t.gauss);
        (holds(literal < 1.0), context! { literal, reduced })
    }),
    ("most time", |e| {
        let t = e.timings();
        let part = |one: f64| {
            let elastic = t.evaluations * one;
            elastic / (t.step - t.evaluations * t.reduced + elastic)
        };
        let (literal, reduced) = (part(t.literal), part(t.reduced));
        let values = context! { literal, reduced, evaluations => t.evaluations };
        (holds(literal > 0.5), values)
    }),
    ("no constraints", |e| {
        let [unknowns, multipliers] = ["unknowns", "multipliers"].map(|name| e.number(name) as u32);
        (holds(multipliers == 0), context! { unknowns, multipliers })
    }),
    ("located", |e| {
        let all = [3, 4].map(|case| e.chaotic(case).values("unlocated"));
        let all = all.concat();
        let missed = all.iter().sum::<f64>();
        let values = context! {
            runs => all.len(), missed => missed as u32,
            tolerance => e.number("onset_tolerance"), trials => e.means("trials_a_change"),
        };
        (holds(missed == 0.0), values)
    }),
    ("dissipates", |e| {
        let lost = e.means("contact_dissipated");
        (above(&lost, 0.0), context! { lost })
    }),
    ("restitution", |e| {
        let [typed, delivered] = ["restitution", "delivered"].map(|name| e.number(name));
        let met = (delivered / typed - 1.0).abs() < 0.01;
        (holds(met), context! { typed, delivered })
    }),
    ("two sources", |e| {
        let impacts = e.chaotic(3).mean("deviation_frequency");
        let meshes = MESHES.map(|n| e.single(&mesh_name(n), "deviation_frequency"));
        let change = meshes.map(|f| (f / meshes[0] - 1.0).abs());
        let change = change.into_iter().fold(0.0, f64::max);
        let verdict = above(&[impacts], 50.0);
        let verdict = verdict.and(holds(change > 0.1));
        (verdict, context! { impacts, meshes })
    }),
    ("bathe", |e| {
        let [gamma, reached] = ["first_substep", "reached"].map(|name| e.number(name));
        // the last row of a run is an interval from its end at most
        let met = gamma == 0.5 && reached > DURATION - 1e-4;
        (holds(met), context! { gamma, reached })
    }),
    ("geometry", |e| {
        let names = ["crank", "link", "moving", "fixed"];
        let (lengths, clearance) = (names.map(|name| e.number(name)), e.number("clearance"));
        // digits as printed in Tables 1 and 2; numbers are kept to nine digits
        let same = |(a, b): (&f64, f64)| (a - b).abs() < 1e-8 * b;
        let met = lengths.iter().zip([0.245, 0.242, 0.112, 0.4]).all(same);
        let met = met && same((&clearance, 2e-5));
        (holds(met), context! { lengths, clearance })
    }),
    ("sections", |e| {
        let names = ["driving_area", "passive_area", "second_moment"];
        let [driving, passive, bending] = names.map(|name| e.number(name));
        let same = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-8;
        let met = same(driving, 0.015 * 0.03)
            && same(passive, 0.005 * 0.03)
            && same(bending, 0.03 * 0.005_f64.powi(3) / 12.0);
        (holds(met), context! { driving, passive, bending })
    }),
    ("cases", |e| {
        let of = |what: &str| [1, 2, 3, 4].map(|case| e.number(&format!("{what}_{case}")) as u32);
        let (flexible, loose) = (of("flexible_links"), of("loose_joints"));
        let met = flexible == [0, 3, 0, 3] && loose == [0, 0, 6, 6];
        (holds(met), context! { flexible, loose })
    }),
    ("normal clearance", |e| {
        let radius = e.number("bearing_radius");
        let relative = e.number("clearance") / radius;
        let verdict = between(relative, 0.0005, 0.003);
        (verdict, context! { relative, radius })
    }),
    ("modulus", |e| {
        let modulus = e.number("modulus");
        let values = context! { modulus, aluminium => ALUMINIUM };
        (between(modulus / ALUMINIUM, 0.8, 1.2), values)
    }),
    ("trajectory", |e| {
        let [error, radius] = ["path_error", "path"].map(|name| e.number(name));
        e.run("ideal", "error_peak");
        let verdict = holds(error < 1e-9 && radius == 0.1);
        (verdict, context! { error, radius })
    }),
    ("concentric", |e| {
        let largest = e.run("both", "start_eccentricity");
        let limit = 1e-6 * e.number("clearance");
        (holds(largest < limit), context! { largest })
    }),
    ("velocities", |e| {
        let apart = e.number("start_speed_error");
        (holds(apart < 1e-9), context! { apart })
    }),
    ("steady", |e| {
        let settling = e.steps("settling");
        let met = settling.iter().all(|s| *s < 0.1);
        (holds(met), context! { settling })
    }),
];

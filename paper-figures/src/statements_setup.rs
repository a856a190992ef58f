//! Statements about the model and the set-up: abstract, section 3 and the start of section 6.

use crate::campaign::{Campaign, DURATION};
use crate::measures::AllMeasures;
use crate::numbers::Numbers;
use crate::runs::Recording;
use crate::signal::peak;
use crate::statement::Statement;
use looselink::scene::{BodyKind, JointModel, LinkModel, Method};
use plot::{digits, percent, si};

/// Young's modulus of aluminium \[Pa\].
const ALUMINIUM: f64 = 70e9;

/// The statements.
pub fn statements(c: &Campaign, m: &AllMeasures, numbers: &mut Numbers) -> Vec<Statement> {
    vec![
        represents_well(c, numbers),
        coordinates(c, numbers),
        bathe(c),
        geometry(c),
        cases(c),
        normal_clearance(c, numbers),
        modulus(c, numbers),
        trajectory(c, numbers),
        concentric_start(c, numbers),
        steady(m),
    ]
}

fn represents_well(c: &Campaign, numbers: &mut Numbers) -> Statement {
    let mut share = |r: &Recording, name: &str| {
        let numerical = r
            .column("energy.numerical")
            .last()
            .map_or(f64::NAN, |e| e.abs());
        numbers.put(
            format!("{name}.numerical_energy_share"),
            numerical / peak(r.column("energy.kinetic")),
        )
    };
    let shares = [
        share(&c.flexible, "case2"),
        share(&c.loose, "case3"),
        share(&c.both, "case4"),
    ];
    Statement {
        place: "Abstract",
        says: "The methodology can represent the dynamic performances of the system with link flexibility and joint clearance well.",
        measured: format!(
            "Energy lost or gained by the integrator alone in three cycles, over the largest kinetic energy: case 2 {}, case 3 {}, case 4 {} (h = {}).",
            percent(shares[0]), percent(shares[1]), percent(shares[2]), si(c.settings.fine, "s")
        ),
        criterion: "below 1 % in every case, so that what is seen is the model and not the integrator",
        holds: shares.iter().all(|s| *s < 0.01),
        factor: None,
        why: "The paper compares with no measurement and no second code; the energy ledger is the part of the claim that a run can decide.".into(),
    }
}

fn coordinates(c: &Campaign, numbers: &mut Numbers) -> Statement {
    let of = |kind: &BodyKind| match kind {
        BodyKind::Link(link) => match link.model {
            LinkModel::Flexible { elements, .. } => 4 * (elements + 1),
            LinkModel::Rigid => 0,
        },
        BodyKind::Rigid(_) => 3,
        _ => 0,
    };
    let count: usize = c.both.scene.bodies.iter().map(|b| of(&b.kind)).sum();
    numbers.put("case4.coordinates", count as f64);
    Statement {
        place: "Sect. 3, 7",
        says: "Natural coordinates for rigid and ANCF for flexible links lower the global coordinates: 27 in all, 24 of the flexible links and 3 of the platform.",
        measured: format!("The scene of case 4 has {count}; separate coordinates of three cranks would add 12."),
        criterion: "the count is 27",
        holds: count == 27,
        factor: Some(count as f64 / 27.0),
        why: "Cubic elements have 4 coordinates a node, one element a link gives 3 x 8; the pins B_i are driven and shared.".into(),
    }
}

fn bathe(c: &Campaign) -> Statement {
    let gamma = match c.both.scene.integrator.method {
        Method::Bathe { gamma, .. } => gamma,
        _ => f64::NAN,
    };
    Statement {
        place: "Abstract, Sect. 5",
        says: "The two-step Bathe method with two equal sub-steps solves the motion equations.",
        measured: format!("All runs use it with a first sub-step of {} h and reach {DURATION} s.", digits(gamma)),
        criterion: "the first sub-step is h/2 and all runs reach the end",
        holds: gamma == 0.5 && [&c.flexible, &c.loose, &c.both].iter().all(|r| r.t.last().is_some_and(|t| *t > DURATION - r.plan.step)),
        factor: None,
        why: "The paper prints no step. Without damping the step decides how long vibration lasts, so every row here says which was used.".into(),
    }
}

fn geometry(c: &Campaign) -> Statement {
    let g = &c.geometry;
    let radius = |p: [f64; 2]| p[0].hypot(p[1]);
    let read = [
        g.crank,
        g.link,
        radius(g.platform[0]),
        radius(g.base[0]),
        g.clearance,
    ];
    // digits as printed in Tables 1 and 2
    let holds = read
        .iter()
        .zip([0.245, 0.242, 0.112, 0.4, 2e-5])
        .all(|(r, p)| (r - p).abs() < 1e-9 * p);
    Statement {
        place: "Tables 1, 2",
        says: "Driving link 0.245 m, passive link 0.242 m, moving stage 0.112 m, fixed stage 0.4 m (circumradii), clearance 0.02 mm.",
        measured: format!("The scenes have {} m and a clearance of {}.", read[..4].iter().map(|v| digits(*v)).collect::<Vec<_>>().join(", "), si(read[4], "m")),
        criterion: "equal to the printed digits",
        holds,
        factor: None,
        why: "Not printed and therefore assumed: density, bearing radius, contact material, restitution, friction, elbow branch. The scenes mark each of them.".into(),
    }
}

fn cases(c: &Campaign) -> Statement {
    let read = |r: &Recording| {
        let link = r.scene.body("link1").map(|b| &r.scene.bodies[b].kind);
        let flexible = matches!(link, Some(BodyKind::Link(l)) if l.model != LinkModel::Rigid);
        let loose = |j: &looselink::scene::Joint| matches!(j.model, JointModel::Clearance(_));
        (flexible, r.scene.joints.iter().filter(|j| loose(j)).count())
    };
    let read = [&c.ideal, &c.flexible, &c.loose, &c.both].map(read);
    let words = |(flexible, loose): (bool, usize)| {
        format!(
            "{} links, {loose} loose joints",
            if flexible { "flexible" } else { "rigid" }
        )
    };
    Statement {
        place: "Sect. 6, Table 2",
        says: "Case 1: rigid passive links without clearance; 2: flexible, without; 3: rigid, with clearance; 4: flexible, with clearance in the six joints B and C.",
        measured: format!("The scenes have: {}.", read.map(words).join("; ")),
        criterion: "as stated",
        holds: read == [(false, 0), (true, 0), (false, 6), (true, 6)],
        factor: None,
        why: "Cranks and platform are rigid in all cases, the drives have no backlash.".into(),
    }
}

fn normal_clearance(c: &Campaign, numbers: &mut Numbers) -> Statement {
    let radius = c
        .both
        .scene
        .joint("B1")
        .and_then(|j| match &c.both.scene.joints[j].model {
            JointModel::Clearance(contact) => Some(contact.bearing_radius),
            _ => None,
        });
    let relative = numbers.put(
        "relative_clearance",
        c.geometry.clearance / radius.unwrap_or(f64::NAN),
    );
    Statement {
        place: "Sect. 6",
        says: "0.02 mm is a normal clearance in a typical bearing with nominal dimensions.",
        measured: format!(
            "Radial clearance over bearing radius: {}.",
            digits(relative)
        ),
        criterion: "between 0.0005 and 0.003, the usual range of plain bearings",
        holds: (0.0005..=0.003).contains(&relative),
        factor: None,
        why: format!(
            "The paper prints no bearing radius; {} is assumed.",
            si(radius.unwrap_or(f64::NAN), "m")
        ),
    }
}

fn modulus(c: &Campaign, numbers: &mut Numbers) -> Statement {
    let of = |kind: &BodyKind| match kind {
        BodyKind::Link(looselink::scene::Link {
            model: LinkModel::Flexible { youngs_modulus, .. },
            ..
        }) => Some(*youngs_modulus),
        _ => None,
    };
    let modulus = c
        .flexible
        .scene
        .bodies
        .iter()
        .find_map(|b| of(&b.kind))
        .unwrap_or(f64::NAN);
    numbers.put("youngs_modulus", modulus);
    Statement {
        place: "Sect. 6, Table 2",
        says: "The Young's modulus of the passive links is 7 GPa for aluminium.",
        measured: format!(
            "The scenes have {}; aluminium has {}.",
            si(modulus, "Pa"),
            si(ALUMINIUM, "Pa")
        ),
        criterion: "within 20 % of the modulus of aluminium",
        holds: (modulus / ALUMINIUM - 1.0).abs() < 0.2,
        factor: None,
        why: format!(
            "Kept as printed, although aluminium is {} times stiffer: a slip of the decimal point or a deliberately soft link.",
            digits(ALUMINIUM / modulus)
        ),
    }
}

fn trajectory(c: &Campaign, numbers: &mut Numbers) -> Statement {
    let error = numbers.put(
        "case1.largest_error",
        peak(c.ideal.column("error.x")).max(peak(c.ideal.column("error.y"))),
    );
    Statement {
        place: "Sect. 6, eq. 27",
        says: "The preset trajectory is a circle of 0.1 m at 1 Hz; the inputs follow from the inverse kinematics of the ideal rigid mechanism.",
        measured: format!(
            "Case 1 stays within {} of the circle of {} m (h = {}).",
            si(error, "m"),
            digits(c.geometry.radius),
            si(c.settings.coarse, "s")
        ),
        // solved positions: Newton tolerance of a velocity times a step, far below any clearance
        criterion: "within 1 nm",
        holds: error < 1e-9 && c.geometry.radius == 0.1,
        factor: None,
        why: "Case 1 has no degree of freedom: its motion is the inverse kinematics.".into(),
    }
}

fn concentric_start(c: &Campaign, numbers: &mut Numbers) -> Statement {
    let start = |joint: &str| c.both.column(&format!("{joint}.eccentricity"))[0];
    let largest = ["B1", "B2", "B3", "C1", "C2", "C3"]
        .map(start)
        .into_iter()
        .fold(0.0, f64::max);
    numbers.put("case4.eccentricity_at_start", largest);
    Statement {
        place: "Sect. 6",
        says: "At t = 0 the journal and bearing centres coincide.",
        measured: format!("Largest eccentricity at the start of case 4: {}.", si(largest, "m")),
        criterion: "below a millionth of the clearance",
        holds: largest < 1e-6 * c.geometry.clearance,
        factor: None,
        why: "The normal of eq. 20 does not exist there; no contact law is evaluated before the gap closes.".into(),
    }
}

fn steady(m: &AllMeasures) -> Statement {
    Statement {
        place: "Sect. 6",
        says: "Results are taken for two full cycles after the system runs steadily.",
        measured: format!(
            "Case 2, vibration (rms deviation of the acceleration from case 1) in the third cycle over that in the first: {} at h = {}, {} at h = {}.",
            digits(m.flexible.settling), si(m.flexible.step, "s"), digits(m.flexible_coarse.settling), si(m.flexible_coarse.step, "s")
        ),
        criterion: "below 0.1 at both steps",
        holds: m.flexible.settling < 0.1 && m.flexible_coarse.settling < 0.1,
        factor: None,
        why: "The links start unstrained and nothing in the model damps them; only the integrator does, and the more the coarser its step. \"Steady\" is a property of the step.".into(),
    }
}

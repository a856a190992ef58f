//! Statements about the set-up: tables 1 and 2 and the start of section 6.

use crate::evidence::{Evidence, statement};
use crate::interval::CriterionVerdict;
use crate::measures::Measures;
use crate::runs::CaseRecording;
use crate::signal::peak;
use crate::statement::{Basis, Statement};
use looselink::body::{FlexibleLink, Link};
use looselink::scene::Scene;
use numbers::{digits, percent, si};

/// Young's modulus of aluminium \[Pa\].
const ALUMINIUM: f64 = 70e9;

/// The statements.
pub fn statements(e: &Evidence) -> Vec<Statement> {
    vec![
        geometry(e),
        sections(e),
        cases(e),
        normal_clearance(e),
        modulus(e),
        trajectory(e),
        concentric_start(e),
        ideal_velocities(e),
        steady(e),
    ]
}

fn geometry(e: &Evidence) -> Statement {
    let g = &e.c.geometry;
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
    let lengths: Vec<String> = read[..4].iter().map(|v| digits(*v)).collect();
    Statement {
        measured: format!("the scenes have the lengths {} m and a clearance of {}.", lengths.join(", "), si(read[4], "m")),
        criterion: "equal to the printed digits",
        verdict: CriterionVerdict::of(holds),
        basis: Basis::Construction,
        why: "Density, bearing radius, contact material, restitution, friction and elbow branch are not printed. They are assumed and marked in the scenes.".into(),
        ..statement("geometry", "Tables 1, 2", "Driving link 0.245 m, passive link 0.242 m, moving stage 0.112 m, fixed stage 0.4 m (circumradii), clearance 0.02 mm.")
    }
}

fn link<'a>(scene: &'a Scene, name: &str) -> Option<&'a Link> {
    scene.bodies[scene.body(name)?].kind.link()
}

/// Area \[m2\] of the section of a link.
fn area(scene: &Scene, name: &str) -> f64 {
    link(scene, name).map_or(f64::NAN, |link| link.area)
}

/// Second moment of area \[m4\] of a flexible link.
fn second_moment(scene: &Scene, name: &str) -> f64 {
    link(scene, name).map_or(f64::NAN, |link| link.second_moment)
}

fn sections(e: &Evidence) -> Statement {
    let scene = &e.c.both.scene;
    let (driving, passive) = (area(scene, "crank1"), area(scene, "link1"));
    let bending = second_moment(scene, "link1");
    let close = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
    let holds = close(driving, 0.015 * 0.03)
        && close(passive, 0.005 * 0.03)
        && close(bending, 0.03 * 0.005_f64.powi(3) / 12.0);
    Statement {
        measured: format!(
            "areas {} and {} m², second moment of area of the passive links {} m⁴.",
            digits(driving),
            digits(passive),
            digits(bending)
        ),
        criterion: "those of the printed rectangles; the passive links bend about the axis of the 0.03 m side",
        verdict: CriterionVerdict::of(holds),
        basis: Basis::Construction,
        why: "The width is assumed to lie in the plane of motion, the height normal to it. The mass of the platform is that of a solid triangular plate, which is assumed.".into(),
        ..statement("sections", "Table 1", "Sections: driving link 0.015 m × 0.03 m, passive link 0.005 m × 0.03 m; moving stage 0.01 m thick.")
    }
}

fn cases(e: &Evidence) -> Statement {
    let c = e.c;
    let read = |r: &CaseRecording| {
        let link = r.scene.body("link1").map(|b| &r.scene.bodies[b].kind);
        let flexible = link.is_some_and(|link| !link.is_rigid());
        let loose = r.scene.joints.iter().filter(|j| j.contact().is_some());
        (flexible, loose.count())
    };
    let read = [&c.ideal, &c.flexible, &c.loose, &c.both].map(read);
    let words = |(flexible, loose): (bool, usize)| {
        format!(
            "{} links, {loose} loose joints",
            if flexible { "flexible" } else { "rigid" }
        )
    };
    Statement {
        measured: format!("the scenes have: {}.", read.map(words).join("; ")),
        criterion: "as stated",
        verdict: CriterionVerdict::of(read == [(false, 0), (true, 0), (false, 6), (true, 6)]),
        basis: Basis::Construction,
        why: "Cranks and platform are rigid in all cases; the drives have no backlash.".into(),
        ..statement(
            "cases",
            "Sect. 6, Table 2",
            "Case 1: rigid passive links without clearance; 2: flexible, without; 3: rigid, with clearance; 4: flexible, with clearance in the six joints B and C.",
        )
    }
}

fn normal_clearance(e: &Evidence) -> Statement {
    let scene = &e.c.both.scene;
    let contact = scene.joint("B1").and_then(|j| scene.joints[j].contact());
    let radius = contact.and_then(|contact| contact.bearing_radius);
    let radius = radius.unwrap_or(f64::NAN);
    let relative = e.c.geometry.clearance / radius;
    Statement {
        measured: format!(
            "radial clearance over bearing radius: {}.",
            percent(relative)
        ),
        criterion: "between 0.05 % and 0.3 %, the usual range of plain bearings",
        verdict: CriterionVerdict::of((0.0005..=0.003).contains(&relative)),
        basis: Basis::Assumption,
        why: format!(
            "The paper prints no bearing radius; {} is assumed.",
            si(radius, "m")
        ),
        ..statement(
            "normal clearance",
            "Sect. 6",
            "0.02 mm is a normal clearance in a typical bearing with nominal dimensions.",
        )
    }
}

fn modulus(e: &Evidence) -> Statement {
    let bodies = e.c.flexible.scene.bodies.iter();
    let mut links = bodies.filter_map(|b| b.kind.get::<FlexibleLink>());
    let modulus = links.next().map_or(f64::NAN, |link| link.youngs_modulus);
    Statement {
        measured: format!(
            "the scenes have {}; aluminium has {}.",
            si(modulus, "Pa"),
            si(ALUMINIUM, "Pa")
        ),
        criterion: "within 20 % of the modulus of aluminium",
        verdict: CriterionVerdict::of((modulus / ALUMINIUM - 1.0).abs() < 0.2),
        basis: Basis::Construction,
        why: format!(
            "The printed value is used, although aluminium is {} times as stiff. It may be a misprint or a deliberately soft link.",
            digits(ALUMINIUM / modulus)
        ),
        ..statement(
            "modulus",
            "Sect. 6, Table 2",
            "The Young's modulus of the passive links is 7 GPa for aluminium.",
        )
    }
}

fn trajectory(e: &Evidence) -> Statement {
    let ideal = &e.c.ideal;
    let error = peak(ideal.column("error.x")).max(peak(ideal.column("error.y")));
    Statement {
        measured: format!(
            "case 1 stays within {} of the circle of {} m.",
            si(error, "m"),
            digits(e.c.geometry.radius)
        ),
        // solved positions: Newton tolerance of a velocity times a step, far below any clearance
        criterion: "within 1 nm",
        verdict: CriterionVerdict::of(error < 1e-9 && e.c.geometry.radius == 0.1),
        basis: Basis::Construction,
        why: "Case 1 has no degree of freedom: its motion follows from the inverse kinematics."
            .into(),
        sources: vec![ideal.source()],
        ..statement(
            "trajectory",
            "Sect. 6, eq. 27",
            "The preset trajectory is a circle of 0.1 m at 1 Hz; the inputs follow from the inverse kinematics of the ideal rigid mechanism.",
        )
    }
}

fn concentric_start(e: &Evidence) -> Statement {
    let largest = Measures::of(&e.c.geometry, &e.c.both).get("start_eccentricity");
    Statement {
        measured: format!("largest eccentricity at the start of case 4: {}.", si(largest, "m")),
        criterion: "below a millionth of the clearance",
        verdict: CriterionVerdict::of(largest < 1e-6 * e.c.geometry.clearance),
        basis: Basis::Construction,
        why: "The normal of eq. 20 is undefined at the centre; no contact law is evaluated before the gap closes.".into(),
        sources: vec![e.c.both.source()],
        ..statement("concentric", "Sect. 6", "At t = 0 the journal and bearing centres coincide.")
    }
}

fn ideal_velocities(e: &Evidence) -> Statement {
    let g = &e.c.geometry;
    let first = |name: &str| e.c.both.column(name)[0];
    let speed = std::f64::consts::TAU * g.frequency * g.radius;
    let apart = first("platform.vx").hypot(first("platform.vy") - speed);
    Statement {
        measured: format!("the platform of case 4 starts within {} of the velocity of the ideal mechanism.", si(apart, "m/s")),
        criterion: "within 1 nm/s",
        verdict: CriterionVerdict::of(apart < 1e-9),
        basis: Basis::Construction,
        why: "Positions and velocities at t = 0 are those of the ideal mechanism; its accelerations are not, because the links are unstrained and the joints open.".into(),
        sources: vec![e.c.both.source()],
        ..statement("velocities", "Sect. 6", "The initial positions and velocities are those of the mechanism without link flexibility and joint clearance.")
    }
}

fn steady(e: &Evidence) -> Statement {
    let settling = [&e.flexible, &e.flexible_coarse].map(|m| m.get("settling"));
    Statement {
        measured: format!(
            "rms deviation from the ideal acceleration in the third cycle over that in the first, case 2: {} at the finer step, {} at the coarser.",
            digits(settling[0]),
            digits(settling[1])
        ),
        criterion: "below 0.1 at both steps",
        verdict: CriterionVerdict::of(settling.iter().all(|s| *s < 0.1)),
        why: "The links start unstrained and the model has no damping. Only the integrator damps, more with a coarser step, so the step decides whether the motion becomes steady.".into(),
        sources: e.case_2(),
        ..statement("steady", "Sect. 6", "Results are taken for two full cycles after the system runs steadily.")
    }
}

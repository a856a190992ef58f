//! Where equilibria lose their stability under a growing load: limit points and bifurcations.
//!
//! The energy of a link is EA/2 eps^2 + EI/2 r''.r'' with the Green strain eps. A straight column under a dead load P has the stretch
//! Lambda, P = EA Lambda (1 - Lambda^2)/2, and buckles as Euler's column with P/Lambda in place of P (EQUATIONS.md). The digits of
//! frame and arches are those of shooting and of collocation for the differential equations of the same energy, which agree to
//! 1e-11.

use ladder::{Rung, Worst};
use looselink::scene::Scene;
use looselink::simulate::{
    CriticalKind, CriticalPoint, Recording, Report, RunError, Simulation, Stability,
};
use std::f64::consts::{FRAC_PI_2, PI};

const MODULUS: f64 = 210e9;

/// A static scene whose load factor grows to 1.
fn statics(ground: &str, width: f64, parts: &str) -> String {
    format!(
        r#"
format = 1
title = "equilibria under a growing load"
simulation = {{ analysis = "static", duration = 1.0 }}
integrator = {{ step = 0.1 }}
output = {{ interval = 0.1, channels = ["points.*"] }}
materials.steel = {{ density = 7850.0, youngs_modulus = {MODULUS:e} }}
sections.bar = {{ width = {width:?}, height = {width:?} }}
bodies.ground = {{ type = "ground", {ground} }}
{parts}
"#
    )
}

fn link(name: &str, length: f64, elements: usize) -> String {
    format!(
        "bodies.{name} = {{ type = \"link\", model = \"flexible\", length = {length:?}, section = \"bar\", material = \"steel\", elements = {elements} }}\n"
    )
}

fn weld(name: &str, first: &str, second: &str, angle: f64) -> String {
    format!(
        "joints.{name} = {{ type = \"weld\", first = \"{first}\", second = \"{second}\", angle = {angle:?} }}\n"
    )
}

fn force(name: &str, point: &str, [x, y]: [f64; 2]) -> String {
    format!(
        "forces.{name} = {{ type = \"force\", point = \"{point}\", x = {x:?}, y = {y:?}, frame = \"ground\" }}\n"
    )
}

fn run(text: &str, overrides: &[&str]) -> (Result<(), RunError>, Recording, Report) {
    let overrides: Vec<String> = overrides.iter().map(|o| (*o).to_owned()).collect();
    let scene = Scene::parse("static", text, &overrides).unwrap_or_else(|e| panic!("{e:?}"));
    let mut simulation = Simulation::new(&scene).unwrap_or_else(|e| panic!("{e:?}"));
    let mut recording = Recording::new(&simulation);
    let ended = simulation.run(&mut recording);
    (ended, recording, simulation.report())
}

/// The first critical point of a load that grows to `load` \[N\], with its load.
fn first_critical(text: &str, load: f64) -> (CriticalPoint, f64) {
    match run(text, &[]).0 {
        Err(RunError::Limit(point)) => {
            let critical = point.part * load;
            (point, critical)
        }
        other => panic!("no limit: {other:?}"),
    }
}

/// The limit load of a von Mises truss, see below.
fn limit_of_truss(stiffness: f64, height: f64) -> f64 {
    let rest = 1.0_f64.hypot(height);
    let length = rest.cbrt();
    2.0 * stiffness * (length * length - 1.0).sqrt() * (rest / length - 1.0)
}

/// A von Mises truss under a load downwards and what else acts.
fn truss(stiffness: f64, height: f64, load: f64, also: &str) -> String {
    let rest = 1.0_f64.hypot(height);
    let spring = |name: &str, from: &str| {
        format!(
            "forces.{name} = {{ type = \"spring_damper\", from = \"ground.{from}\", to = \"apex.center\", stiffness = {stiffness:?}, damping = 0.0, rest_length = {rest:?} }}\n"
        )
    };
    let parts = "bodies.apex = { type = \"point_mass\", mass = 1.0 }\n".to_owned()
        + &spring("left", "A")
        + &spring("right", "B")
        + &force("load", "apex.center", [0.0, -load])
        + also
        + &format!("initial.bodies.apex = {{ x = 0.0, y = {height:?} }}\n");
    statics(
        "points.A = [-1.0, 0.0], points.B = [1.0, 0.0]",
        0.01,
        &parts,
    )
}

/// Two springs of stiffness k from (-1, 0) and (1, 0) to a mass at (0, h) under a load: F(y) = 2 k y (l0/l - 1) is largest where
/// l^3 = l0.
#[test]
fn a_von_mises_truss_snaps_at_its_limit_load() {
    let worst = Worst::new();
    for (stiffness, height) in [(1e4_f64, 0.1_f64), (1e4, 0.3), (1e9, 0.02)] {
        let limit = limit_of_truss(stiffness, height);
        let load = 1.4 * limit;
        let text = truss(stiffness, height, load, "");
        let (point, critical) = first_critical(&text, load);
        assert_eq!(point.kind, CriticalKind::Limit);
        assert_eq!(point.moves_most, "apex.center.y");
        worst.at(format!("height {height} m"));
        worst.see(critical / limit - 1.0);
        // followed, the truss snaps through, and at the end stands below its supports
        let (ended, recording, report) = run(&text, &["simulation.at_limit=follow"]);
        ended.unwrap();
        let kinds: Vec<_> = report.critical_points.iter().map(|p| p.kind).collect();
        assert_eq!(kinds, [CriticalKind::Limit; 2]);
        worst.at(format!("height {height} m, lower limit"));
        worst.see(report.critical_points[1].part * load / -limit - 1.0);
        assert_eq!(report.rest.unwrap().stability(), Stability::Stable);
        let heights = recording.get("points.apex.center.y").unwrap();
        assert!(*heights.last().unwrap() < -height);
    }
    Rung::ClosedForms
        .asks("Limit loads of von Mises trusses of three heights, the upper and the lower one: relative error")
        .within(&worst, 1e-9, "a point located to 1e-10 of a step has the square of this error in the load; the rest is rounding of a shallow truss");
}

/// How a column of length 1 m is held, and beta of P_E = beta^2 EI/L^2.
const COLUMNS: [(&str, f64); 3] = [
    ("clamped-free", FRAC_PI_2),
    ("pinned", PI),
    ("clamped", 2.0 * PI),
];

fn column(ends: &str, width: f64, elements: usize, load: f64) -> String {
    column_in(0.0, 17, ends, width, elements, load)
}

/// The column in a direction that is typed with so many digits.
fn column_in(
    direction: f64,
    digits: usize,
    ends: &str,
    width: f64,
    elements: usize,
    load: f64,
) -> String {
    let [x, y] = unit(direction, digits);
    let angle = typed(direction, digits);
    let guide = |rotation: &str| {
        format!(
            "joints.guide = {{ type = \"prismatic\", guide = \"ground.O\", direction = [{x:?}, {y:?}], slider = \"column.end\", rotation = {rotation} }}\n"
        )
    };
    let held = match ends {
        "clamped-free" => weld("foot", "ground.O", "column.start", angle),
        "pinned" => "joints.foot = { type = \"revolute\", bearing = \"ground.O\", journal = \"column.start\", model = \"ideal\" }\n".to_owned() + &guide("\"free\""),
        _ => weld("foot", "ground.O", "column.start", angle) + &guide(&format!("\"locked\", angle = {angle:?}")),
    };
    let parts = link("column", 1.0, elements)
        + &held
        + &force("load", "column.end", [-load * x, -load * y])
        + &format!(
            "initial.bodies.column = {{ point = \"start\", x = 0.0, y = 0.0, theta = {angle:?} }}\n"
        );
    statics("points.O = [0.0, 0.0]", width, &parts)
}

/// The critical load of a column of this energy, and Euler's.
fn critical_load(beta: f64, width: f64) -> [f64; 2] {
    let (area, second) = (width * width, width.powi(4) / 12.0);
    let euler = beta * beta * MODULUS * second;
    [euler * (1.0 - 2.0 * euler / (MODULUS * area)).sqrt(), euler]
}

/// Cubic elements of length h overestimate beta^2 by its part (beta h)^4/720.
#[test]
fn columns_buckle_at_the_load_of_their_energy() {
    let [loads, orders, slender] = [Worst::new(), Worst::new(), Worst::new()];
    for (ends, beta) in COLUMNS {
        for width in [0.1, 0.01] {
            let [exact, _] = critical_load(beta, width);
            let error = |elements: usize| {
                let load = 1.5 * exact;
                let (point, critical) = first_critical(&column(ends, width, elements, load), load);
                assert_eq!(point.kind, CriticalKind::Bifurcation, "{ends} {width}");
                critical / exact - 1.0
            };
            let errors = [8, 16].map(error);
            orders.at(format!("{ends}, width {width} m"));
            orders.see((errors[0] / errors[1]).log2() - 4.0);
            loads.at(format!("{ends}, width {width} m"));
            // what the elements leave is known
            let known = (beta / 32.0).powi(4) / 720.0;
            loads.see(error(32) - known);
        }
        let [exact, euler] = critical_load(beta, 1e-3);
        slender.at(ends);
        slender.see(exact / euler - 1.0);
    }
    Rung::ClosedForms
        .asks("Columns held in three ways, of two slendernesses: critical load with 32 elements against that of the energy with axial strain, relative error beyond (beta h)^4/720")
        .within(&loads, 1e-6, "the next term of the elements is a hundredth of the first, 2e-6 at most");
    Rung::OrderInElements
        .asks("Columns held in three ways, of two slendernesses: order of the critical load from 8 to 16 elements, minus 4")
        .within(&orders, 0.1, "cubic elements have twice the order of their energy, and the next term is small");
    Rung::ClosedForms
        .asks("Columns held in three ways: critical load of the energy against Euler's at a slenderness of 1000")
        .within(&slender, 4e-6, "the first correction is beta^2/12 1e-6, 3.3e-6 at most");
}

/// A frame of three members of 1 m, clamped at its feet, a load on each corner; it sways.
fn frame(elements: usize, load: f64) -> String {
    let parts = link("left", 1.0, elements)
        + &link("right", 1.0, elements)
        + &link("beam", 1.0, elements)
        + &weld("A", "ground.A", "left.start", FRAC_PI_2)
        + &weld("B", "ground.B", "right.start", FRAC_PI_2)
        + &weld("C", "left.end", "beam.start", -FRAC_PI_2)
        + &weld("D", "right.end", "beam.end", -FRAC_PI_2)
        + &force("left_load", "left.end", [0.0, -load])
        + &force("right_load", "right.end", [0.0, -load])
        + &format!("initial.bodies.left = {{ x = 0.0, y = 0.5, theta = {FRAC_PI_2:?} }}\n")
        + &format!("initial.bodies.right = {{ x = 1.0, y = 0.5, theta = {FRAC_PI_2:?} }}\n")
        + "initial.bodies.beam = { x = 0.5, y = 1.0, theta = 0.0 }\n";
    statics("points.A = [0.0, 0.0], points.B = [1.0, 0.0]", 0.01, &parts)
}

/// Two links from clamps at (-1, 0) and (1, 0) to a rigid corner at (0, h) that is loaded.
fn arch(height: f64, elements: usize, load: f64) -> String {
    let (length, angle) = (1.0_f64.hypot(height), height.atan());
    let parts = link("left", length, elements)
        + &link("right", length, elements)
        + &weld("A", "ground.A", "left.start", angle)
        + &weld("B", "ground.B", "right.end", -angle)
        + &weld("C", "left.end", "right.start", -2.0 * angle)
        + &force("load", "left.end", [0.0, -load])
        + &format!(
            "initial.bodies.left = {{ point = \"start\", x = -1.0, y = 0.0, theta = {angle:?} }}\n"
        )
        + &format!(
            "initial.bodies.right = {{ point = \"end\", x = 1.0, y = 0.0, theta = {:?} }}\n",
            -angle
        );
    statics(
        "points.A = [-1.0, 0.0], points.B = [1.0, 0.0]",
        0.01,
        &parts,
    )
}

#[test]
fn a_frame_sways_and_arches_snap_or_sway_at_the_loads_of_shooting() {
    let worst = Worst::new();
    type Structure = fn(usize, f64) -> String;
    let cases: [(&str, Structure, CriticalKind, f64); 3] = [
        (
            "frame",
            frame,
            CriticalKind::Bifurcation,
            1_291.248_291_985_551_5,
        ),
        (
            "arch of 0.02 m",
            |n, load| arch(0.02, n, load),
            CriticalKind::Limit,
            86.425_918_655,
        ),
        (
            "arch of 0.03 m",
            |n, load| arch(0.03, n, load),
            CriticalKind::Bifurcation,
            182.115_795_592,
        ),
    ];
    for (name, text, kind, exact) in cases {
        let load = 1.5 * exact;
        let (point, critical) = first_critical(&text(16, load), load);
        assert_eq!(point.kind, kind, "{name}");
        worst.at(name);
        worst.see(critical / exact - 1.0);
    }
    // beyond its bifurcation the symmetric path is unstable, and is followed all the same
    let load = 205.0;
    let (ended, recording, report) = run(&arch(0.03, 16, load), &["simulation.at_limit=follow"]);
    ended.unwrap();
    assert_eq!(
        report.critical_points.len(),
        1,
        "{:?}",
        report.critical_points
    );
    assert_eq!(
        report.rest.as_ref().unwrap().stability(),
        Stability::Unstable
    );
    let sideways = recording.get("points.left.end.x").unwrap();
    assert!(sideways.iter().all(|x| x.abs() < 1e-6), "{sideways:?}");
    // the whole path of the lower arch
    let (ended, _, report) = run(&arch(0.02, 16, 120.0), &["simulation.at_limit=follow"]);
    ended.unwrap();
    let loads: Vec<f64> = report
        .critical_points
        .iter()
        .map(|p| 120.0 * p.part)
        .collect();
    assert_eq!(loads.len(), 2, "{:?}", report.critical_points);
    worst.at("arch of 0.02 m, lower limit");
    worst.see(loads[1] / 52.610_173_089 - 1.0);
    Rung::Computed
        .asks("Frame and shallow arches: loads at which they sway or snap through, against shooting for the same energy, relative error")
        .within(&worst, 1e-5, "16 cubic elements a member leave 4e-6");
}

/// Directions of a structure: upright, along the axes, and six that have no short digits.
const DIRECTIONS: [f64; 9] = [
    0.0,
    FRAC_PI_2,
    PI,
    0.321_750_554,
    0.915_965_594,
    1.202_056_903,
    2.226_244_147,
    -0.643_501_109,
    -2.665_144_143,
];

/// A number as a user types it, with so many digits.
fn typed(x: f64, digits: usize) -> f64 {
    format!("{x:.*e}", digits - 1).parse().unwrap()
}

/// A unit vector, typed.
fn unit(angle: f64, digits: usize) -> [f64; 2] {
    [angle.cos(), angle.sin()].map(|x| typed(x, digits))
}

/// The bar on a torsion spring below: half its weight times its length, and the stiffness of the spring.
const TOPPLING: f64 = 0.165_543_75;
const SPRING: f64 = 0.1;

/// A bar on a torsion spring, in a direction, under a weight that points against it, but for an angle.
fn bar_on_a_spring(direction: f64, digits: usize, off: f64, step: f64) -> String {
    let [x, y] = unit(direction + off, digits).map(|x| -9.81 * x);
    let angle = typed(direction, digits);
    format!(
        r#"
format = 1
title = "a bar on a torsion spring"
simulation = {{ analysis = "static", duration = 1.0, gravity = [{x:?}, {y:?}] }}
integrator = {{ step = {step:?} }}
output = {{ interval = 0.1, channels = ["*"] }}
materials.al = {{ density = 2700.0, youngs_modulus = 70e9, poissons_ratio = 0.33 }}
sections.bar = {{ width = 0.02, height = 0.01 }}
bodies.ground = {{ type = "ground", points.O = [0.0, 0.0] }}
bodies.arm = {{ type = "link", model = "rigid", length = 0.25, section = "bar", material = "al" }}
joints.O = {{ type = "revolute", bearing = "ground.O", journal = "arm.start", model = "ideal" }}
forces.coil = {{ type = "torsion_spring", joint = "O", stiffness = {SPRING:?}, damping = 0.0, rest_angle = {angle:?} }}
initial.bodies.arm = {{ point = "start", x = 0.0, y = 0.0, theta = {angle:?} }}
"#
    )
}

/// As many digits as a number has, and two shorter ways to write it.
const DIGITS: [usize; 3] = [17, 8, 7];

#[test]
fn a_bar_buckles_alike_in_all_directions() {
    let [exact, rounded] = [Worst::new(), Worst::new()];
    for direction in DIRECTIONS {
        for digits in DIGITS {
            for step in [0.1, 1e-2, 1e-3] {
                let text = bar_on_a_spring(direction, digits, 0.0, step);
                let case = format!("direction {direction}, {digits} digits, step {step}");
                let (point, _) = first_critical(&text, 1.0);
                assert_eq!(point.kind, CriticalKind::Bifurcation, "{case}");
                assert_eq!(point.moves_most, "arm.theta", "{case}");
                let worst = if digits == 17 { &exact } else { &rounded };
                worst.at(&case);
                worst.see(point.t * TOPPLING / SPRING - 1.0);
                // followed, the bar stands up to the full load
                let (ended, recording, report) = run(&text, &["simulation.at_limit=follow"]);
                ended.unwrap_or_else(|e| panic!("{case}: {e}"));
                assert_eq!(report.critical_points, [point], "{case}");
                assert_eq!(report.rest.unwrap().stability(), Stability::Unstable);
                let t = recording.get("t").unwrap();
                assert!(t.windows(2).all(|t| t[0] < t[1]), "{case}: {t:?}");
                assert_eq!(t.last(), Some(&1.0), "{case}");
                let theta = recording.get("arm.theta").unwrap();
                assert!(
                    theta.iter().all(|x| (x - direction).abs() < 1e-4),
                    "{case}: {theta:?}"
                );
            }
        }
    }
    Rung::ClosedForms
        .asks("A bar on a torsion spring in nine directions, with steps of 0.1 to 0.001: critical load, relative error")
        .within(&exact, 1e-13, "rounding of the weight and of the direction");
    Rung::ClosedForms
        .asks("The same, its directions typed to 8 and 7 digits: critical load, relative error")
        .within(
            &rounded,
            1e-6,
            "the digits of the weight; Koiter's law would give the power 2/3 of it, 1e-4",
        );
}

/// k x = t W sin(x + e) has no bifurcation for e = 0.001: the bar leans more and more.
#[test]
fn a_bar_that_leans_bends_without_a_critical_point() {
    let worst = Worst::new();
    for direction in DIRECTIONS {
        for step in [0.1, 1e-2, 1e-3] {
            for at_limit in ["stop", "follow"] {
                let off = 1e-3;
                let text = bar_on_a_spring(direction, 17, off, step);
                let overrides = [format!("simulation.at_limit={at_limit}")];
                let (ended, recording, report) = run(&text, &[&overrides[0]]);
                ended.unwrap_or_else(|e| panic!("{direction} {step}: {e}"));
                assert_eq!(report.critical_points, [], "{direction} {step}");
                assert_eq!(report.rest.unwrap().stability(), Stability::Stable);
                let theta = recording.get("arm.theta").unwrap();
                let lean = theta.last().unwrap() - direction;
                worst.at(format!("direction {direction}, step {step}"));
                worst.see(SPRING * lean / (TOPPLING * (lean - off).sin()) - 1.0);
                assert!(lean < -1.0, "{lean}");
            }
        }
    }
    Rung::ClosedForms
        .asks("A bar that leans by 0.001 on a torsion spring: balance of torques beyond the load at which a perfect one buckles")
        .within(&worst, 1e-12, "rounding");
}

#[test]
fn columns_buckle_alike_in_all_directions() {
    let worst = Worst::new();
    for (ends, beta) in COLUMNS {
        for width in [0.1, 0.01] {
            let load = 1.5 * critical_load(beta, width)[0];
            let (_, along_x) = first_critical(&column(ends, width, 8, load), load);
            // a guide must meet the column to more digits
            let digits = match ends {
                "clamped-free" => &DIGITS[..],
                _ => &DIGITS[..1],
            };
            for direction in DIRECTIONS {
                for &digits in digits {
                    let text = column_in(direction, digits, ends, width, 8, load);
                    let (point, critical) = first_critical(&text, load);
                    let case =
                        format!("{ends}, width {width}, direction {direction}, {digits} digits");
                    assert_eq!(point.kind, CriticalKind::Bifurcation, "{case}");
                    worst.at(&case);
                    worst.see(critical / along_x - 1.0);
                }
            }
        }
    }
    Rung::Routes
        .asks("Columns in nine directions, typed to 17, 8 and 7 digits: critical load against that of the column along x, relative difference")
        .within(&worst, 1e-6, "the digits of the load");
}

/// The horizontal part of a load that leans makes the arch imperfect: it sways in the way that it leans, and its load has a limit.
#[test]
fn an_arch_under_a_load_that_hardly_leans_is_perfect() {
    let load = 1.5 * 182.115_795_592;
    let limit = |lean: f64| {
        let upright = format!("x = 0.0, y = {:?}", -load);
        let leaning = format!("x = {:?}, y = {:?}", load * lean.sin(), -load * lean.cos());
        let text = arch(0.03, 16, load).replace(&upright, &leaning);
        first_critical(&text, load)
    };
    let (_, perfect) = limit(0.0);
    let slight = Worst::new();
    for lean in [1e-12, 1e-9, 1e-6, 1e-5] {
        let (point, critical) = limit(lean);
        assert_eq!(point.kind, CriticalKind::Bifurcation, "{lean}");
        slight.at(format!("lean {lean}"));
        slight.see(critical / perfect - 1.0);
    }
    Rung::Routes
        .asks("Arch of 0.03 m under a load that leans by 1e-12 to 1e-5: load at which it sways, against the upright load, relative difference")
        .within(&slight, 1e-9, "rounding of the eigenvalue of stiff elements");
    let (point, critical) = limit(0.03);
    assert_eq!(point.kind, CriticalKind::Limit);
    let fall = 1.0 - critical / perfect;
    assert!((5e-4..2e-3).contains(&fall), "{fall}");
}

/// A truss that is pressed by a tenth of its limit load at any t snaps at t = 0.9, and hangs on at the reversed full load: its lower limit
/// is at t = -1.1.
#[test]
fn a_path_that_leads_to_the_reversed_load_ends_there() {
    let limit = limit_of_truss(1e4, 0.3);
    let dead = format!(
        "forces.dead = {{ type = \"force\", point = \"apex.center\", x = 0.0, y = \"{}\", frame = \"ground\" }}\n",
        -0.1 * limit
    );
    let text = truss(1e4, 0.3, limit, &dead);
    let (ended, recording, report) = run(&text, &["simulation.at_limit=follow"]);
    let message = ended.unwrap_err().to_string();
    assert!(message.contains("reversed load"), "{message}");
    assert_eq!(report.critical_points.len(), 1);
    assert!((report.critical_points[0].t - 0.9).abs() < 1e-9);
    let t = recording.get("t").unwrap();
    assert_eq!(t.last(), Some(&-1.0));
    assert!(t.iter().all(|t| t.abs() <= 1.0), "{t:?}");
}

/// No step of the load passes a limit point without a word: an arch snaps at the same load whatever the step, where the load step on the
/// far side of the limit has a stable equilibrium to jump to.
#[test]
fn an_arch_snaps_at_the_same_load_by_any_step() {
    let text = arch(0.05, 4, 3000.0);
    let critical: Vec<CriticalPoint> = ["0.5", "0.25", "0.1", "0.05", "0.04", "0.02", "0.01"]
        .iter()
        .map(|step| {
            match run(
                &text,
                &[&format!("integrator.step={step}"), "output.interval=1.0"],
            )
            .0
            {
                Err(RunError::Limit(point)) => point,
                other => panic!("{step}: {other:?}"),
            }
        })
        .collect();
    let worst = Worst::new();
    for point in &critical {
        assert_eq!(point.kind, critical[0].kind);
        worst.see(point.t / critical[0].t - 1.0);
    }
    Rung::Identities
        .asks("Limit load of a shallow arch by load steps of half to a hundredth of the full load: relative difference")
        .within(&worst, 1e-9, "a point located to 1e-10 of a step has the square of this error in the load; the rest is rounding of a slender arch");
}

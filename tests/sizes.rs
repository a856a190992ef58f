//! Mechanisms of every size: lengths times L, masses times L², gravity times L move alike.

use ladder::{Rung, Worst};
use looselink::scene::Scene;
use looselink::simulate::{Recording, Report, Simulation};

/// A four-bar that swings under its weight, or whose crank is driven, with all tolerances at their defaults.
fn four_bar(size: f64, drive: &str) -> (Recording, Report) {
    let text = format!(
        r#"
format = 1
title = "a four-bar of any size"
simulation = {{ duration = 0.5, gravity = [0.0, {:e}] }}
integrator = {{ method = "bathe", step = 1e-3 }}
output = {{ interval = 0.01, channels = ["*.theta"] }}
materials.steel = {{ density = 7850.0 }}
sections.bar = {{ width = {:e}, height = 0.02 }}
bodies.ground = {{ type = "ground", points.A = [0.0, 0.0], points.D = [{:e}, 0.0] }}
bodies.crank = {{ type = "link", model = "rigid", length = {:e}, section = "bar", material = "steel" }}
bodies.coupler = {{ type = "link", model = "rigid", length = {:e}, section = "bar", material = "steel" }}
bodies.rocker = {{ type = "link", model = "rigid", length = {:e}, section = "bar", material = "steel" }}
joints.A = {{ type = "revolute", bearing = "ground.A", journal = "crank.start", model = "ideal" }}
joints.B = {{ type = "revolute", bearing = "crank.end", journal = "coupler.start", model = "ideal" }}
joints.C = {{ type = "revolute", bearing = "coupler.end", journal = "rocker.end", model = "ideal" }}
joints.D = {{ type = "revolute", bearing = "ground.D", journal = "rocker.start", model = "ideal" }}
initial.sketch = {{ B = [0.0, {:e}], C = [{:e}, {:e}] }}
{drive}
"#,
        -9.81 * size,
        0.01 * size,
        0.35 * size,
        0.1 * size,
        0.3 * size,
        0.25 * size,
        0.1 * size,
        0.28 * size,
        0.24 * size
    );
    let scene = Scene::parse("four-bar", &text, &[]).unwrap_or_else(|e| panic!("{size:e}: {e:?}"));
    let mut simulation = Simulation::new(&scene).unwrap_or_else(|e| panic!("{size:e}: {e:?}"));
    let mut recording = Recording::new(&simulation);
    let ended = simulation.run(&mut recording);
    ended.unwrap_or_else(|e| panic!("{size:e}: {e}"));
    (recording, simulation.report())
}

#[test]
fn a_four_bar_of_any_size_moves_alike_and_says_the_same() {
    let driven = "drives.motor = { type = \"angle\", joint = \"A\", angle = { type = \"polynomial\", coefficients = [1.5707963267948966, 6.0] } }";
    let at_rest = "initial.equilibrium = true";
    let worst = Worst::new();
    for start in ["", driven, at_rest] {
        let (expected, of_one_metre) = four_bar(1.0, start);
        let said = |report: &Report| {
            let all = [report.warnings(), report.notes()].concat();
            let own = all.into_iter().filter(|told| !told.contains("SI units"));
            // whether a pivot is weak can depend on rounding
            own.filter(|told| !told.contains("row exchanges"))
                .collect::<Vec<_>>()
        };
        for exponent in -9..=6 {
            let size = 10.0_f64.powi(exponent);
            let (found, report) = four_bar(size, start);
            worst.at(format!("L = {size:e}, {start}"));
            for name in ["crank.theta", "coupler.theta", "rocker.theta"] {
                let pairs = expected
                    .get(name)
                    .unwrap()
                    .iter()
                    .zip(found.get(name).unwrap());
                pairs.for_each(|(a, b)| worst.see(a - b));
            }
            assert_eq!(said(&report), said(&of_one_metre), "{size:e} {start}");
        }
    }
    Rung::Identities
        .asks("A four-bar of lengths L from 1e-9 to 1e6 with masses times L² and gravity times L, free, driven and at rest: difference of angles [rad]")
        .within(&worst, 1e-9, "rounding of coordinates, which 500 steps and the motion amplify");
}

/// A five-bar whose tool follows a line by inverse kinematics; its cranks have angles, its rods positions of their ends.
fn five_bar(size: f64) -> Recording {
    let crank = |name: &str| {
        format!(
            "bodies.{name} = {{ type = \"rigid_body\", mass = {:e}, inertia = {:e}, points = {{ a = [0.0, 0.0], b = [{:e}, 0.0] }} }}\n",
            0.5 * size.powi(2),
            1e-3 * size.powi(4),
            0.25 * size
        )
    };
    let rod = |name: &str| {
        format!(
            "bodies.{name} = {{ type = \"link\", model = \"rigid\", length = {:e}, section = \"bar\", material = \"steel\" }}\n",
            0.35 * size
        )
    };
    let pin = |name: &str, bearing: &str, journal: &str| {
        format!(
            "joints.{name} = {{ type = \"revolute\", model = \"ideal\", bearing = \"{bearing}\", journal = \"{journal}\" }}\n"
        )
    };
    let at = |x: f64, y: f64| format!("[{:e}, {:e}]", x * size, y * size);
    let parts = [
        crank("left"),
        crank("right"),
        rod("first"),
        rod("second"),
        pin("A", "ground.A", "left.a"),
        pin("B", "ground.B", "right.a"),
        pin("C", "left.b", "first.start"),
        pin("D", "right.b", "second.start"),
        pin("E", "tool.o", "first.end"),
        pin("F", "tool.o", "second.end"),
    ];
    let text = format!(
        "format = 1\n\
         title = \"a five-bar of any size\"\n\
         simulation = {{ duration = 0.4 }}\n\
         integrator = {{ method = \"bathe\", step = 1e-3 }}\n\
         output = {{ interval = 0.01, channels = [\"A.angle\", \"B.angle\", \"first.theta\", \"A.speed\"] }}\n\
         materials.steel = {{ density = 7850.0 }}\n\
         sections.bar = {{ width = {:e}, height = 0.02 }}\n\
         bodies.ground = {{ type = \"ground\", points.A = {}, points.B = {} }}\n\
         bodies.tool = {{ type = \"rigid_body\", mass = {:e}, inertia = {:e}, points.o = [0.0, 0.0] }}\n\
         {}\
         drives.move = {{ type = \"inverse_kinematics\", body = \"tool\", joints = [\"A\", \"B\"], \
         path = {{ type = \"line\", from = [{:e}, {:e}, 0.0], to = [{:e}, {:e}, 0.0], duration = 0.4 }} }}\n\
         initial.sketch = {{ C = {}, D = {} }}\n",
        0.01 * size,
        at(-0.125, 0.0),
        at(0.125, 0.0),
        0.5 * size.powi(2),
        1e-4 * size.powi(4),
        parts.concat(),
        -0.05 * size,
        0.4 * size,
        0.05 * size,
        0.4 * size,
        at(-0.3, 0.17),
        at(0.3, 0.17),
    );
    let scene = Scene::parse("five-bar", &text, &[]).unwrap_or_else(|e| panic!("{size:e}: {e:?}"));
    let mut simulation = Simulation::new(&scene).unwrap_or_else(|e| panic!("{size:e}: {e:?}"));
    let mut recording = Recording::new(&simulation);
    let ended = simulation.run(&mut recording);
    ended.unwrap_or_else(|e| panic!("{size:e}: {e}"));
    recording
}

/// A pose is closed to the same part of every mechanism.
#[test]
fn inverse_kinematics_of_any_size_give_the_same_angles() {
    let worst = Worst::new();
    let expected = five_bar(1.0);
    for exponent in -9..=6 {
        let found = five_bar(10.0_f64.powi(exponent));
        worst.at(format!("L = 1e{exponent}"));
        for name in ["A.angle", "B.angle", "first.theta", "A.speed"] {
            let of = |run: &Recording| run.get(name).unwrap().to_vec();
            let pairs = of(&expected).into_iter().zip(of(&found));
            pairs.for_each(|(a, b)| worst.see(a - b));
        }
    }
    Rung::Identities
        .asks("A five-bar of lengths L from 1e-9 to 1e6 that follows a path: difference of angles [rad] and of speeds [rad/s]")
        .within(&worst, 1e-12, "rounding of lengths, some hundred times for speeds of 1 rad/s at 1 rad");
}

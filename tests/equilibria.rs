//! Equilibria that a mechanism reaches from its sketch.

use crate::support::{all_scenes, load, run_scene};
use ladder::{Rung, Worst};
use looselink::newton::{Extent, Newton, interruptible};
use looselink::registry::Registry;
use looselink::scene::Scene;
use looselink::simulate::{Simulation, Stability};
use looselink::system::System;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use std::cell::Cell;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::rc::Rc;

/// A pendulum of length 1 m whose end is sketched somewhere.
fn pendulum(end: [f64; 2], equilibrium: &str) -> Scene {
    let [x, y] = end;
    parse(&format!(
        r#"
format = 1
title = "a bar hangs on a pin"
simulation = {{ duration = 0.1, gravity = [0.0, -9.81] }}
integrator = {{ method = "bathe", step = 1e-3, newton_tolerance = 1e-9 }}
output = {{ interval = 0.1, channels = ["bar.theta"] }}
materials.steel = {{ density = 7850.0 }}
sections.bar = {{ width = 0.01, height = 0.02 }}
bodies.ground = {{ type = "ground", points.O = [0.0, 0.0] }}
bodies.bar = {{ type = "link", model = "rigid", length = 1.0, section = "bar", material = "steel" }}
joints.O = {{ type = "revolute", bearing = "ground.O", journal = "bar.start", model = "ideal" }}
initial.sketch.bar = {{ end = [{x:?}, {y:?}] }}
initial.equilibrium = {equilibrium}
"#
    ))
}

/// It hangs, from any sketch, with mu = 3 g/(2 l); also from exactly upright.
#[test]
fn a_pendulum_hangs_from_any_sketch() {
    let worst = Worst::new();
    for degrees in (-170..=180).step_by(10) {
        let angle = f64::from(degrees).to_radians();
        let scene = pendulum([angle.cos(), angle.sin()], "true");
        let simulation = Simulation::new(&scene).unwrap();
        let theta = simulation.model().pose(1, simulation.state()).position[2];
        let rest = simulation.report().rest.unwrap();
        assert_eq!(rest.stability(), Stability::Stable, "{degrees}");
        worst.at(format!("{degrees} degrees"));
        worst.see((theta + FRAC_PI_2).sin().abs());
        worst.see(rest.smallest_eigenvalue.unwrap() / (1.5 * 9.81) - 1.0);
        assert!((theta + FRAC_PI_2).cos() > 0.0, "{degrees}: {theta}");
    }
    Rung::ClosedForms
        .asks("Does a pendulum hang straight down from any sketch, with the eigenvalue 3g/(2l)?")
        .within(&worst, 1e-12, "rounding of an angle and of a quotient");
}

/// What is asked for may itself look for an equilibrium, which nobody ends.
#[test]
fn a_search_that_nobody_waits_for_ends_at_once() {
    let scene = pendulum([0.6, 0.8], "true");
    let asked = Rc::new(Cell::new(0));
    let search = |waits: u32| {
        asked.set(0);
        let (asked, inner) = (asked.clone(), pendulum([0.8, 0.6], "true"));
        let ended = move || {
            asked.set(asked.get() + 1);
            asked.get() == 1 && Simulation::new(&inner).is_err() || asked.get() > waits
        };
        interruptible(ended, || Simulation::new(&scene).is_ok())
    };
    assert!(search(u32::MAX));
    let all = asked.get();
    assert!(all > 20, "{all}");
    for waits in [0, 10] {
        assert!(!search(waits));
        // a step downhill is tried again with a shorter time, at most some dozen times
        assert!(asked.get() < waits + 100, "{}", asked.get());
    }
    // it holds for the work alone
    assert!(Simulation::new(&scene).is_ok());
}

/// A pendulum that stands upright without being asked to rests there, and is said to fall; one that hangs has no note.
#[test]
fn a_motion_that_rests_upright_says_so() {
    for (end, grows) in [([0.0, 1.0], true), ([0.0, -1.0], false)] {
        let scene = pendulum(end, "false");
        let mut simulation = Simulation::new(&scene).unwrap();
        simulation.run(&mut ()).unwrap();
        let report = simulation.report();
        let note =
            "the mechanism rests in an unstable equilibrium: a small push of bar.theta grows";
        let notes = report.notes();
        assert_eq!(notes.iter().any(|n| n == note), grows, "{notes:?}");
        let eigenvalue = report
            .unstable_rest
            .and_then(|rest| rest.smallest_eigenvalue);
        assert_eq!(eigenvalue.is_some(), grows);
        assert!(eigenvalue.is_none_or(|mu| (mu / (-1.5 * 9.81) - 1.0).abs() < 1e-12));
    }
}

/// The nearest equilibrium of a pendulum sketched almost upright is upright, and is called unstable.
#[test]
fn the_nearest_equilibrium_may_be_unstable() {
    let scene = pendulum([0.01, 1.0], "\"nearest\"");
    let mut simulation = Simulation::new(&scene).unwrap();
    let rest = simulation.report().rest.unwrap();
    assert_eq!(rest.stability(), Stability::Unstable);
    assert!((rest.smallest_eigenvalue.unwrap() / (-1.5 * 9.81) - 1.0).abs() < 1e-12);
    assert_eq!(rest.moves_most, "bar.theta");
    simulation.run(&mut ()).unwrap();
    let notes = simulation.report().notes();
    assert!(
        notes
            .iter()
            .any(|n| n.contains("unstable") && n.contains("bar.theta")),
        "{notes:?}"
    );
}

/// A dyad: a bar from a joint of the last loop and a bar to the ground, by random numbers in [0, 1].
#[derive(Debug, Clone)]
struct Dyad {
    lengths: [f64; 2],
    pivot: [f64; 2],
    side: f64,
}

/// Four-bars, and six-bars with a second dyad at the joint of coupler and rocker, all of whose bars hang on their joints.
fn hanging(crank: f64, angle: f64, dyads: &[Dyad]) -> Option<Scene> {
    let mut joints = String::new();
    let (mut bodies, mut sketch) = (String::new(), String::new());
    let mut ground = "points.G0 = [0.0, 0.0]".to_owned();
    let mut last = [crank * angle.cos(), crank * angle.sin()];
    let mut carrier = "b0.end".to_owned();
    let link = |name: &str, length: f64| {
        format!(
            "bodies.{name} = {{ type = \"link\", model = \"rigid\", length = {length:?}, section = \"bar\", material = \"steel\" }}\n"
        )
    };
    bodies += &link("b0", crank);
    joints += "joints.J0 = { type = \"revolute\", bearing = \"ground.G0\", journal = \"b0.start\", model = \"ideal\" }\n";
    for (k, dyad) in dyads.iter().enumerate() {
        let [a, b] = dyad.lengths;
        let [px, py] = dyad.pivot;
        let [dx, dy] = [px - last[0], py - last[1]];
        let d = dx.hypot(dy);
        // the knee, with a triangle that is not flat
        if d > 0.95 * (a + b) || d < 1.05 * (a - b).abs() {
            return None;
        }
        let along = (a * a - b * b + d * d) / (2.0 * d);
        let off = (a * a - along * along).sqrt() * dyad.side.signum();
        let knee = [
            last[0] + (along * dx - off * dy) / d,
            last[1] + (along * dy + off * dx) / d,
        ];
        let [first, second] = [2 * k + 1, 2 * k + 2];
        bodies += &link(&format!("b{first}"), a);
        bodies += &link(&format!("b{second}"), b);
        joints += &format!(
            "joints.J{first} = {{ type = \"revolute\", bearing = \"{carrier}\", journal = \"b{first}.start\", model = \"ideal\" }}\n"
        );
        joints += &format!(
            "joints.K{first} = {{ type = \"revolute\", bearing = \"b{first}.end\", journal = \"b{second}.start\", model = \"ideal\" }}\n"
        );
        joints += &format!(
            "joints.J{second} = {{ type = \"revolute\", bearing = \"ground.G{second}\", journal = \"b{second}.end\", model = \"ideal\" }}\n"
        );
        ground += &format!(", points.G{second} = [{px:?}, {py:?}]");
        sketch += &format!(
            "J{first} = [{:?}, {:?}], K{first} = [{:?}, {:?}], ",
            last[0], last[1], knee[0], knee[1]
        );
        carrier = format!("b{first}.end");
        last = knee;
    }
    let text = format!(
        r#"
format = 1
title = "bars hang on their joints"
simulation = {{ duration = 0.1, gravity = [0.0, -9.81] }}
integrator = {{ method = "bathe", step = 1e-3, newton_tolerance = 1e-9 }}
output = {{ interval = 0.1, channels = ["b0.theta"] }}
materials.steel = {{ density = 7850.0 }}
sections.bar = {{ width = 0.02, height = 0.02 }}
bodies.ground = {{ type = "ground", {ground} }}
{bodies}{joints}initial.sketch = {{ {} }}
"#,
        sketch.trim_end_matches(", ")
    );
    Some(parse(&text))
}

/// A hundred four-bars and a hundred six-bars: on the way of the descent no potential is higher than the one before and no point
/// moves farther than a tenth of the size; the rest has a positive eigenvalue, that of the slowest mode.
#[test]
fn hanging_mechanisms_come_downhill_to_rest() {
    let [heights, eigenvalues, found] = [Worst::new(), Worst::new(), Worst::new()];
    for dyads in [1, 2] {
        let dyad = (
            [0.3..1.5_f64, 0.3..1.5_f64],
            [-1.5..1.5_f64, -0.5..0.5_f64],
            prop_oneof![Just(-1.0), Just(1.0)],
        );
        let dyad = dyad.prop_map(|(lengths, pivot, side)| Dyad {
            lengths,
            pivot,
            side,
        });
        let mechanisms = (0.2..1.0_f64, 0.0..TAU, prop::collection::vec(dyad, dyads));
        let mechanisms = mechanisms
            .prop_filter_map("it does not close", |(crank, angle, dyads)| {
                hanging(crank, angle, &dyads)
            });
        let config = Config {
            cases: 100,
            max_local_rejects: 1_000_000,
            ..Config::default()
        };
        let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[dyads as u8; 32]);
        let run = TestRunner::new_with_rng(config, rng).run(&mechanisms, |scene| {
            let start = Simulation::new(&scene).unwrap();
            let (model, mut work) = (start.model(), start.model().work());
            let lengths = model.lengths();
            let extent = Extent {
                lengths: &lengths,
                size: 3.0,
            };
            let mut state = start.state().clone();
            let masses = scene.bodies.iter().filter_map(|body| body.kind.mass());
            let weight = 9.81 * 3.0 * masses.sum::<f64>();
            let potential = |state: &looselink::system::State| {
                let energies = model.energies(state);
                energies.total() - energies.kinetic
            };
            let (mut before, mut at) = (potential(&state), state.clone());
            let mut newton = Newton::new(model, 1e-9);
            newton
                .descend(model, extent, &mut state, &mut work, &mut |next| {
                    let after = potential(next);
                    heights.see((after - before).max(0.0) / weight);
                    let moved = at.q.iter().zip(&next.q).map(|(a, b)| b - a);
                    assert!(extent.farthest(moved).1 <= 0.1 * extent.size);
                    (before, at) = (after, next.clone());
                })
                .unwrap();
            let mut resting = Simulation::new(&scene_with_rest(&scene)).unwrap();
            let rest = resting.report().rest.unwrap();
            prop_assert_eq!(rest.stability(), Stability::Stable);
            let modes = resting.modes(false).unwrap();
            let slowest = (TAU * modes.modes[0].frequency).powi(2);
            prop_assert_eq!(modes.modes[0].growth, 0.0);
            eigenvalues.see(rest.smallest_eigenvalue.unwrap() / slowest - 1.0);
            // nothing pushes it
            found.see(
                resting
                    .state()
                    .a
                    .iter()
                    .fold(0.0, |m: f64, a| m.max(a.abs()))
                    / 9.81,
            );
            Ok(())
        });
        run.unwrap();
    }
    Rung::Balance
        .asks("200 hanging four- and six-bars: largest rise of the potential on the way to rest, over the weight times 3 m")
        .within(&heights, 1e-14, "64 roundings: a step is kept where the forces do work");
    Rung::Routes
        .asks("200 hanging four- and six-bars: smallest eigenvalue against the square of the slowest frequency of `modes`")
        .within(&eigenvalues, 1e-9, "1e-13 of the largest eigenvalue of the inverse, by another route than that of the modes");
    Rung::Balance
        .asks("200 hanging four- and six-bars: acceleration of the start, over gravity")
        .within(
            &found,
            1e-9,
            "rounding of forces over the inertia of the slowest direction",
        );
}

fn scene_with_rest(scene: &Scene) -> Scene {
    Scene::parse(
        "hanging",
        scene.text(),
        &["initial.equilibrium=true".to_owned()],
    )
    .unwrap()
}

fn parse(text: &str) -> Scene {
    Scene::parse("equilibrium", text, &[]).unwrap_or_else(|e| panic!("{e:?}"))
}

/// A scene with ideal joints that starts in equilibrium, by a method; none where the scene has no such start or the method does not
/// take it.
fn at_rest(scene: &Scene, method: &str, step: Option<f64>, steps: usize) -> Option<Simulation> {
    let mut overrides: Vec<String> = scene.overrides().map(ToOwned::to_owned).collect();
    for joint in &scene.joints {
        if joint.contact().is_some() {
            overrides.push(format!("joints.{}.model=ideal", joint.name));
        }
    }
    let step = step.or(scene.integrator.step())?;
    let parameters = match method {
        "generalized_alpha" | "hht" => ", spectral_radius = 0.8",
        _ => "",
    };
    overrides.push("initial.equilibrium=true".to_owned());
    overrides.push(format!(
        "integrator={{ method = \"{method}\", step = {step:e}{parameters} }}"
    ));
    overrides.push(format!("output.interval={step:e}"));
    overrides.push("output.channels=[\"*\"]".to_owned());
    overrides.push(format!("simulation.duration={:e}", steps as f64 * step));
    let scene = Scene::parse("rest", scene.text(), &overrides).ok()?;
    Simulation::new(&scene).ok()
}

/// A step that explicit methods can take: a tenth of the shortest time in which a mode vibrates or decays, over 2 pi.
fn stable_step(scene: &Scene) -> Option<f64> {
    let mut still = at_rest(scene, "bathe", None, 1)?;
    let modes = still.modes(false).ok()?.modes;
    let rates = modes
        .iter()
        .map(|mode| mode.frequency * (2.0 * mode.damping).max(1.0));
    let fastest = rates.fold(0.0, f64::max);
    let step = scene.integrator.step()?;
    Some(step.min(0.1 / (TAU * fastest)))
}

/// Whatever rests says nothing, by any method: every scene of the project that has an equilibrium with ideal joints, and fifty hanging
/// mechanisms.
#[test]
fn what_rests_warns_of_nothing() {
    let mut scenes: Vec<(String, Scene)> = all_scenes()
        .into_iter()
        .map(|name| (name.clone(), load(&name, &[])))
        .filter(|(_, scene)| scene.motions.is_empty() && scene.drives.is_empty())
        .collect();
    let shipped = scenes.len();
    let random = |k: usize| {
        let x = |i: usize| (0.5 + 0.5 * ((k * 7 + i) as f64 * 12.9898).sin()).fract();
        let dyad = |i: usize| Dyad {
            lengths: [0.3 + 1.2 * x(i), 0.3 + 1.2 * x(i + 1)],
            pivot: [-1.5 + 3.0 * x(i + 2), x(i + 3) - 0.5],
            side: x(i + 4) - 0.5,
        };
        let dyads: Vec<Dyad> = (0..=k % 2).map(|d| dyad(2 + 5 * d)).collect();
        hanging(0.2 + 0.8 * x(0), TAU * x(1), &dyads)
    };
    let hanging = (0..).filter_map(random).take(50);
    scenes.extend(hanging.map(|scene| ("hanging".to_owned(), scene)));
    let (mut tried, mut told) = (0, Vec::new());
    for (name, scene) in &scenes {
        // loads and frames may move by themselves
        let rests = at_rest(scene, "bathe", None, 50).is_some_and(|mut simulation| {
            simulation.run(&mut ()).unwrap();
            simulation.report().integration.unwrap().rests()
        });
        if !rests {
            continue;
        }
        for scheme in Registry::standard().schemes {
            let step = match scheme.is_explicit {
                true => stable_step(scene),
                false => None,
            };
            if scheme.is_explicit && step.is_none() {
                continue;
            }
            let Some(mut simulation) = at_rest(scene, scheme.name, step, 50) else {
                continue;
            };
            let ended = simulation.run(&mut ());
            let warnings = simulation.report().warnings();
            tried += 1;
            if ended.is_err() || !warnings.is_empty() {
                told.push(format!("{name} by {}: {ended:?} {warnings:?}", scheme.name));
            }
        }
    }
    assert!(told.is_empty(), "{} of {tried}: {told:#?}", told.len());
    assert!(
        tried > 500,
        "{tried} runs of {shipped} scenes and 50 mechanisms"
    );
}

/// A chain of bars of 0.3 m from the origin, each drawn at an angle.
fn chain(angles: &[f64], coordinates: &str, equilibrium: &str) -> Scene {
    let (mut bodies, mut joints, mut states) = (String::new(), String::new(), String::new());
    let [mut x, mut y] = [0.0, 0.0];
    let mut end = "ground.O".to_owned();
    for (k, angle) in angles.iter().enumerate() {
        bodies += &format!(
            "bodies.l{k} = {{ type = \"link\", model = \"rigid\", length = 0.3, section = \"bar\", material = \"steel\"{coordinates} }}\n"
        );
        joints += &format!(
            "joints.J{k} = {{ type = \"revolute\", model = \"ideal\", bearing = \"{end}\", journal = \"l{k}.start\" }}\n"
        );
        let [dx, dy] = [0.15 * angle.cos(), 0.15 * angle.sin()];
        states += &format!(
            "initial.bodies.l{k} = {{ x = {:?}, y = {:?}, theta = {angle:?} }}\n",
            x + dx,
            y + dy
        );
        (x, y) = (x + 2.0 * dx, y + 2.0 * dy);
        end = format!("l{k}.end");
    }
    parse(&format!(
        "format = 1\n\
         title = \"a chain\"\n\
         simulation = {{ duration = 0.1, gravity = [0.0, -9.81] }}\n\
         integrator = {{ method = \"bathe\", step = 1e-3 }}\n\
         output = {{ interval = 0.1, channels = [\"*.theta\"] }}\n\
         materials.steel = {{ density = 7850.0 }}\n\
         sections.bar = {{ width = 0.01, height = 0.02 }}\n\
         bodies.ground = {{ type = \"ground\", points.O = [0.0, 0.0] }}\n\
         {bodies}{joints}{states}\
         initial.equilibrium = {equilibrium}\n"
    ))
}

/// The nearest equilibrium of a chain is the one that it is drawn near, whichever of its bars stand and hang: the stiffness needs the
/// forces in the joints, which the drawing does not give.
#[test]
fn the_nearest_equilibrium_of_a_chain_is_the_one_that_is_drawn() {
    let worst = Worst::new();
    for count in 2..=5_usize {
        for pattern in 0..1_u32 << count {
            let stands = |k: usize| pattern >> k & 1 == 1;
            let exact: Vec<f64> = (0..count)
                .map(|k| if stands(k) { FRAC_PI_2 } else { -FRAC_PI_2 })
                .collect();
            for off in [0.0, 1e-3] {
                let drawn: Vec<f64> = exact
                    .iter()
                    .enumerate()
                    .map(|(k, angle)| angle + off * (1.0 + 2.4 * k as f64).sin())
                    .collect();
                for coordinates in ["", ", coordinates = \"center\""] {
                    let scene = chain(&drawn, coordinates, "\"nearest\"");
                    let simulation = Simulation::new(&scene).unwrap();
                    worst.at(format!(
                        "{count} bars, {pattern:b}, off by {off}{coordinates}"
                    ));
                    for (k, angle) in exact.iter().enumerate() {
                        let theta = simulation.model().pose(k + 1, simulation.state()).position[2];
                        worst.see((theta - angle).sin());
                        assert!((theta - angle).cos() > 0.0);
                    }
                    let hangs = pattern == 0;
                    let stability = simulation.report().rest.unwrap().stability();
                    assert_eq!(stability == Stability::Stable, hangs);
                }
            }
        }
    }
    Rung::ClosedForms
        .asks("Does a chain of up to five bars, each drawn to stand or to hang, have its nearest equilibrium there? (sine of the angle off)")
        .within(&worst, 1e-12, "rounding of angles, and of positions that add up along the chain");
}

/// A hanging four-bar of rigid bodies, of any size and far from the origin, comes to the same rest.
#[test]
fn a_rest_depends_on_neither_the_origin_nor_the_size() {
    // a sketch that closes: B above the ground, C where the circles about B and D meet
    let (bx, by) = (0.3 * 2.25_f64.cos(), 0.3 * 2.25_f64.sin());
    let (dx, dy) = (0.9 - bx, -by);
    let d = dx.hypot(dy);
    let along = (d * d + 0.8 * 0.8 - 0.5 * 0.5) / (2.0 * d);
    let across = (0.8 * 0.8 - along * along).sqrt();
    let (cx, cy) = (
        bx + (along * dx - across * dy) / d,
        by + (along * dy + across * dx) / d,
    );
    let four_bar = |size: f64, shift: f64| {
        let at = |x: f64, y: f64| format!("[{:?}, {:?}]", size * x + shift, size * y);
        let bar = |name: &str, length: f64| {
            format!(
                "bodies.{name} = {{ type = \"rigid_body\", mass = {:e}, inertia = {:e}, center_of_mass = [{:e}, {:e}], \
                 points = {{ a = [0.0, 0.0], b = [{:e}, 0.0] }} }}\n",
                length * size * size,
                0.1 * length.powi(3) * size.powi(4),
                0.4 * length * size,
                0.1 * length * size,
                length * size
            )
        };
        let pin = |name: &str, first: &str, second: &str| {
            format!(
                "joints.{name} = {{ type = \"revolute\", model = \"ideal\", bearing = \"{first}\", journal = \"{second}\" }}\n"
            )
        };
        let parts = [
            bar("p", 0.3),
            bar("q", 0.8),
            bar("r", 0.5),
            pin("A", "ground.A", "p.a"),
            pin("B", "p.b", "q.a"),
            pin("C", "q.b", "r.b"),
            pin("D", "ground.D", "r.a"),
        ];
        let scene = parse(&format!(
            "format = 1\n\
             title = \"a four-bar of any size, anywhere\"\n\
             simulation = {{ duration = 0.1, gravity = [0.0, {:e}] }}\n\
             integrator = {{ method = \"bathe\", step = 1e-2 }}\n\
             output = {{ interval = 0.1, channels = [\"*.theta\"] }}\n\
             bodies.ground = {{ type = \"ground\", points.A = {}, points.D = {} }}\n\
             {}\
             initial.sketch = {{ B = {}, C = {} }}\n\
             initial.equilibrium = true\n",
            -9.81 * size,
            at(0.0, 0.0),
            at(0.9, 0.0),
            parts.concat(),
            at(bx, by),
            at(cx, cy),
        ));
        let simulation =
            Simulation::new(&scene).unwrap_or_else(|e| panic!("{size:e} {shift}: {e}"));
        let theta = |b| simulation.model().pose(b, simulation.state()).position[2];
        [theta(1), theta(2), theta(3)]
    };
    let expected = four_bar(1.0, 0.0);
    let worst = Worst::new();
    let sizes = (-9..=6).map(|exponent| (10.0_f64.powi(exponent), 0.0));
    let shifts = [-1e3, -30.0, 20.0, 100.0, 1e3].map(|shift| (1.0, shift));
    for (size, shift) in sizes.chain(shifts) {
        worst.at(format!("L = {size:e}, shifted by {shift} m"));
        let found = four_bar(size, shift);
        for (found, expected) in found.iter().zip(expected) {
            // full turns do not count
            worst.see((found - expected).sin());
            assert!((found - expected).cos() > 0.0, "{size:e} {shift}");
        }
    }
    Rung::Identities
        .asks("A four-bar of lengths L from 1e-9 to 1e6, and up to 1 km from the origin, comes to rest: sine of the difference of angles")
        .within(&worst, 1e-11, "rounding of positions at 1 km, 1e-13 m, over bars of 0.3 m, some ten times");
}

/// Without an equilibrium downhill the message names what falls; no step could help.
#[test]
fn what_nothing_stops_is_named() {
    let falls = |what: &str| {
        let text = format!(
            "format = 1\n\
             title = \"it falls\"\n\
             simulation = {{ duration = 0.1, gravity = [0.0, -9.81] }}\n\
             integrator = {{ method = \"bathe\", step = 1e-3 }}\n\
             output = {{ interval = 0.1, channels = [\"*\"] }}\n\
             bodies.ground = {{ type = \"ground\", points.O = [0.0, 0.0] }}\n\
             {what}\
             initial.equilibrium = true\n"
        );
        Simulation::new(&parse(&text)).unwrap_err().to_string()
    };
    let mass = "bodies.m = { type = \"point_mass\", mass = 1.0 }\ninitial.sketch.m = { center = [0.0, 1.0] }\n";
    let bar = "bodies.bar = { type = \"rigid_body\", mass = 1.0, inertia = 0.1, center_of_mass = [0.5, 0.0], points.a = [0.0, 0.0] }\n\
         joints.O = { type = \"revolute\", model = \"ideal\", bearing = \"ground.O\", journal = \"bar.a\" }\n\
         forces.drive = { type = \"torque\", point = \"bar.a\", value = 5.9 }\n\
         initial.bodies.bar = { x = 0.5, y = 0.0, theta = 0.0 }\n";
    for (what, named) in [
        (mass, "m.center.y: nothing stops it"),
        (bar, "bar.theta: nothing stops it"),
    ] {
        let message = falls(what);
        assert!(message.contains(named), "{message}");
        assert!(!message.contains("step"), "{message}");
    }
}

/// The angle of a body counts the turns that it makes on the way to rest, as the angle of the spring that turns it does.
#[test]
fn a_body_that_a_wound_spring_turns_counts_its_turns() {
    let rest = 4.0 * TAU + 0.3;
    for analysis in ["analysis = \"static\", ", ""] {
        let method = match analysis {
            "" => "method = \"bathe\", ",
            _ => "",
        };
        let equilibrium = match analysis {
            "" => "initial.equilibrium = true\n",
            _ => "",
        };
        let scene = parse(&format!(
            "format = 1\n\
             title = \"a wound spring\"\n\
             simulation = {{ {analysis}duration = 0.1, gravity = [0.0, -9.81] }}\n\
             integrator = {{ {method}step = 1e-2 }}\n\
             output = {{ interval = 1e-2, channels = [\"*\"] }}\n\
             bodies.ground = {{ type = \"ground\", points.O = [0.0, 0.0] }}\n\
             bodies.arm = {{ type = \"rigid_body\", mass = 1.0, inertia = 0.01, points.o = [-0.2, 0.0] }}\n\
             joints.O = {{ type = \"revolute\", model = \"ideal\", bearing = \"ground.O\", journal = \"arm.o\" }}\n\
             forces.coil = {{ type = \"torsion_spring\", joint = \"O\", stiffness = 2.0, damping = 0.0, rest_angle = {rest:?} }}\n\
             initial.bodies.arm = {{ x = 0.2, y = 0.0, theta = 0.0 }}\n\
             {equilibrium}"
        ));
        let (run, _) = run_scene(&scene);
        let [theta, angle] = ["arm.theta", "coil.angle"].map(|channel| run.get(channel));
        let last = angle.last().unwrap();
        // k (rest - phi) = m g l cos(phi)
        assert!((2.0 * (rest - last) - 9.81 * 0.2 * last.cos()).abs() < 1e-9);
        for (theta, angle) in theta.iter().zip(&angle) {
            assert!((theta - angle).abs() < 1e-12, "{theta} {angle}");
        }
    }
}

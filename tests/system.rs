//! Compiled models as a whole: tangents by differencing, no allocation, repeatable bytes.

use crate::support::{NATURAL, all_scenes, load};
use ladder::{Rung, Worst};
use looselink::body::{CentredLink, FlexibleLink};
use looselink::model::Model;
use looselink::newton::Newton;
use looselink::scene::{Analysis, Scene};
use looselink::simulate::Simulation;
use looselink::system::{State, System, Weights};
use std::collections::BTreeMap;

/// Steps that a scene takes at least, where its step is long.
const LEAST_STEPS: f64 = 40.0;
/// Rows of the output are about this far apart \[s\].
const INTERVAL: f64 = 0.001;

/// A scene over its first milliseconds, but over [`LEAST_STEPS`] of its own steps at least; one with a load path has no
/// time to shorten and stays whole.
fn beginning(name: &str, duration: f64) -> Scene {
    let whole = load(name, &[]);
    if whole.simulation.analysis == Analysis::Static {
        return whole;
    }
    let step = whole.integrator.step().unwrap();
    // a whole multiple of the step, as the scene language asks for
    let interval = step * (INTERVAL / step).round().max(1.0);
    let duration = duration.max(LEAST_STEPS * step).max(interval);
    let duration = format!("simulation.duration={duration:?}");
    let interval = format!("output.interval={interval:?}");
    load(name, &[&duration, &interval])
}

/// A state some milliseconds into a scene, with closed contacts where it has contacts.
fn state(scene: &Scene) -> (Simulation, State) {
    let mut simulation = Simulation::new(scene).unwrap();
    simulation.run(&mut ()).unwrap();
    let state = simulation.state().clone();
    (simulation, state)
}

/// EA of the stiffest flexible link \[N\].
fn axial_stiffness(scene: &Scene) -> f64 {
    let links = scene.bodies.iter().filter_map(|body| body.kind.get());
    let stiffness = links.map(|link: &FlexibleLink| link.youngs_modulus * link.link.area);
    stiffness.fold(0.0, f64::max)
}

/// How far a unit of the angle of each rigid link moves its ends \[m\], by the index of the angle.
fn levers(model: &Model) -> BTreeMap<usize, f64> {
    let links = model.bodies().iter().map(|body| &body.placed);
    let links = links.filter(|placed| placed.kind.get::<CentredLink>().is_some());
    links
        .map(|placed| (placed.x[0] + 2, placed.kind.lever(0)))
        .collect()
}

/// The stage matrix of every scene is the derivative of its residual by the acceleration.
///
/// Weights of 1e-4 s and 1e-8 s2 make all parts count. The difference is over accelerations of 0.03 m/s2, which move q by
/// 3e-10 m: far less than the penetrations of about 1e-7 m, and enough to resolve.
#[test]
fn stage_matrices_are_the_derivatives() {
    let worst = Worst::new();
    for name in all_scenes() {
        // at 8 ms a contact of case 3 has a penetration of 2e-8 m, for which 3e-10 m is a coarse difference
        let end = if name == "3rrr/case3.toml" {
            0.011
        } else {
            0.008
        };
        let scene = beginning(&name, end);
        let (simulation, start) = state(&scene);
        let model = simulation.model();
        let shape = model.shape();
        let (n, m) = (shape.unknowns, shape.multipliers);
        let w = Weights { q: 1e-8, v: 1e-4 };
        // an impact at 1e-6 m/s: its law bends where the velocity changes by that
        let h = if name == "hard/grazing.toml" {
            3e-4
        } else {
            0.03
        };
        // an axial force is a difference of terms of the size of EA, half a rounding off in each of two evaluations; above
        // 1e7 N this exceeds the bound below
        let rounding = f64::EPSILON * axial_stiffness(&scene) / (4.0 * h);
        let levers = levers(model);
        let mut work = model.work();
        let (mut r, mut phi) = (vec![0.0; shape.coordinates], vec![0.0; m]);
        let mut k = vec![0.0; model.symbolic().len()];
        model.linearise(&start, w, &mut r, &mut phi, &mut k, &mut work);
        let dense = model.symbolic().to_dense(&k);
        let mut evaluate = |s: &State| {
            model.residual(s, &mut r, &mut phi, &mut work);
            r[..n]
                .iter()
                .copied()
                .chain(phi.iter().map(|p| p / w.q))
                .collect::<Vec<f64>>()
        };
        // the multiplier of a row that is left out is zero and stays so
        let redundant = model.redundant();
        let kept = |j: &usize| !redundant.contains(&model.unknown_names()[*j]);
        for j in (0..n + m).filter(kept) {
            let mut moved = |by: f64| {
                let mut s = start.clone();
                if j < n {
                    s.a[j] += by;
                    s.v[j] += w.v * by;
                    s.q[j] += w.q * by;
                } else {
                    s.lambda[j - n] += by;
                }
                evaluate(&s)
            };
            let (low, high) = (moved(-h), moved(h));
            let column: Vec<f64> = (0..n + m).map(|i| (high[i] - low[i]) / (2.0 * h)).collect();
            let size = column.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            assert!(size > 0.0, "{name}: column {j} is empty");
            // rounding of positions counts for more where a unit of the coordinate moves them by less than 1 m
            let lever = levers.get(&j).unwrap_or(&1.0);
            let allowed = (2e-6 * size.max(1e-2) / lever).max(rounding);
            for i in 0..n + m {
                worst.at(format!("in entry ({i}, {j}) of {name}"));
                worst.see((column[i] - dense[(i, j)]) / allowed);
            }
        }
    }
    Rung::Derivatives
        .asks("Is the stage matrix of every scene the derivative of its residual? In units of 2e-6 of the largest entry of a column")
        .within(&worst,
            1.0,
            "rounding of positions, 1e-16/1e-8 in units of accelerations; for EA above 1e7 N, rounding of EA",
        );
}

/// A step allocates nothing, in any scene.
#[test]
fn steps_do_not_allocate() {
    for name in all_scenes() {
        let scene = beginning(&name, 0.004);
        if scene.simulation.analysis == Analysis::Static {
            continue; // no steps in time
        }
        let (simulation, from) = state(&scene);
        let model = simulation.model();
        let mut to = from.clone();
        let mut newton = Newton::new(model, scene.integrator.newton_tolerance_for(1.0));
        let mut work = model.work();
        let mut stepper = scene.integrator.method.stepper(model.shape());
        let info = allocation_counter::measure(|| {
            for k in 1..=3000 {
                let t = from.t + scene.integrator.step().unwrap() * (1.0 + 1e-4 * f64::from(k));
                stepper
                    .step(model, &from, t, &mut to, &mut newton, &mut work)
                    .unwrap();
            }
        });
        assert_eq!(info.count_total, 0, "{name}");
        // stages of an explicit scheme solve no equations
        let solved = match scene.integrator.method.name() {
            "bathe" => 2,
            "esdirk5" => 6,
            _ => 0,
        };
        assert_eq!(newton.counters.stages, 3000 * solved, "{name}");
    }
}

/// All scenes compile; a run repeated gives the same bytes.
#[test]
fn runs_are_repeatable() {
    for name in all_scenes() {
        let scene = beginning(&name, 0.01);
        let bits = |s: &State| {
            s.q.iter()
                .chain(&s.v)
                .chain(&s.a)
                .map(|x| x.to_bits())
                .collect::<Vec<_>>()
        };
        let (first, second) = (state(&scene), state(&scene));
        assert_eq!(bits(&first.1), bits(&second.1), "{name}");
        assert_eq!(first.0.report(), second.0.report(), "{name}");
    }
}

/// After every step velocities satisfy the constraints, and so do accelerations.
#[test]
fn accepted_states_are_consistent() {
    let worst = Worst::new();
    for name in ["3rrr/case1.toml", "3rrr/case2.toml", "3rrr/case3.toml"] {
        let span = ["simulation.duration=0.02", "output.interval=0.001"];
        let scene = load(name, &[&span[..], &NATURAL].concat());
        let (simulation, at) = state(&scene);
        let model = simulation.model();
        let mut rates = vec![1.0; model.shape().multipliers];
        model.constraint_velocity(&at, &mut rates);
        worst.at(format!("in {name}"));
        rates.iter().for_each(|r| worst.see(r / 1e-14));
        model.constraint_acceleration(&at, &mut rates);
        rates.iter().for_each(|r| worst.see(r / 1e-11));
        let (distance, ..) = model.worst_constraint(&at).unwrap();
        worst.see(distance / 1e-15);
    }
    Rung::Identities
        .asks("3-RRR (cases 1, 2, 3): violation of the constraints by accepted states, in units of 1e-14 m/s, 1e-11 m/s² and 1e-15 m")
        .within(&worst,
            1.0,
            "rounding of velocities near 1 m/s and of accelerations up to 1e3 m/s²",
        );
}

/// Constraints are opened by moving one coordinate at a time: the widest open one is named, with its distance.
#[test]
fn the_widest_open_constraint_is_named() {
    let scene = load(
        "3rrr/case1.toml",
        &["simulation.duration=1e-3", "output.interval=1e-3"],
    );
    let (simulation, accepted) = state(&scene);
    let model = simulation.model();
    let shape = model.shape();
    let mut phi = vec![0.0; shape.multipliers];
    let mut factors = model.acceleration_matrix().factors();
    // "joint C1 (x)" is a row of joint C1
    let constraint = |row: &str| row.split(" (").next().unwrap().to_owned();
    for i in 0..shape.unknowns {
        let mut at = accepted.clone();
        at.q[i] += 1e-3 * (1.0 + i as f64);
        model.acceleration_level(&at, &mut phi, &mut factors.gradient);
        let mut open = BTreeMap::<String, f64>::new();
        for (row, value) in phi.iter().enumerate() {
            let distance = open
                .entry(constraint(&model.unknown_name(shape.unknowns + row)))
                .or_default();
            *distance = distance.hypot(*value);
        }
        let (widest, open) = open.iter().max_by(|a, b| a.1.total_cmp(b.1)).unwrap();
        let (distance, _, name) = model.worst_constraint(&at).unwrap();
        assert_eq!(constraint(&name), *widest, "{i}");
        // two roundings of a square root
        assert!(
            (distance - open).abs() <= 2.0 * f64::EPSILON * open,
            "{i}: {distance} {open}"
        );
    }
}

/// Every effect is counted as often as a residual evaluates it; contacts count while they are closed.
#[test]
fn evaluations_of_effects_are_counted() {
    let scene = load("3rrr/case4-friction.toml", &[]);
    let simulation = Simulation::new(&scene).unwrap();
    let model = simulation.model();
    let shape = model.shape();
    let mut work = model.work();
    let (mut r, mut phi) = (vec![0.0; shape.coordinates], vec![0.0; shape.multipliers]);
    for _ in 0..2 {
        model.residual(simulation.state(), &mut r, &mut phi, &mut work);
    }
    let counted = model.effects().iter().zip(&work.tally);
    let counted: Vec<_> = counted.filter(|(_, count)| **count > 0).collect();
    // three links of one element; the journals start at the centres of their bearings
    assert_eq!(counted, [(&"ancf_elastic_force", &6)]);
    let settings = [&["simulation.gravity=[0.0, -9.81]"][..], &NATURAL].concat();
    let scene = load("3rrr/case1.toml", &settings);
    let simulation = Simulation::new(&scene).unwrap();
    let model = simulation.model();
    let mut work = model.work();
    let shape = model.shape();
    let (mut r, mut phi) = (vec![0.0; shape.coordinates], vec![0.0; shape.multipliers]);
    model.residual(simulation.state(), &mut r, &mut phi, &mut work);
    let of = |name: &str| work.tally[model.effects().iter().position(|e| *e == name).unwrap()];
    let names = ["length_constraint", "ideal_joint_constraint", "gravity"];
    assert_eq!(names.map(of), [3, 3, 1]);
}

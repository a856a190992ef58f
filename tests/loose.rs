//! Cases 3 and 4 and the bouncing journal: joints with clearance.

use crate::rrr;
use crate::support::{load, path, run};
use ladder::{Rung, Worst};
use looselink::contact::normal::NormalParameters;
use looselink::contact::normal::damped_power::LANKARANI_NIKRAVESH;
use looselink::scene::Scene;
use looselink::simulate::{
    ContactEvent, Control, Impact, Observer, Progress, Recording, RunError, Simulation,
};

/// Velocity of the journal after its first rebound over the velocity before, at a step that is a fraction of the
/// contact time.
fn rebound(restitution: f64, steps_a_contact: f64) -> f64 {
    // duration of the contact of the scene's journal, 3.3 (m v^2/K)^(2/5)/v, and the instant of its first touch
    let (mass, speed, clearance) = (0.05, 0.02, 2e-5);
    let stiffness: f64 = 1.17e11;
    let contact_time = 3.3 * (mass * speed * speed / stiffness).powf(0.4) / speed;
    let step = contact_time / steps_a_contact;
    let touch = clearance / speed;
    let rows = ((touch + 3.0 * contact_time) / step).ceil();
    let overrides = [
        format!("integrator.step={step:e}"),
        format!("output.interval={:e}", rows * step),
        format!("simulation.duration={:e}", rows * step),
        format!("contacts.aluminium.restitution={restitution}"),
        r#"output.channels=["journal.vx", "*.contact"]"#.to_owned(),
    ];
    let overrides: Vec<&str> = overrides.iter().map(String::as_str).collect();
    let (run, report) = run("bouncing-journal.toml", &overrides);
    assert_eq!(report.onsets, 1, "one impact is looked at");
    assert!(run.onsets[0].delta.abs() <= 1e-12);
    assert!(
        (run.onsets[0].impact_velocity / speed - 1.0).abs() < 1e-12,
        "nothing acts before the impact"
    );
    let vx = run.get("journal.vx");
    -vx[vx.len() - 1] / run.onsets[0].impact_velocity
}

/// chi = 8 (1 - c_e)/(5 c_e) has no value at zero.
#[test]
fn a_law_that_divides_by_the_restitution_refuses_zero() {
    let changes = [
        "contacts.aluminium.law=flores",
        "contacts.aluminium.restitution=0",
    ];
    let changes = changes.map(str::to_owned);
    let error = Scene::load(&path("bouncing-journal.toml"), &changes).unwrap_err();
    let expected = "`contacts.aluminium.restitution` must be greater than zero for law \"flores\"";
    assert!(error.to_string().contains(expected), "{error}");
}

#[test]
fn a_bouncing_journal_delivers_the_restitution_of_the_formula() {
    for typed in [0.95, 0.9, 0.7, 0.5, 0.3, 0.0] {
        let law = (LANKARANI_NIKRAVESH.build)(&NormalParameters {
            stiffness: 1.0,
            exponent: 1.5,
            restitution: typed,
            impact_velocity_floor: 1e-9,
            own: &[],
        });
        let exact = law.delivered_restitution();
        let errors: Vec<(f64, f64)> = [50.0, 71.0, 100.0, 141.0, 200.0]
            .iter()
            .map(|n| (1.0 / n, (rebound(typed, *n) - exact).abs()))
            .collect();
        Rung::OrderInTime
            .asks(format!("Bouncing journal, coefficient {typed}: restitution of the run against that of the law"))
            .falls_on_average(
                "Step h over the contact time",
                &errors,
                1.6..2.4,
                "order 2 on average: onset and end of the contact cut the steps differently for each h",
            );
    }
}

/// Instant and impact velocity of the fourth impact of the mechanism, the first that the method's error reaches (before
/// it the loose links move freely); the reference is the same method at 6.25e-8 s.
#[test]
fn case_3_impacts_converge_at_order_two() {
    let at = |h: f64| {
        let step = format!("integrator.step={h:e}");
        let overrides = [
            &step,
            "output.interval=5e-3",
            "simulation.duration=5e-3",
            "integrator.onset_tolerance=1e-15",
        ];
        run("3rrr/case3.toml", &overrides).0.onsets
    };
    let reference = at(6.25e-8);
    let (mut instants, mut velocities) = (Vec::new(), Vec::new());
    let (depths, first) = (Worst::new(), Worst::new());
    for h in [4e-6, 2e-6, 1e-6, 5e-7] {
        let onsets = at(h);
        onsets.iter().for_each(|o| depths.see(o.delta));
        assert_eq!(onsets[3].joint, reference[3].joint);
        first.see(onsets[0].t - reference[0].t);
        instants.push((h, (onsets[3].t - reference[3].t).abs()));
        velocities.push((
            h,
            (onsets[3].impact_velocity - reference[3].impact_velocity).abs(),
        ));
    }
    Rung::HardCases
        .asks("3-RRR with loose joints (case 3): penetration at the located onsets of contact over 5 ms [m]")
        .within(&depths, 1e-12, "far below penetrations of about 1e-7 m; the onset tolerance is 1e-15 m");
    Rung::HardCases
        .asks("3-RRR with loose joints (case 3): instant of the first impact at four steps against that at 6.25e-8 s [s]")
        .within(&first,
            1e-9,
            "the scheme has no error before this impact: rounding over the impact velocity",
        );
    for (quantity, errors) in [("instant [s]", instants), ("velocity [m/s]", velocities)] {
        Rung::OrderInTime
            .asks(format!(
                "3-RRR with loose joints (case 3), fourth impact: {quantity}"
            ))
            .falls(
                "Step h [s]",
                &errors,
                1.6..2.4,
                "order 2; the first impact with an error of the scheme; reference step 6.25e-8 s",
            );
    }
}

/// The triangle inequality of every leg, | |C - B| - l2 | <= |e_B| + |e_C|, at every recorded instant of 3 s; and the
/// mechanism rides on its linearisation.
#[test]
fn case_3_keeps_within_its_clearances() {
    let channels = r#"output.channels=["platform.*", "error.x", "*.eccentricity", "*.penetration", "*.contact"]"#;
    let (run, report) = run(
        "3rrr/case3.toml",
        &["integrator.step=1e-5", "output.interval=1e-4", channels],
    );
    assert_eq!(report.unlocated_changes, 0);
    let t = run.get("t");
    let [x, y, theta] = ["platform.x", "platform.y", "platform.theta"].map(|n| run.get(n));
    let eccentricity =
        |joint: &str, leg: usize| run.get(&format!("{joint}{}.eccentricity", leg + 1));
    let sides: Vec<_> = (0..3)
        .map(|leg| (eccentricity("B", leg), eccentricity("C", leg)))
        .collect();
    let beyonds = Worst::new();
    for k in 0..run.len() {
        for (leg, (b, c)) in sides.iter().enumerate() {
            let angle = rrr::angle(leg) + theta[k];
            let point =
                nalgebra::Vector2::new(x[k] + rrr::L3 * angle.cos(), y[k] + rrr::L3 * angle.sin());
            let stretch = ((point - rrr::pin(leg, t[k])).norm() - rrr::L2).abs();
            let beyond = stretch - (b[k] + c[k]);
            // written so that what is not a number is seen
            beyonds.see(if beyond <= 0.0 { 0.0 } else { beyond });
        }
    }
    Rung::HardCases
        .asks("3-RRR with loose joints (case 3), 3 s: stretch of a leg beyond the eccentricities of its two joints [m]")
        .within(&beyonds,
            1e-12,
            "the triangle inequality: rounding of coordinates near 0.4 m",
        );
    let error = run.get("error.x");
    let largest = Worst::new();
    for k in (0..run.len()).filter(|&k| t[k] >= 1.0) {
        let inverse = rrr::jacobian(t[k])
            .try_inverse()
            .expect("no pose of the path is singular");
        let bound: f64 = (0..3).map(|i| inverse[(0, i)].abs() * 2.0 * 2e-5).sum();
        largest.see(error[k] / bound);
    }
    Rung::HardCases
        .asks("3-RRR with loose joints (case 3): largest error of the platform along x over its linearised kinematic bound")
        .between(
            largest.value(),
            0.99..1.02,
            "the clearances are used up; contacts penetrate, and the bound is linear in the clearances",
        );
}

/// In the loose cases the integrator loses or gains little against what the contacts dissipate over the last two cycles,
/// at the step of the scenes, which the figures use.
#[test]
fn numerical_dissipation_is_small_against_that_of_the_contacts() {
    let worst = Worst::new();
    for case in [3, 4] {
        let channels = r#"output.channels=["energy.*"]"#;
        let overrides = ["output.interval=1e-2", channels];
        let (run, _) = run(&format!("3rrr/case{case}.toml"), &overrides);
        let over_two_cycles = |name: &str| {
            let values = run.get(name);
            values[values.len() - 1] - values[100]
        };
        assert!((run.get("t")[100] - 1.0).abs() < 1e-12);
        let (numerical, contact) = (
            over_two_cycles("energy.numerical"),
            over_two_cycles("energy.contact_dissipated"),
        );
        assert!(
            contact > 1e-6,
            "there is something to compare with: {contact:e}"
        );
        worst.see(numerical / contact);
    }
    Rung::Balance
        .asks("3-RRR with loose joints (cases 3 and 4), last two cycles: energy lost or gained by the integrator over the contact dissipation")
        .within(&worst,
            0.05,
            "the share above which a run warns"
        );
}

#[test]
fn no_friction_is_evaluated_unless_the_scene_names_it() {
    let short = ["simulation.duration=0.01", "output.interval=1e-3"];
    let (_, without) = run("3rrr/case4.toml", &short);
    assert!(!without.effects.contains_key("friction_law"));
    assert!(without.effects["contact_law"] > 0);
    let (_, with) = run("3rrr/case4-friction.toml", &short);
    assert!(with.effects["friction_law"] > 0);
    assert!(with.ledger.as_ref().unwrap().friction_dissipated >= 0.0);
    let material = [&short[..], &["contacts.pin.friction.slip=material"]].concat();
    let (_, slipping) = run("3rrr/case4-friction.toml", &material);
    // the printed slip is delta/e times the tangential rate of e: only the first impacts are fast enough for it
    let (printed, material) = (
        with.ledger.unwrap().friction_dissipated,
        slipping.ledger.unwrap().friction_dissipated,
    );
    assert!(material > 2.0 * printed, "{material:e} {printed:e}");
}

/// A contact of Hertz's law against its closed form: depth d = (5 m v^2/(4 K))^(2/5), duration d/v times
/// (4/5) sqrt(pi) Gamma(2/5)/Gamma(9/10) (Johnson, Contact Mechanics, section 11.4), and it leaves as fast as it came.
#[test]
fn a_contact_of_hertz_has_the_depth_and_the_duration_of_the_closed_form() {
    const DURATION: f64 = 2.943_275_184_3;
    let (mass, speed, stiffness): (f64, f64, f64) = (0.05, 0.02, 1e11);
    let depth = (1.25 * mass * speed * speed / stiffness).powf(0.4);
    let duration = DURATION * depth / speed;
    let law = "contacts.aluminium={law=\"hertz\",bearing_radius=0.01,clearance=2e-5,stiffness=1e11,exponent=1.5}";
    let mut errors = [const { Vec::new() }; 3];
    for steps in [50.0, 71.0, 100.0, 141.0, 200.0] {
        let step = duration / steps;
        let [step, rows] = [step, (1.5e-3 / step).ceil() * step];
        let overrides = [
            law.to_owned(),
            format!("integrator.step={step:e}"),
            format!("output.interval={rows:e}"),
            format!("simulation.duration={rows:e}"),
        ];
        let overrides: Vec<&str> = overrides.iter().map(String::as_str).collect();
        let (run, _) = run("bouncing-journal.toml", &overrides);
        let [contact] = &run.onsets[..] else {
            panic!("{:?}", run.onsets)
        };
        assert_eq!(contact.angle, 0.0);
        let [end, exit] = [contact.end, contact.exit_velocity].map(Option::unwrap);
        let found = [
            contact.deepest_penetration / depth,
            (end - contact.t) / duration,
            exit / speed,
        ];
        for (errors, found) in errors.iter_mut().zip(found) {
            errors.push((1.0 / steps, (found - 1.0).abs()));
        }
    }
    let cut =
        "order 2 on average: onset and end of the contact cut the steps differently for each h";
    let lost =
        "order 3 on average: what Bathe's scheme loses of the energy of a vibration falls as h^3";
    let answers = [
        ("depth", 1.6..2.4, cut),
        ("duration", 1.6..2.4, cut),
        ("exit velocity", 2.6..3.4, lost),
    ];
    for ((quantity, orders, reason), errors) in answers.into_iter().zip(errors) {
        Rung::OrderInTime
            .asks(format!(
                "Bouncing journal, Hertz's law: {quantity} of a contact against the closed form, relative error"
            ))
            .falls_on_average("Step h over the contact time", &errors, orders, reason);
    }
}

/// A run that is stopped tells the contact that is closed then.
#[test]
fn a_run_that_is_stopped_tells_the_contacts_that_are_closed() {
    #[derive(Default)]
    struct StopInContact(Vec<Impact>);
    impl Observer for StopInContact {
        fn row(&mut self, _: &[f64]) -> std::io::Result<()> {
            Ok(())
        }
        fn contact(&mut self, contact: &ContactEvent) -> std::io::Result<()> {
            self.0.push(contact.into());
            Ok(())
        }
        fn step(&mut self, progress: &Progress) -> std::io::Result<Control> {
            let closed = progress.contacts == Some(1) && progress.t > 1.02e-3;
            Ok(if closed {
                Control::Stop
            } else {
                Control::Continue
            })
        }
    }
    let mut reported = StopInContact::default();
    let mut simulation = Simulation::new(&load("bouncing-journal.toml", &[])).unwrap();
    let ended = simulation.run(&mut reported);
    assert!(matches!(ended, Err(RunError::Interrupted { .. })));
    assert_eq!(reported.0, simulation.report().impacts);
    assert_eq!((reported.0.len(), reported.0[0].end), (1, None));
    assert!(reported.0[0].deepest_penetration > 1e-7);
}

#[test]
fn a_recording_stops_a_run_after_its_most_steps() {
    let mut simulation = Simulation::new(&load("bouncing-journal.toml", &[])).unwrap();
    let mut recording = Recording::new(&simulation);
    recording.most_steps = 7;
    let ended = simulation.run(&mut recording);
    assert!(matches!(ended, Err(RunError::Interrupted { .. })));
    assert_eq!(simulation.report().steps, 7);
}

/// The rates of the eccentricity are the derivatives of the eccentricity, in the flight of six journals before any closes.
#[test]
fn rates_of_the_eccentricity_are_its_derivatives() {
    const INTERVAL: f64 = 2e-5;
    let overrides = [
        "integrator.method=dormand_prince",
        "integrator.step=1e-5",
        "output.interval=2e-5",
        "simulation.duration=3e-3",
        "output.channels=[\"*.e*\"]",
    ];
    let (run, report) = run("3rrr/case3.toml", &overrides);
    assert_eq!(report.onsets, 0);
    for quantity in ["ex", "ey", "eccentricity"] {
        let error = |span: usize| {
            let mut worst = 0.0_f64;
            for joint in ["B1", "B2", "B3", "C1", "C2", "C3"] {
                let value = run.get(&format!("{joint}.{quantity}"));
                let rate = run.get(&format!("{joint}.{quantity}_rate"));
                let size = rate.iter().fold(0.0_f64, |m, r| m.max(r.abs()));
                // near the centre the eccentricity grows as t^2, its rate as t, and the next derivative is not small
                for i in 50..value.len() - span {
                    let difference =
                        (value[i + span] - value[i - span]) / (2.0 * span as f64 * INTERVAL);
                    worst = worst.max((difference - rate[i]).abs() / size);
                }
            }
            worst
        };
        let errors = [8, 4, 2].map(|span| (span as f64 * INTERVAL, error(span)));
        Rung::Derivatives
            .asks(format!("Channel {quantity}_rate against the central difference of {quantity}, 3-RRR with loose joints, relative"))
            .falls("Span of the difference [s]", &errors, 1.8..2.2, "the error of a central difference");
    }
}

/// Rounding does not shake stiff links: at steps so small that Bathe's error is gone, the velocity of the first impact of
/// case 4 is the same at one step and at half of it.
#[test]
fn rounding_does_not_grow_with_the_number_of_steps() {
    let velocity = |step: &str| {
        let step = format!("integrator.step={step}");
        let (recording, _) = run(
            "3rrr/case4.toml",
            &[&step, "simulation.duration=0.0032", "output.interval=1e-4"],
        );
        recording.onsets[0].impact_velocity
    };
    let (coarse, fine) = (velocity("2.5e-8"), velocity("1.25e-8"));
    Rung::HardCases
        .asks("3-RRR with loose joints (case 4): first impact velocity at a step of 2.5e-8 s against half of it, relative")
        .within(
            coarse / fine - 1.0,
            5e-9,
            "coordinates summed without compensation scatter by 5e-8 and more the smaller the step",
        );
}

/// A run that takes over the state of another goes on as that one does, contacts that are closed included.
#[test]
fn a_run_takes_over_the_state_of_another() {
    let start = |x: &str| {
        let body = format!(
            "initial.bodies={{ platform = {{ x = {x}, y = 0.0, theta = 0.0, vx = 0.0, vy = 0.6283185307179586, omega = 0.0 }} }}"
        );
        let scene = load(
            "3rrr/case3.toml",
            &[&body, "integrator.step=5e-6", "output.interval=1e-3"],
        );
        Simulation::new(&scene).unwrap()
    };
    let (mut one, mut other) = (start("0.1"), start("0.100001"));
    let mut t = 0.0;
    // to the first row of the other run in which a contact is closed
    while other.model().closed(other.state()).next().is_none() {
        t += 1e-3;
        one.advance_to(t, &mut ()).unwrap();
        other.advance_to(t, &mut ()).unwrap();
        assert!(t < 0.1, "no contact is closed");
    }
    let apart = |one: &Simulation, other: &Simulation| {
        let pairs = one.state().q.iter().zip(&other.state().q);
        pairs.fold(0.0_f64, |worst, (a, b)| worst.max((a - b).abs()))
    };
    assert!(apart(&one, &other) > 1e-7, "the two motions differ");
    one.continue_from(other.state()).unwrap();
    one.advance_to(t + 2e-3, &mut ()).unwrap();
    other.advance_to(t + 2e-3, &mut ()).unwrap();
    let worst = Worst::new();
    worst.see(apart(&one, &other));
    Rung::Routes
        .asks("Case 3, run resumed from a state in contact: difference of all coordinates after 2 ms")
        .within(
            &worst,
            1e-12,
            "velocities are projected again with a rounding of 1e-16 m/s, which impacts amplify at most a thousandfold in 2 ms",
        );
}

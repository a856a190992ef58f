//! Andrews' squeezing mechanism of the Test Set for IVP Solvers (P), and the same equations integrated by extrapolation in
//! 80-bit arithmetic (I). Seven bodies, a torque, a spring.

use super::listed;
use crate::support::{TestRecording, run};
use ladder::{Rung, Worst};

const SOURCE: &str = "Test Set for IVP Solvers, problem Andrews, https://github.com/cran/deTestSet, src/Ex_andrews.f";
const SCENE: &str = "andrews-squeezer.toml";
const STATES: &str = include_str!("andrews.csv");
const TRAJECTORY: &str = include_str!("andrews_trajectory.csv");

/// Beta, Theta, gamma, Phi, delta, Omega, epsilon, or their derivatives, from those of the bodies: K2, K4 and K6 have sums.
fn minimal(run: &TestRecording, row: usize, quantity: &str) -> [f64; 7] {
    let of = |body: usize| run.get(&format!("K{body}.{quantity}"))[row];
    let [k1, k2, k3, k4, k5, k6, k7] = [1, 2, 3, 4, 5, 6, 7].map(of);
    [k1, k2 - k1, k3, k4 - k5, k5, k6 - k7, k7]
}

/// Angles, rates, accelerations and multipliers in the order of the list. M q'' = f - G^T lambda pushes K2 in E by the
/// negative sum of the multipliers, so they are the forces on the other three bodies there.
fn components(run: &TestRecording, row: usize) -> Vec<f64> {
    let forces = ["E3.fx", "E3.fy", "E4.fx", "E4.fy", "E6.fx", "E6.fy"];
    let forces = forces.map(|name| run.get(name)[row]);
    let angles = ["theta", "omega", "alpha"].map(|q| minimal(run, row, q));
    angles.into_iter().flatten().chain(forces).collect()
}

#[test]
fn the_squeezer_meets_the_listed_states() {
    let (run, _) = run(SCENE, &[]);
    let states = listed(STATES);
    assert_eq!(states.len(), 27);

    let start = components(&run, 0);
    let (angles, rest) = (Worst::new(), Worst::new());
    for (k, (got, state)) in start.iter().zip(&states).enumerate() {
        match k {
            0..14 => angles.see(got - state[0]),
            14..21 => rest.see((got - state[0]) / states[14][0]),
            _ => rest.see((got - state[0]) / states[21][0]),
        }
    }
    Rung::Published
        .asks("Andrews' mechanism: assembled angles against the published ones [rad]")
        .from(SOURCE).within(
            &angles,
            1e-13,
            "rounding of coordinates of 0.07 m over levers of 7 mm is 2e-15 rad; times fifty for the condition of the linear equations",
        );
    Rung::Published
        .asks("Andrews' mechanism: published accelerations and multipliers at the start, over the largest of each kind")
        .from(SOURCE).within(
            &rest,
            1e-12,
            "rounding of 2e-16, times some thousands for the condition of the linear equations",
        );

    let end = components(&run, run.row(0.03));
    let (published, independent) = (Worst::new(), Worst::new());
    for (k, (got, state)) in end.iter().zip(&states).enumerate() {
        published.at(format!("in component {}", k + 1));
        independent.at(format!("in component {}", k + 1));
        let digits = match k {
            0..7 => 1e-9,
            7..14 => 1e-7,
            _ => 1e-5,
        };
        published.see((got / state[1] - 1.0) / digits);
        independent.see(got / state[2] - 1.0);
    }
    Rung::Published
        .asks("Andrews' mechanism: published angles, rates, accelerations and multipliers after 30 ms, relative error in units of 1e-9, 1e-7, 1e-5 and 1e-5")
        .from(SOURCE).within(
            &published,
            1.0,
            "accuracy of the published digits: two independent integrations differ from them by up to 3e-10, 6e-8 and 1.3e-6",
        );
    Rung::Computed
        .asks("Andrews' mechanism: 27 components after 30 ms against extrapolation in 80-bit arithmetic, largest relative error")
        .within(
            &independent,
            1e-11,
            "the reference is accurate to 1e-12; an error of 1e-16 s in time is 3e-12 of gamma' = 11 rad/s, which changes by 3e5 rad/s²",
        );

    let trajectory = listed(TRAJECTORY);
    assert_eq!(trajectory.len(), 100);
    let (angles, rates) = (Worst::new(), Worst::new());
    for state in &trajectory {
        let row = run.row(state[0]);
        let got = minimal(&run, row, "theta");
        for (got, listed) in got.iter().zip(&state[1..8]) {
            angles.see((got - listed) / listed.abs().max(1.0));
        }
        let got = minimal(&run, row, "omega");
        for (got, listed) in got.iter().zip(&state[8..15]) {
            rates.see((got - listed) / 1000.0);
        }
    }
    const DIGITS: &str = "twelve digits are listed";
    Rung::Computed
        .asks("Andrews' mechanism: angles every 0.5 ms over 50 ms against the extrapolation, error over max(1, angle)")
        .within(&angles, 1e-11, DIGITS);
    Rung::Computed
        .asks("Andrews' mechanism: rates every 0.5 ms over 50 ms against the extrapolation, over 1000 rad/s")
        .within(&rates, 1e-11, DIGITS);

    // problem A03 of the IFToMM library, with all digits of the start
    let pin = Worst::new();
    for (t, x, y) in [
        (0.01, -0.0038905523886, 0.0058192441185),
        (0.03, -0.0069630394270, -0.0007183884307),
        (0.05, -0.0052085047223, 0.0046766952603),
    ] {
        let row = run.row(t);
        pin.see(run.get("points.K1.F.x")[row] - x);
        pin.see(run.get("points.K1.F.y")[row] - y);
    }
    Rung::Computed
        .asks("Andrews' mechanism (IFToMM A03): position of the point F after 10, 30 and 50 ms [m]")
        .within(&pin, 1e-13, "thirteen decimals are listed");
}

/// Errors of K1's angle after 30 ms.
fn errors(method: &[&str], steps: [f64; 3]) -> Vec<(f64, f64)> {
    let listed = listed(STATES)[0][2];
    let error = |step: f64| {
        let step_key = format!("integrator.step={step:?}");
        let mut overrides = vec![
            "simulation.duration=0.03",
            "output.interval=0.03",
            &step_key,
        ];
        overrides.extend(method);
        let (run, _) = run(SCENE, &overrides);
        (step, (run.get("K1.theta")[1] - listed).abs())
    };
    steps.map(error).to_vec()
}

#[test]
fn methods_converge_to_the_squeezer() {
    Rung::OrderInTime
        .asks("Andrews' mechanism, Dormand and Prince: angle of K1 after 30 ms against the extrapolation [rad]")
        .falls(
            "Step h [s]",
            &errors(&[], [5e-5, 2.5e-5, 1.25e-5]),
            4.7..5.3,
            "order 5",
        );
    let bathe = [
        "integrator.method=bathe",
        "integrator.newton_tolerance=1e-11",
    ];
    Rung::OrderInTime
        .asks("Andrews' mechanism, Bathe: angle of K1 after 30 ms against the extrapolation [rad]")
        .falls(
            "Step h [s]",
            &errors(&bathe, [1e-5, 5e-6, 2.5e-6]),
            1.9..2.1,
            "order 2",
        );
}

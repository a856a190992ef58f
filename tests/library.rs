//! The scenes with listed answers or closed forms, run as they stand in the folder.

use crate::support::{TestRecording, load, run};
use ladder::{Rung, Worst};

/// Errors of order 2 are 4/3 of the change that half the step makes.
const HALF_STEP: &str =
    "twice the change that half the step makes: an error of order 2 is 4/3 of it";

/// Errors of a run at some times in units of twice the change that half the step of its scene makes.
fn in_changes(scene: &str, coarse: &TestRecording, expected: &[(f64, &[(&str, f64)])]) -> Worst {
    let step = load(scene, &[]).integrator.step().unwrap();
    let (fine, _) = run(scene, &[&format!("integrator.step={:e}", 0.5 * step)]);
    let worst = Worst::new();
    for (t, expected) in expected {
        let row = fine.row(*t);
        let names = expected.iter().map(|(name, _)| *name);
        let finer: Vec<_> = names.map(|name| (name, fine.get(name)[row])).collect();
        worst.see(error(coarse, *t, expected) / (2.0 * error(coarse, *t, &finer)));
    }
    worst
}

/// Largest difference of channels from the given values at `t`.
fn error(run: &TestRecording, t: f64, expected: &[(&str, f64)]) -> f64 {
    let row = run.row(t);
    let worst = Worst::new();
    for (name, value) in expected {
        worst.see(run.get(name)[row] - value);
    }
    worst.value()
}

/// Closed forms of A01 and A02 of the IFToMM library.
#[test]
fn rigid_pendula() {
    let (x, y) = ("points.rod.bob.x", "points.rod.bob.y");
    let (pendulum, _) = run("pendulum.toml", &[]);
    let expected: [(f64, &[_]); 2] = [
        (2.0, &[(x, -0.7935661953433217), (y, -0.6084839304437915)]),
        (10.0, &[(x, -0.2750874625761169), (y, -0.9614192050991251)]),
    ];
    Rung::ClosedForms
        .asks("Scene of the pendulum: position after 2 and 10 s against the closed form, over its allowed error")
        .within(&in_changes("pendulum.toml", &pendulum, &expected), 1.0, HALF_STEP);
    let (windows, _) = run("n-four-bar.toml", &[]);
    let expected = [
        ("points.crank0.end.x", 0.3284583115408154),
        ("points.crank0.end.y", 0.944518538178601),
        ("points.crank0.end.vx", 1.423051470206944),
        ("points.crank0.end.vy", -0.494868845487043),
    ];
    Rung::ClosedForms
        .asks("Scene of four-bar windows: position and velocity after 10 s against the closed form, over their allowed error")
        .within(
            &in_changes("n-four-bar.toml", &windows, &[(10.0, &expected)]),
            1.0,
            HALF_STEP,
        );
    let [a, b] = ["points.crank0.end.y", "points.crank2.end.y"].map(|name| windows.get(name));
    let apart = Worst::new();
    for (a, b) in a.iter().zip(&b) {
        apart.see(a - b);
    }
    Rung::HardCases
        .asks("Scene of four-bar windows through singular poses: difference between the heights of its parallel cranks [m]")
        .within(&apart, 1e-12, "rounding; in another branch the cranks turn apart");
}

#[test]
fn springs() {
    let (pendulum, _) = run("stiff-spring-pendulum.toml", &[]);
    // IVP test set
    let expected = [
        ("points.bob.center.x", -0.8115763676573986),
        ("points.bob.center.y", -0.5842493516781946),
        ("points.bob.center.vx", -0.6315526595574175),
        ("points.bob.center.vy", 0.8772895105102342),
    ];
    Rung::Computed
        .asks(
            "Scene of the stiff spring pendulum: listed position and velocity after 10 s, over their allowed error",
        )
        .within(
            &in_changes("stiff-spring-pendulum.toml", &pendulum, &[(10.0, &expected)]),
            1.0,
            HALF_STEP,
        );

    let worst = Worst::new();
    let (springs, report) = run("three-spring.toml", &[]);
    for (t, u3, v2, a2) in [
        (
            2.618,
            1.350250392185526,
            -1.20978377126957,
            -0.2110885016206534,
        ),
        (
            5.236,
            -2.328597022818121,
            1.209783679675866,
            0.2110784811474854,
        ),
        (
            15.708,
            0.1159675137134148,
            1.20978331658636,
            0.2110377633458582,
        ),
    ] {
        worst.see(error(&springs, t, &[("node3.x", u3), ("node2.vx", v2)]) / 1e-13);
        worst.see(error(&springs, t, &[("node2.ax", a2)]) / 1e-8);
    }
    Rung::Computed
        .asks("Scene of three springs: difference from the recursion of the scheme in forty digits, in units of 1e-13 m, 1e-13 m/s and 1e-8 m/s²")
        .within(&worst,
            1.0,
            "rounding only, for accelerations times 1e7 N/m",
        );
    assert!(report.ledger.unwrap().work > 1.0);
}

/// Answers for the strain energies of the element, computed independently.
#[test]
fn flexible_links() {
    let tip = |x, y| [("points.rod.end.x", x), ("points.rod.end.y", y)];
    let (soft, _) = run("soft-pendulum.toml", &[]);
    let early = tip(0.37440255359, -1.22867318529);
    let late = tip(-1.01422964674, 0.08671153848);
    let (stiff, _) = run("stiff-pendulum.toml", &[]);
    let rigid = tip(-0.9999668924, -0.0081396260);
    Rung::Computed
        .asks("Scene of the soft pendulum: listed positions of the tip, over their allowed error")
        .within(
            &in_changes("soft-pendulum.toml", &soft, &[(0.5, &early), (1.1, &late)]),
            1.0,
            HALF_STEP,
        );
    Rung::Computed
        .asks("Scene of the stiff pendulum: listed position of the tip, over its allowed error")
        .within(
            &in_changes("stiff-pendulum.toml", &stiff, &[(1.0, &rigid)]),
            1.0,
            HALF_STEP,
        );

    let tip = |x, y| [("points.beam.end.x", x), ("points.beam.end.y", y)];
    let (cantilever, _) = run("cantilever-static.toml", &[]);
    let expected = tip(2.0 - 0.509285882511, -1.207364220014);
    Rung::Computed
        .asks("Scene of the static cantilever: listed position of the tip [m]")
        .within(
            error(&cantilever, 1.0, &expected),
            1e-11,
            "the listed digits",
        );
    let (falling, _) = run("cantilever-dynamic.toml", &[]);
    let expected = tip(2.0 - 0.50208361507, -1.23254150237);
    let late = falling.row(19.0);
    let heights = &falling.get("points.beam.end.y")[late..];
    let highest = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
    let swing = highest - lowest;
    Rung::Computed
        .asks("Scene of the falling cantilever: position of the tip after 20 s against the listed equilibrium [m]")
        .within(
            error(&falling, 20.0, &expected),
            swing,
            "the range of the tip within the last second: it still vibrates",
        );
    let (circle, _) = run("roll-up.toml", &[]);
    let [x, y] = ["x", "y"].map(|i| *circle.get(&format!("points.beam.end.{i}")).last().unwrap());
    Rung::Computed
        .asks("Scene of the roll-up: listed distance of the tip from the clamp, relative error")
        .within(x.hypot(y) / 9.91e-5 - 1.0, 1e-3, "three digits are listed");
}

/// The blade ends steadily longer by the closed form, and the work of its drive is what its energy grows by.
#[test]
fn spin_up() {
    let (blade, report) = run("spin-up.toml", &[]);
    let [x, y] = ["x", "y"].map(|i| blade.get(&format!("points.blade.end.{i}")));
    let late = blade.get("t").iter().position(|t| *t >= 18.0).unwrap();
    let count = (x.len() - late) as f64;
    let mean = (late..x.len())
        .map(|k| (x[k].hypot(y[k]) - 10.0) / count)
        .sum::<f64>();
    Rung::ClosedForms
        .asks("Scene of the spin-up: mean extension from 18 s on against the closed form, relative error")
        .within(
            mean / 5.142698461778e-4 - 1.0,
            1e-4,
            "residual vibration of the blade",
        );
    let ledger = report.ledger.unwrap();
    Rung::Balance
        .asks("Scene of the spin-up: numerical loss of energy over the kinetic energy")
        .within(
            ledger.numerical / ledger.stored.kinetic,
            1e-4,
            "the relative accuracy that the extension is asked for",
        );
}

#[test]
fn driven_mechanisms() {
    let (ideal, _) = run("slider-crank/ideal.toml", &[]);
    let [r, l, w] = [0.05_f64, 0.12, 523.598775598299];
    let worst = Worst::new();
    for (t, x) in ideal.get("t").iter().zip(ideal.get("slider.x")) {
        let exact = r * (w * t).cos() + (l * l - (r * (w * t).sin()).powi(2)).sqrt();
        worst.see(x - exact);
    }
    Rung::Routes
        .asks("Scene of the ideal slider-crank: position of the slider against the closed form [m]")
        .within(&worst, 1e-14, "rounding");
    let (shaper, _) = run("quick-return.toml", &[]);
    let x = shaper.get("points.lever.end.x");
    let least = x.iter().copied().min_by(f64::total_cmp).unwrap();
    let greatest = x.iter().copied().max_by(f64::total_cmp).unwrap();
    Rung::Routes
        .asks("Scene of the quick return: stroke of the lever's end against the closed form [m]")
        .within(
            greatest - least - 0.4,
            1e-5,
            "the lever swings by asin(0.1/0.25) to each side; there are 500 rows per turn",
        );
}

/// The loose slider-crank runs twenty turns, and its first three impacts converge at the order of the scheme.
#[test]
fn a_loose_slider_crank() {
    let scene = "slider-crank/loose.toml";
    let (_, report) = run(scene, &["simulation.duration=0.24", "output.interval=1e-3"]);
    assert!((report.t - 0.24).abs() < 1e-15);
    assert_eq!(report.rejected_steps + report.unlocated_changes, 0);
    let ledger = report.ledger.unwrap();
    Rung::HardCases
        .asks("Scene of the loose slider-crank, 20 turns: numerical loss of energy over the contact dissipation")
        .within(
            ledger.numerical / ledger.contact_dissipated,
            0.05,
            "the part of the dissipation above which a run warns",
        );

    let impacts = |step: f64| {
        let step = format!("integrator.step={step:e}");
        let overrides = ["simulation.duration=1e-3", "output.interval=1e-3", &step];
        let (_, report) = run(scene, &overrides);
        let quantities = report.impacts.iter().take(3);
        let quantities =
            quantities.map(|i| [i.t, i.impact_velocity, i.angle, i.deepest_penetration]);
        quantities.collect::<Vec<_>>()
    };
    let reference = impacts(6.25e-8);
    let steps = [1e-6, 5e-7, 2.5e-7];
    let runs = steps.map(impacts);
    for k in 0..3 {
        for (q, name) in ["instant", "impact velocity", "angle", "depth"]
            .iter()
            .enumerate()
        {
            let error = |run: &[[f64; 4]]| (run[k][q] / reference[k][q] - 1.0).abs();
            let errors: Vec<_> = steps
                .iter()
                .zip(&runs)
                .map(|(h, run)| (*h, error(run)))
                .collect();
            // the first impact ends a free flight: rounding of its instant and speed
            if errors[2].1 > 1e-8 {
                Rung::OrderInTime
                    .asks(format!(
                        "Loose slider-crank, impact {}: {name}, relative error",
                        k + 1
                    ))
                    .falls_on_average(
                        "Step h [s]",
                        &errors,
                        1.3..2.7,
                        "order 2 on average: contacts cut the steps differently for each h",
                    );
            }
        }
    }
}

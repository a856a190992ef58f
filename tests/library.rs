//! The scenes with published or exact answers, run as they stand in the folder.
//!
//! Tolerances are about three times the errors measured at the step of each scene.

use crate::support::{Recording, assert_fitted_order, run};

/// Asserts that channels have the given values in the row nearest to `t`.
fn check(scene: &str, run: &Recording, t: f64, expected: &[(&str, f64)], tolerance: f64) {
    let times = run.get("t");
    let row = (0..times.len())
        .min_by(|a, b| (times[*a] - t).abs().total_cmp(&(times[*b] - t).abs()))
        .unwrap();
    assert!((times[row] - t).abs() < 1e-9, "{scene} has no row at {t}");
    for (name, value) in expected {
        let found = run.get(name)[row];
        assert!(
            (found - value).abs() < tolerance,
            "{scene}, {name} at {t}: {found}, not {value}"
        );
    }
}

/// Closed forms of A01 and A02 of the IFToMM library.
#[test]
fn rigid_pendula() {
    let (x, y) = ("points.rod.bob.x", "points.rod.bob.y");
    let (pendulum, _) = run("pendulum.toml", &[]);
    for (t, at) in [
        (2.0, [-0.7935661953433217, -0.6084839304437915]),
        (10.0, [-0.2750874625761169, -0.9614192050991251]),
    ] {
        check("pendulum", &pendulum, t, &[(x, at[0]), (y, at[1])], 1e-6);
    }
    let (windows, _) = run("n-four-bar.toml", &[]);
    let expected = [
        ("points.crank0.end.x", 0.3284583115408154),
        ("points.crank0.end.y", 0.944518538178601),
        ("points.crank0.end.vx", 1.423051470206944),
        ("points.crank0.end.vy", -0.494868845487043),
    ];
    check("n-four-bar", &windows, 10.0, &expected, 1.2e-6);
    // it stays a row of parallelograms when it goes through its singular poses
    let [a, b] = ["points.crank0.end.y", "points.crank2.end.y"].map(|name| windows.get(name));
    assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-12));
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
    check("stiff-spring-pendulum", &pendulum, 10.0, &expected, 2.5e-8);

    // The recursion of the scheme in forty digits: no error of its own but rounding, of accelerations that of 1e7 N/m.
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
        check("three-spring", &springs, t, &[("node3.x", u3)], 1e-13);
        check("three-spring", &springs, t, &[("node2.vx", v2)], 1e-13);
        check("three-spring", &springs, t, &[("node2.ax", a2)], 1e-8);
    }
    assert!(report.ledger.unwrap().work > 1.0);
}

/// Answers for the strain energies of the element, computed independently.
#[test]
fn flexible_links() {
    let tip = |x, y| [("points.rod.end.x", x), ("points.rod.end.y", y)];
    let (soft, _) = run("soft-pendulum.toml", &[]);
    check(
        "soft-pendulum",
        &soft,
        0.5,
        &tip(0.37440255359, -1.22867318529),
        2e-7,
    );
    check(
        "soft-pendulum",
        &soft,
        1.1,
        &tip(-1.01422964674, 0.08671153848),
        1e-6,
    );
    let (stiff, _) = run("stiff-pendulum.toml", &[]);
    check(
        "stiff-pendulum",
        &stiff,
        1.0,
        &tip(-0.9999668924, -0.0081396260),
        3e-7,
    );

    let tip = |x, y| [("points.beam.end.x", x), ("points.beam.end.y", y)];
    let (cantilever, _) = run("cantilever-static.toml", &[]);
    let expected = tip(2.0 - 0.509285882511, -1.207364220014);
    // the digits listed
    check("cantilever-static", &cantilever, 1.0, &expected, 1e-11);
    let (falling, _) = run("cantilever-dynamic.toml", &[]);
    let expected = tip(2.0 - 0.50208361507, -1.23254150237);
    check("cantilever-dynamic", &falling, 20.0, &expected, 1.5e-4);
    let (circle, _) = run("roll-up.toml", &[]);
    let [x, y] = ["x", "y"].map(|i| *circle.get(&format!("points.beam.end.{i}")).last().unwrap());
    assert!((x.hypot(y) / 9.91e-5 - 1.0).abs() < 1e-3, "{x} {y}");
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
    // the blade still vibrates a little
    assert!((mean / 5.142698461778e-4 - 1.0).abs() < 1e-4, "{mean:e}");
    let ledger = report.ledger.unwrap();
    assert!(ledger.numerical.abs() < 1e-5 * ledger.kinetic, "{ledger:?}");
}

#[test]
fn driven_mechanisms() {
    let (ideal, _) = run("slider-crank/ideal.toml", &[]);
    let [r, l, w] = [0.05_f64, 0.12, 523.598775598299];
    for (t, x) in ideal.get("t").iter().zip(ideal.get("slider.x")) {
        let exact = r * (w * t).cos() + (l * l - (r * (w * t).sin()).powi(2)).sqrt();
        // rounding
        assert!((x - exact).abs() < 1e-14, "{t}: {x} {exact}");
    }
    // The lever swings by asin(0.1/0.25) to both sides; a row every 1/500 of a turn.
    let (shaper, _) = run("quick-return.toml", &[]);
    let x = shaper.get("points.lever.end.x");
    let least = x.iter().copied().fold(f64::INFINITY, f64::min);
    let greatest = x.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    assert!((greatest - least - 0.4).abs() < 1e-5, "{least} {greatest}");
}

/// The loose slider-crank runs twenty turns, and its first three impacts converge at the order of the scheme.
#[test]
fn a_loose_slider_crank() {
    let scene = "slider-crank/loose.toml";
    let (_, report) = run(scene, &["simulation.duration=0.24", "output.interval=1e-3"]);
    assert!((report.t - 0.24).abs() < 1e-15);
    assert_eq!(report.rejected_steps + report.unlocated_changes, 0);
    let ledger = report.ledger.unwrap();
    assert!(
        ledger.numerical.abs() < 1e-3 * ledger.contact_dissipated,
        "{ledger:?}"
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
            assert!(errors[2].1 < 2e-5, "impact {k}, {name}: {errors:?}");
            // the first impact ends a free flight: rounding of its instant and speed
            if errors[2].1 > 1e-8 {
                assert_fitted_order(&format!("impact {k}, {name}"), &errors, 1.3..2.7);
            }
        }
    }
}

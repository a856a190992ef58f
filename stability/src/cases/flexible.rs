//! Links that bend, from chains to bars.

use super::{Check, apart, column, gain, imbalance, largest, lost, order, run};
use looselink::simulate::Recording;

const LINK: &str = "hard/spinning-link.toml";

/// Momentum of the link over that of its start, less 1, and its angular momentum about the centre.
pub(super) struct Momenta {
    /// Largest deviation of the velocity of the centre of mass over it.
    pub linear: f64,
    /// Least and greatest energy of the ledger over the energy at the start: gained, relative.
    pub gain: f64,
    /// Energy lost, relative.
    pub lost: f64,
    /// Angle that the chord has turned by \[rad\].
    pub angle: f64,
}

/// Flies the link.
pub(super) fn fly(step: f64, duration: f64, rows: usize) -> Momenta {
    let settings = [
        format!("integrator.step={step}"),
        format!("simulation.duration={duration}"),
        format!("output.interval={}", duration / rows as f64),
    ];
    let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
    let (recording, report) = run(LINK, &settings);
    let velocity = |name: &str| column(&recording, name).to_vec();
    let [vx, vy] = [velocity("rod.vx"), velocity("rod.vy")];
    let drift = |v: &[f64]| largest(v.iter().map(|x| x - v[0]));
    let speed = vx[0].hypot(vy[0]);
    let theta = column(&recording, "rod.theta");
    Momenta {
        linear: drift(&vx).max(drift(&vy)) / speed,
        gain: gain(&report),
        lost: lost(&report)[1],
        angle: theta[theta.len() - 1],
    }
}

pub(super) fn spinning_link() -> Vec<Check> {
    // angular momentum is not a channel: its error is that of the angle, which grows with time
    let fine = fly(2.5e-5, 0.5, 10).angle;
    let error = |h: f64| (h, (fly(h, 0.5, 10).angle - fine).abs());
    let long = fly(5e-4, 50.0, 100);
    vec![
        Check::below(
            "100,000 steps at 1/20 of a period: change of the velocity of the centre of mass, relative",
            long.linear,
            1e-10,
        ),
        Check::below("The same: energy gained, relative", long.gain, 1e-12),
        Check::below("The same: energy lost, relative", long.lost, 1e-3),
        Check::new(
            "Order of the error of the angle after 0.5 s in the step",
            order(error(4e-4), error(2e-4)),
            1.8..=2.2,
        ),
    ]
}

pub(super) fn rigid_limit() -> Vec<Check> {
    let settings = [
        "simulation.duration=0.02",
        "output.interval=1e-3",
        "integrator.step=1e-5",
    ];
    let (rigid, _) = run("3rrr/case1.toml", &settings);
    let flexible = |modulus: f64| {
        let modulus_set = format!("materials.passive.youngs_modulus={modulus:e}");
        let (recording, _) = run(
            "3rrr/case2.toml",
            &[&settings[..], &[modulus_set.as_str()]].concat(),
        );
        (modulus, apart(&recording, &rigid, "platform.x"))
    };
    let near_buckling = flexible(7e7);
    let [soft, stiff, stiffest] = [7e9, 7e11, 7e13].map(flexible);
    vec![
        Check::new(
            "Order of the distance from the rigid mechanism in Young's modulus, 7e9 to 7e11 Pa",
            order(soft, stiff),
            -1.2..=-0.8,
        ),
        Check::below(
            "Distance from the rigid mechanism at 7e13 Pa [m]",
            stiffest.1,
            1e-9,
        ),
        Check::new(
            "Distance at 7e7 Pa, bounded [m]",
            near_buckling.1,
            0.0..=0.05,
        ),
    ]
}

pub(super) fn platform_mass() -> Vec<Check> {
    let settings = ["simulation.duration=0.006", "output.interval=2e-4"];
    let masses = [5e-4, 5e-3, 5e-2, 5e-1, 5.0, 5e1, 5e2, 5e3];
    let run = |mass: f64, step: &str| {
        let mass = format!("bodies.platform.mass={mass}");
        run("3rrr/case4.toml", &[&settings[..], &[&mass, step]].concat())
    };
    let (mut error, mut balance) = (0.0_f64, 0.0_f64);
    for mass in masses {
        let (coarse, report) = run(mass, "integrator.step=2e-6");
        let (fine, _) = run(mass, "integrator.step=2.5e-7");
        error = error.max(apart(&coarse, &fine, "platform.x"));
        balance = balance.max(imbalance(&report));
    }
    vec![
        Check::below(
            "Eight masses from 0.5 g to 5 t, step 2 us: distance from an eighth of the step after 6 ms [m]",
            error,
            2e-6, // a tenth of the clearance
        ),
        Check::below(
            "Energy lost or gained by the integrator, relative",
            balance,
            1e-3,
        ),
    ]
}

fn tip(recording: &Recording) -> [f64; 2] {
    ["points.rod.end.x", "points.rod.end.y"].map(|name| {
        let column = column(recording, name);
        column[column.len() - 1]
    })
}

pub(super) fn elements() -> Vec<Check> {
    let settings = [
        "simulation.duration=0.2",
        "output.interval=0.02",
        "integrator.step=1e-3",
    ];
    let run = |more: &str| run("soft-pendulum.toml", &[&settings[..], &[more]].concat());
    let tips = |n: usize| tip(&run(&format!("bodies.rod.elements={n}")).0);
    let exact = tips(256);
    let error = |n: usize| {
        let tip = tips(n);
        (1.0 / n as f64, (tip[0] - exact[0]).hypot(tip[1] - exact[1]))
    };
    let (coarse, fine, finest) = (error(4), error(16), error(128));
    let (_, slender) = run("sections.rod.width=1.2e-4");
    let (_, stubby) = run("sections.rod.width=0.12");
    vec![
        Check::new(
            "Order of the tip in the length of an element, 4 to 16 elements",
            order(coarse, fine),
            2.0..=6.0,
        ),
        Check::below(
            "Tip with 128 elements against 256, in a length of 1.2 m [m]",
            finest.1,
            1.2e-6,
        ),
        Check::below(
            "Slenderness 10,000: energy lost or gained, relative",
            imbalance(&slender),
            0.02,
        ),
        Check::below(
            "Slenderness 10: energy lost or gained, relative",
            imbalance(&stubby),
            0.02,
        ),
    ]
}

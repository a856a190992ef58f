//! Links that bend, from chains to bars.

use super::{Check, apart, column, gain, imbalance, largest, load, lost, order, run};
use looselink::body::FlexibleLink;
use looselink::math::quadrature::GAUSS5;
use looselink::model::Model;
use looselink::simulate::{Recording, Simulation};
use looselink::system::State;

const LINK: &str = "hard/spinning-link.toml";

/// What a free flight has changed.
pub(super) struct Flight {
    /// Largest deviation of the velocity of the centre of mass, relative.
    pub linear: f64,
    /// Angular momentum about the origin at the end over that at the start, less 1.
    pub angular: f64,
    /// Energy gained, relative.
    pub gain: f64,
    /// Energy lost, relative.
    pub lost: f64,
    /// Angle that the chord has turned by \[rad\].
    pub angle: f64,
}

/// Angular momentum about the origin of a link of unit mass a length \[m3/s\]: int r x r_dot dx, by quadrature.
fn spin(model: &Model, at: &State) -> f64 {
    let links = model.bodies().iter().filter_map(|body| {
        let link = body.placed.kind.get::<FlexibleLink>()?;
        Some((&body.placed.x, link.element_length()))
    });
    let of_link = |(x, l): (&Vec<usize>, f64)| -> f64 {
        let of_element = |x: &[usize]| -> f64 {
            let (nodes, slopes) = ([x[0], x[2]], [x[1], x[3]]);
            let part = |&(xi, weight): &(f64, f64)| {
                let (x2, x3) = (xi * xi, xi * xi * xi);
                let shapes = [1.0 - 3.0 * x2 + 2.0 * x3, 3.0 * x2 - 2.0 * x3];
                let tangents = [l * (xi - 2.0 * x2 + x3), l * (x3 - x2)];
                let along = |q: &[f64], d: usize| -> f64 {
                    let of =
                        |k: usize| shapes[k] * q[nodes[k] + d] + tangents[k] * q[slopes[k] + d];
                    of(0) + of(1)
                };
                weight * l * (along(&at.q, 0) * along(&at.v, 1) - along(&at.q, 1) * along(&at.v, 0))
            };
            GAUSS5.iter().map(part).sum()
        };
        x.windows(4).step_by(2).map(of_element).sum()
    };
    links.map(of_link).sum()
}

/// Flies the link.
pub(super) fn fly(step: f64, duration: f64, rows: usize) -> Flight {
    let settings = [
        format!("integrator.step={step}"),
        format!("simulation.duration={duration}"),
        format!("output.interval={}", duration / rows as f64),
    ];
    let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
    let mut simulation = Simulation::new(&load(LINK, &settings)).expect("a shipped scene");
    let before = spin(simulation.model(), simulation.state());
    let mut recording = Recording::new(&simulation);
    simulation.run(&mut recording).expect("a flight to its end");
    let after = spin(simulation.model(), simulation.state());
    let report = simulation.report();
    let velocity = |name: &str| column(&recording, name).to_vec();
    let [vx, vy] = [velocity("rod.vx"), velocity("rod.vy")];
    let drift = |v: &[f64]| largest(v.iter().map(|x| x - v[0]));
    let speed = vx[0].hypot(vy[0]);
    let theta = column(&recording, "rod.theta");
    Flight {
        linear: drift(&vx).max(drift(&vy)) / speed,
        angular: after / before - 1.0,
        gain: gain(&report),
        lost: lost(&report)[1],
        angle: theta[theta.len() - 1],
    }
}

pub(super) fn spinning_link() -> Vec<Check> {
    let fine = fly(2.5e-5, 0.5, 10).angle;
    let flights = [4e-4, 2e-4].map(|h| (h, fly(h, 0.5, 10)));
    let [coarse, half] = flights
        .each_ref()
        .map(|(h, f)| (*h, (f.angle - fine).abs()));
    let [coarse_spin, half_spin] = flights.each_ref().map(|(h, f)| (*h, f.angular.abs()));
    let long = fly(5e-4, 50.0, 100);
    vec![
        Check::below(
            "100,000 steps of 1/20 of a period: change of the velocity of the centre of mass, relative",
            long.linear,
            1e-10,
        ),
        Check::below("The same: energy gained, relative", long.gain, 1e-12),
        Check::below("The same: energy lost, relative", long.lost, 1e-3),
        Check::new(
            "Order in time of the angle after 0.5 s",
            order(coarse, half),
            1.8..=2.2,
        ),
        Check::new(
            "Order in time of the change of angular momentum after 0.5 s",
            order(coarse_spin, half_spin),
            1.8..=2.2,
        ),
        Check::below(
            "100,000 steps: change of angular momentum, relative",
            long.angular.abs(),
            1e-3,
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
            "Order of the difference from the rigid mechanism in Young's modulus, 7e9 to 7e11 Pa",
            order(soft, stiff),
            -1.2..=-0.8,
        ),
        Check::below(
            "Difference from the rigid mechanism at 7e13 Pa [m]",
            stiffest.1,
            1e-9,
        ),
        Check::new(
            "Difference from it at 7e7 Pa [m]",
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
            "Eight masses from 0.5 g to 5 t, step 2 us: difference within 6 ms from a run with an eighth of the step [m]",
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
            "Order of the tip's position in the element length, 4 to 16 elements",
            order(coarse, fine),
            2.0..=6.0,
        ),
        Check::below(
            "Tip of a rod of 1.2 m, 128 against 256 elements [m]",
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

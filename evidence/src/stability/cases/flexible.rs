//! Links that bend, from chains to bars.

use super::{apart, column, gain, imbalance, largest, load, lost, order, run};
use looselink::body::FlexibleLink;
use looselink::math::quadrature::GAUSS5;
use looselink::model::Model;
use looselink::simulate::{Recording, Simulation};
use looselink::system::State;

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
    let settings = format!("integrator.step={step}; simulation.duration={duration}");
    let rows = format!("{settings}; output.interval={}", duration / rows as f64);
    let scene = load("hard/spinning-link.toml", &rows);
    let mut simulation = Simulation::new(&scene).expect("a shipped scene");
    let before = spin(simulation.model(), simulation.state());
    let mut recording = Recording::new(&simulation);
    simulation.run(&mut recording).expect("a flight to its end");
    let after = spin(simulation.model(), simulation.state());
    let report = simulation.report();
    let [vx, vy, theta] = ["rod.vx", "rod.vy", "rod.theta"].map(|name| column(&recording, name));
    let drift = [vx, vy].map(|v| largest(v.iter().map(|x| x - v[0])));
    Flight {
        linear: largest(drift) / vx[0].hypot(vy[0]),
        angular: after / before - 1.0,
        gain: gain(&report),
        lost: lost(&report)[1],
        angle: theta[theta.len() - 1],
    }
}

pub(super) fn spinning_link() -> Vec<f64> {
    let fine = fly(2.5e-5, 0.5, 10).angle;
    let [coarse, half] = [4e-4, 2e-4].map(|h| {
        let flight = fly(h, 0.5, 10);
        ((h, (flight.angle - fine).abs()), (h, flight.angular.abs()))
    });
    let long = fly(5e-4, 50.0, 100);
    vec![
        long.linear,
        long.gain,
        long.lost,
        order(coarse.0, half.0),
        order(coarse.1, half.1),
        long.angular.abs(),
    ]
}

pub(super) fn rigid_limit() -> Vec<f64> {
    let settings = "simulation.duration=0.02; output.interval=1e-3; integrator.step=1e-5";
    let (rigid, _) = run("3rrr/case1.toml", settings);
    let [near_buckling, soft, stiff, stiffest] = [7e7, 7e9, 7e11, 7e13].map(|modulus| {
        let set = format!("{settings}; materials.passive.youngs_modulus={modulus:e}");
        (
            modulus,
            apart(&run("3rrr/case2.toml", &set).0, &rigid, "platform.x"),
        )
    });
    vec![order(soft, stiff), stiffest.1, near_buckling.1]
}

pub(super) fn platform_mass() -> Vec<f64> {
    let found = [5e-4, 5e-3, 5e-2, 5e-1, 5.0, 5e1, 5e2, 5e3].map(|mass: f64| {
        let settings = format!(
            "simulation.duration=0.006; output.interval=2e-4; bodies.platform.mass={mass}; integrator.step"
        );
        let (coarse, report) = run("3rrr/case4.toml", &format!("{settings}=2e-6"));
        let (fine, _) = run("3rrr/case4.toml", &format!("{settings}=2.5e-7"));
        (apart(&coarse, &fine, "platform.x"), imbalance(&report))
    });
    vec![largest(found.map(|f| f.0)), largest(found.map(|f| f.1))]
}

pub(super) fn elements() -> Vec<f64> {
    let settings = "simulation.duration=0.2; output.interval=0.02; integrator.step=1e-3";
    let run = |more: &str| run("soft-pendulum.toml", &format!("{settings}; {more}"));
    let tip = |n: usize| {
        let (rows, _) = run(&format!("bodies.rod.elements={n}"));
        ["points.rod.end.x", "points.rod.end.y"].map(|name| column(&rows, name)[rows.rows() - 1])
    };
    let exact = tip(256);
    let error = |n: usize| {
        let [x, y] = tip(n);
        (1.0 / n as f64, (x - exact[0]).hypot(y - exact[1]))
    };
    vec![
        order(error(4), error(16)),
        error(128).1,
        imbalance(&run("sections.rod.width=1.2e-4").1),
        imbalance(&run("sections.rod.width=0.12").1),
    ]
}

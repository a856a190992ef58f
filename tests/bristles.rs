//! Friction with bristles in motion: stick and slip, drift and no drift, rest, and where the energy goes. The reference values are those of
//! integrations of the equations of EQUATIONS.md by LSODA and Radau with two tolerances each.

use crate::support::{TestRecording, run};
use ladder::{Rung, Worst};

const BELT: &str = "belt.toml";
const SLOPE: &str = "block-on-slope.toml";

/// The instants at which v passes a level, upwards or downwards, by the cubic through values and rates at both ends of a row.
fn passes(run: &TestRecording, [v, a]: [&str; 2], level: f64, up: bool) -> Vec<f64> {
    let (t, v, a) = (run.get("t"), run.get(v), run.get(a));
    let side = |v: f64| if up { v - level } else { level - v };
    let rows = (1..t.len()).filter(|&k| side(v[k - 1]) < 0.0 && side(v[k]) >= 0.0);
    let instants = rows.map(|k| {
        let h = t[k] - t[k - 1];
        let [y0, y1] = [k - 1, k].map(|k| v[k] - level);
        let [d0, d1] = [k - 1, k].map(|k| h * a[k]);
        let value = |u: f64| {
            let w = 1.0 - u;
            w * w * ((1.0 + 2.0 * u) * y0 + u * d0) + u * u * ((1.0 + 2.0 * w) * y1 - w * d1)
        };
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            match value(middle) * y0 > 0.0 {
                true => low = middle,
                false => high = middle,
            }
        }
        t[k - 1] + low * h
    });
    instants.collect()
}

/// Stick and slip of the block on the belt: when its slip falls below and rises above half the speed of the belt.
#[test]
fn a_block_on_a_belt_sticks_and_slips_when_it_should() {
    let fine = [
        "integrator.step=5e-5",
        "output.interval=5e-4",
        "output.channels=[\"block.*\"]",
    ];
    let (found, report) = run(BELT, &fine);
    assert_eq!(report.warnings(), Vec::<String>::new());
    let block = ["block.vx", "block.ax"];
    let worst = Worst::new();
    for (up, reference) in [
        // the slip is the speed of the belt less that of the block
        (
            false,
            [
                0.465_240_789_21,
                1.220_150_091_45,
                1.975_321_801_74,
                2.730_460_021_19,
            ],
        ),
        (
            true,
            [
                0.020_087_516_43,
                0.832_024_207_65,
                1.586_806_707_30,
                2.341_994_791_69,
            ],
        ),
    ] {
        let instants = passes(&found, block, 0.05, up);
        assert_eq!(instants.len(), reference.len(), "{instants:?}");
        for (t, expected) in instants.iter().zip(reference) {
            worst.see(t - expected);
        }
    }
    Rung::Routes
        .asks("Block on a belt with LuGre friction: instants of stick and slip against LSODA [s]")
        .within(&worst, 1e-6, "the reference has them to 2e-8 s, the cubic between rows to (5e-4)^4 of a rate of change of 1/s3");
}

/// At a constant slip v from rest: z = g/s0 (1 - exp(-s0 v t/g)), work, stored energy, and what is lost.
#[test]
fn bristles_deflect_in_constant_slip_as_the_closed_form_says() {
    let (s0, s1, normal) = (1e4, 3.0, 10.0);
    let worst = Worst::new();
    for slip in [1e-3, 0.01_f64, 0.2] {
        let belt = format!("bodies.belt.path.x=\"{slip} * t\"");
        let still = [
            &*belt,
            "drives={ hold = { type = \"point\", point = \"block.center\", x = 0.0 } }",
            "simulation.duration=0.1",
            "integrator.step=2e-6",
            "integrator.newton_tolerance=1e-12",
            "output.interval=1e-2",
            "output.channels=[\"*\"]",
        ];
        let (found, _) = run(BELT, &still);
        let g = 0.25 + 0.15 * (-(slip / 0.01).powi(2)).exp();
        let rate = s0 * slip / g;
        for (k, t) in found.get("t").into_iter().enumerate().skip(1) {
            let decay = (-rate * t).exp();
            let z = g / s0 * (1.0 - decay);
            let force = normal * (s0 * z + s1 * slip * decay);
            // the integral of the force times the slip
            let grown = (1.0 - decay) / rate;
            let work = normal * slip * (g * (t - grown) + s1 * slip * grown);
            let stored = 0.5 * normal * s0 * z * z;
            // the pin carries bristles forwards where the belt does: their sign is that of the slip of the pin
            worst.see((found.get("belt-surface.bristle")[k] + z) / (g / s0));
            worst.see((found.get("belt-surface.fx")[k] - force) / force);
            worst.see((found.get("energy.work")[k] - work) / work);
            let lost = found.get("energy.friction_dissipated")[k];
            worst.see((lost - (work - stored)) / work);
        }
    }
    Rung::Routes
        .asks("Bristles of LuGre in constant slip: deflection, force, work and loss against the closed form, relative")
        .within(&worst, 1e-10, "steps of 1/60 of the relaxation at order 5; the work within a step by the quadrature of the stages");
}

/// A load that oscillates below break-away: LuGre drifts, the elasto-plastic law does not after its first cycle.
#[test]
fn lugre_drifts_under_an_oscillating_load_and_elasto_plastic_bristles_do_not() {
    let lugre = [
        3.397_355_744_05e-5,
        4.217_082_950_87e-5,
        5.036_810_194_11e-5,
        5.856_537_437_35e-5,
    ];
    let drift = 8.197_272_433e-6;
    let elasto_plastic = 1.187_908_296_52e-5;
    let cycle = std::f64::consts::TAU / 20.0;
    let ends = |law: &str| {
        let friction = format!(
            "contacts.floor.friction={{ law = \"{law}\", mu_c = 0.3, mu_s = 0.4, v_s = 5e-3, s0 = 1e4, s1 = 10.0{} }}",
            if law == "lugre" {
                ""
            } else {
                ", breakaway = 0.8"
            }
        );
        let interval = format!("output.interval={cycle:?}");
        let duration = format!("simulation.duration={:?}", 20.0 * cycle);
        let step = format!("integrator.step={:?}", cycle / 4000.0);
        let changes = [
            "joints.slope.direction=[1.0, 0.0]",
            "simulation.gravity=[0.0, -10.0]",
            "initial.bodies.block={ x = 0.0, y = -1.01e-4 }",
            "forces={ load = { type = \"force\", point = \"block.center\", x = \"1.2 + 0.6 * sin(20 * t)\", y = 0.0, frame = \"ground\" } }",
            "integrator.method=esdirk5",
            "integrator.newton_tolerance=1e-12",
            &friction,
            &interval,
            &duration,
            &step,
        ];
        run(SLOPE, &changes).0.get("block.x")
    };
    let worst = Worst::new();
    let x = ends("lugre");
    for (k, expected) in lugre.iter().enumerate() {
        worst.see(x[k + 1] - expected);
    }
    worst.see(x[20] - (lugre[3] + 16.0 * drift));
    let x = ends("elasto_plastic");
    for end in &x[1..] {
        worst.see(end - elasto_plastic);
    }
    Rung::Routes
        .asks("Block under an oscillating load, 20 cycles: where each ends, LuGre and elasto-plastic, against Radau [m]")
        .within(&worst, 1e-9, "the reference has 1e-14 m; 4000 steps a cycle of order 5");
    let still = Worst::new();
    x[3..]
        .windows(2)
        .for_each(|ends| still.see(ends[1] - ends[0]));
    Rung::Balance
        .asks("Elasto-plastic bristles under an oscillating load: drift of a cycle from the third on [m]")
        .within(&still, 1e-12, "none: what is left is the tolerance of Newton's method over a cycle");
}

/// For a minute, with a step of a millisecond.
#[test]
fn elasto_plastic_bristles_hold_a_block_on_a_slope() {
    let damped = [
        "contacts.floor.law=hunt_crossley",
        "contacts.floor.restitution=0.2",
        "contacts.floor.impact_velocity_floor=1e-6",
        "integrator.method=bathe",
    ];
    let (run, report) = run(SLOPE, &damped);
    let [x, y] = ["block.x", "block.y"].map(|name| run.get(name));
    let (one, last) = (run.row(1.0), x.len() - 1);
    let moved = (x[last] - x[one]).hypot(y[last] - y[one]);
    Rung::Balance
        .asks("Block held on a slope of 15 degrees: way from 1 s to 60 s [m]")
        .within(moved, 1e-9, "bristles below their elastic limit hold still");
    assert!(report.creep.is_empty());
}

/// The ledger closes with the order of the scheme where the normal force changes from nothing to hundreds of newtons and back: what this
/// does to bristles is an entry of its own. Where the contact is open, the bristles are straight.
#[test]
fn energy_closes_in_impacts_with_bristles() {
    for (law, more) in [("lugre", ""), ("elasto_plastic", ", breakaway = 0.7")] {
        let friction = format!(
            "contacts.pin.friction={{ law = \"{law}\", mu_c = 0.2, mu_s = 0.3, v_s = 1e-2, s0 = 1e5, s1 = 1.0{more} }}"
        );
        let imbalance = |step: &str| {
            let changes = [
                &*friction,
                step,
                "simulation.duration=0.01",
                "output.interval=1e-4",
                "output.channels=[\"*\"]",
            ];
            let (run, report) = run("3rrr/case3.toml", &changes);
            assert!(report.onsets > 10, "{law}: {} onsets", report.onsets);
            let last = |name: &str| run.get(name)[run.len() - 1];
            let lost = last("energy.friction_dissipated");
            // what would be missing without the entry
            assert!(last("energy.normal_variation").abs() > 0.1 * lost, "{law}");
            for joint in ["B1", "B2", "C3"] {
                let [contact, bristle] =
                    ["contact", "bristle"].map(|quantity| run.get(&format!("{joint}.{quantity}")));
                let mut rows = contact.iter().zip(&bristle);
                assert!(
                    rows.all(|(touches, z)| *touches == 1.0 || *z == 0.0),
                    "{law}: {joint}"
                );
                assert!(bristle.iter().any(|z| *z != 0.0), "{law}: {joint}");
            }
            last("energy.numerical").abs() / lost
        };
        let [coarse, fine] =
            ["1.25e-6", "6.25e-7"].map(|h| imbalance(&format!("integrator.step={h}")));
        // order 2 and more; without friction the same steps leave a hundredth of this per cent of what the contacts dissipate
        assert!(
            coarse < 1e-3 && fine < coarse / 3.0,
            "{law}: {coarse:e} {fine:e}"
        );
    }
}

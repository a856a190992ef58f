//! Contacts and friction at their limits.

use super::{Check, apart, column, imbalance, largest, order, run, try_run};

const JOURNAL: &str = "bouncing-journal.toml";
const GRAZING: &str = "hard/grazing.toml";
const SLIDING: &str = "hard/stick-slip.toml";

pub(super) fn restitution() -> Vec<Check> {
    let mut worst = [0.0_f64; 2];
    for restitution in [1e-3, 3e-3, 1e-2, 3e-2, 1e-1, 3e-1, 1.0] {
        let restitution = format!("contacts.aluminium.restitution={restitution}");
        let flores = "contacts.aluminium.law=flores";
        let settings = [
            flores,
            restitution.as_str(),
            "output.interval=2e-4",
            "integrator.step=4e-7",
        ];
        let (_, report) = run(JOURNAL, &settings);
        worst[0] = worst[0].max(imbalance(&report));
    }
    for stiffness in [1e8, 1e10, 1e12, 1e14, 1e16, 1e17] {
        let contact = format!(
            "contacts.aluminium={{ law = \"lankarani_nikravesh\", bearing_radius = 0.010, clearance = 2e-5, stiffness = \
             {stiffness:e}, exponent = 1.5, restitution = 0.9, impact_velocity_floor = 1e-6 }}"
        );
        // a step of 1/60 of the first contact, which lasts as K^-0.4
        let step = 2e-4 / (2e-4 / (8e-7 * (1.1e11_f64 / stiffness).powf(0.4))).ceil();
        let step = format!("integrator.step={step:e}");
        let (_, report) = run(JOURNAL, &[&contact, &step, "output.interval=2e-4"]);
        worst[1] = worst[1].max(imbalance(&report));
    }
    vec![
        Check::below(
            "Restitution 1e-3 to 1, step 0.4 us: energy lost or gained by the integrator, relative",
            worst[0],
            0.02,
        ),
        Check::below(
            "Contact stiffness 1e8 to 1e17 N/m^1.5, step 1/60 of a contact: energy lost or gained, relative",
            worst[1],
            0.02,
        ),
    ]
}

/// Six journals in bearings of their own that hit within one step, each at an instant of its own: the largest error of these
/// instants \[s\], the time from the first to the last over the step, and by how much their ratios of rebound differ.
fn six_at_once() -> [f64; 3] {
    let speeds: [f64; 6] = std::array::from_fn(|k| 0.02 * (1.0 + 1e-4 * k as f64));
    let mut settings = vec![
        "simulation.duration=1.2e-3".to_owned(),
        "output.channels=[\"*.vx\"]".to_owned(),
    ];
    for (k, speed) in speeds.iter().enumerate().skip(1) {
        settings.extend([
            format!(
                "bodies.journal{k}={{ type = \"rigid_body\", mass = 0.05, inertia = 2.49e-6, points.center = [0.0, 0.0] }}"
            ),
            format!(
                "joints.pin{k}={{ type = \"revolute\", bearing = \"ground.bearing\", journal = \"journal{k}.center\", model = \"clearance\", contact = \"aluminium\" }}"
            ),
            format!(
                "initial.bodies.journal{k}={{ x = 0.0, y = 0.0, theta = 0.0, vx = {speed}, vy = 0.0, omega = 0.0 }}"
            ),
        ]);
    }
    let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
    let (recording, _) = run(JOURNAL, &settings);
    let onsets = &recording.onsets;
    assert_eq!(onsets.len(), speeds.len(), "one impact each");
    // the fastest is the last of the scene
    let arrivals = speeds.iter().rev().map(|speed| 2e-5 / speed);
    let errors = onsets.iter().zip(arrivals).map(|(onset, t)| onset.t - t);
    let rebounds = (0..speeds.len()).map(|k| {
        let name = match k {
            0 => "journal.vx".to_owned(),
            k => format!("journal{k}.vx"),
        };
        column(&recording, &name).last().expect("rows") / speeds[k]
    });
    let (least, greatest) = rebounds.fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
    [
        largest(errors),
        (onsets[5].t - onsets[0].t) / 1.6e-6,
        greatest - least,
    ]
}

pub(super) fn onsets() -> Vec<Check> {
    let floor = "contacts.steel.impact_velocity_floor=1e-12";
    let mut deepest = 0.0_f64;
    for velocity in ["1e-12", "1e-9", "1e-6"] {
        let start = format!(
            "initial.bodies.journal={{ x = 0.0, y = -2e-5, theta = 0.0, vx = 0.0, vy = -{velocity}, omega = 0.0 }}"
        );
        let (recording, _) = run(
            GRAZING,
            &[
                floor,
                &start,
                "simulation.duration=0.05",
                "output.interval=1e-3",
            ],
        );
        deepest = deepest.max(largest(column(&recording, "pin.penetration").to_vec()));
    }
    let weight = (0.05_f64 * 9.81 / 1.7e11).powf(2.0 / 3.0);
    let (_, hammering) = run("hard/chatter.toml", &["integrator.step=1e-4"]);
    // all legs alike: the three joints at the cranks close together, and so do those at the platform
    let turning = [
        "drives.input.path={ type = \"coordinates\", x = 0.0, y = 0.0, theta = { type = \"harmonic\", mean = 0.0, amplitude = 0.3, frequency = 1.0, phase = 0.0 } }",
        "initial.sketch={ B1 = [-0.3177, 0.0433], B2 = [0.1213, -0.2968], B3 = [0.1963, 0.2535] }",
        "simulation.duration=0.05",
        "output.interval=1e-3",
    ];
    let (together, report) = run("3rrr/case3.toml", &turning);
    let onsets = &together.onsets;
    let groups = onsets.chunks(3).take(4).map(|group| {
        let times = group.iter().map(|o| o.t);
        let (first, last) = times.fold((f64::MAX, 0.0_f64), |(a, b), t| (a.min(t), b.max(t)));
        last - first
    });
    let spread = largest(groups.collect::<Vec<f64>>());
    let [instants, within, rebounds] = six_at_once();
    let off = ["platform.x", "platform.y"].map(|name| largest(column(&together, name).to_vec()));
    vec![
        Check::new(
            "Impact at 1e-12 to 1e-6 m/s, then rest: largest penetration in 50 ms over the static one under the weight",
            deepest / weight,
            0.5..=1.5,
        ),
        Check::new(
            "Hammering bearing, steps longer than its contacts: phases of chatter reported",
            hammering.chatter.len() as f64,
            1.0..=f64::MAX,
        ),
        Check::below(
            "The same: steps taken over nominal steps",
            hammering.steps as f64 / 500.0,
            4.0,
        ),
        Check::below(
            "3-RRR rotated about its centre, three joints close at once: spread of their first onsets [s]",
            spread,
            1e-9,
        ),
        Check::below(
            "The same: displacement of the platform's centre within 50 ms [m]",
            largest(off),
            1e-9,
        ),
        Check::new(
            "The same: number of onsets",
            report.onsets as f64,
            6.0..=f64::MAX,
        ),
        Check::new(
            "Six journals hit within one step: time from the first to the last over the step",
            within,
            0.1..=1.0,
        ),
        Check::below("The same: error of the six instants [s]", instants, 5e-12),
        Check::below(
            "The same: spread of their coefficients of restitution",
            rebounds,
            1e-4,
        ),
    ]
}

pub(super) fn stick_slip() -> Vec<Check> {
    let law = |v1: &str, coefficient: f64| {
        format!(
            "contacts.dry.friction={{ law = \"ambrosio\", coefficient = {coefficient}, v0 = 0.0, v1 = {v1}, slip = \"material\" }}"
        )
    };
    let channels = "output.channels=[\"arm.*\", \"energy.*\"]";
    let settings = ["simulation.duration=0.2", "output.interval=1e-2", channels];
    let run = |v1: &str| run(SLIDING, &[&settings[..], &[&law(v1, 0.5)]].concat()).0;
    let sharp = run("1e-5");
    let error = |v1: &str| {
        (
            v1.parse().expect("a number"),
            apart(&run(v1), &sharp, "arm.y"),
        )
    };
    let order = order(error("1e-2"), error("1e-3"));
    let mut dissipated = f64::MAX;
    for coefficient in [0.1, 0.5, 1.0, 2.0] {
        let (recording, _) = super::run(
            SLIDING,
            &[&settings[..], &[&law("1e-4", coefficient)]].concat(),
        );
        let losses = column(&recording, "energy.friction_dissipated");
        let least = losses
            .windows(2)
            .map(|w| w[1] - w[0])
            .fold(f64::MAX, f64::min);
        dissipated = dissipated.min(least);
    }
    let sharpest = try_run(SLIDING, &[&settings[..], &[&law("1e-9", 0.5)]].concat());
    let named = match &sharpest {
        Ok((_, report)) => !report.warnings().is_empty(),
        Err(stopped) => stopped.to_string().contains("journal"),
    };
    vec![
        Check::new(
            "Order of the arm's displacement in the width of the friction ramp, 1e-2 to 1e-3 m/s",
            order,
            0.5..=2.0,
        ),
        Check::new(
            "Coefficients 0.1 to 2: least energy dissipated by friction in 10 ms [J]",
            dissipated,
            -1e-12..=f64::MAX,
        ),
        Check::yes(
            "A ramp of 1e-9 m/s: the run ends with a warning, or with an error that names the body of the joint",
            named,
        ),
    ]
}

pub(super) fn speed() -> Vec<Check> {
    let mut worst = [0.0_f64; 2];
    for rpm in [5e3, 1e4, 2e4, 5e4] {
        let speed = rpm * std::f64::consts::PI / 30.0;
        let drive = format!(
            "drives.motor.angle={{ type = \"polynomial\", coefficients = [0.0, {speed}] }}"
        );
        let settings = [
            drive.as_str(),
            "simulation.duration=1.2e-3",
            "output.interval=1e-4",
        ];
        let run = |step: &str| run("slider-crank/both.toml", &[&settings[..], &[step]].concat());
        let (recording, report) = run("integrator.step=2e-7");
        let (fine, _) = run("integrator.step=5e-8");
        worst[0] = worst[0].max(apart(&recording, &fine, "slider.x"));
        worst[1] = worst[1].max(imbalance(&report));
    }
    vec![
        Check::below(
            "5,000 to 50,000 rpm, step 0.2 us: difference within 1.2 ms from a run with a quarter of the step [m]",
            worst[0],
            5e-6, // a hundredth of the clearance
        ),
        Check::below(
            "Energy lost or gained by the integrator, relative",
            worst[1],
            0.01,
        ),
    ]
}

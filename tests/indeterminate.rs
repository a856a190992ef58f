//! Reactions of statically indeterminate mechanisms: those of the least norm, against closed forms.

use crate::support::run_scene;
use looselink::initial::Freedoms;
use looselink::scene::Scene;
use looselink::simulate::Report;

/// The reactions are solutions of well-conditioned equations with a handful of unknowns: some hundred roundings.
const ROUNDING: f64 = 1e-12;

fn scene(mechanism: &str) -> Scene {
    let text = format!(
        "format = 1\n\
         title = \"held more often than needed\"\n\
         simulation = {{ analysis = \"static\", duration = 1.0 }}\n\
         integrator = {{ step = 1.0 }}\n\
         output = {{ interval = 1.0, channels = [\"*\"] }}\n\
         {mechanism}"
    );
    Scene::parse("scene.toml", &text, &[]).unwrap()
}

fn analysed(mechanism: &str) -> (impl Fn(&str) -> f64, Report) {
    let (recording, report) = run_scene(&scene(mechanism));
    let last = move |channel: &str| *recording.get(channel).last().unwrap();
    (last, report)
}

/// A plate on pins under a force: with pins at r from their centroid, a force F and its moment M about it, each pin takes
/// F/n + M k x r / sum r^2, as the bolts of an eccentrically loaded joint do.
#[test]
fn pins_share_a_load_as_bolts_do() {
    let all = [
        [0.3, -0.1],
        [-0.2, 0.4],
        [0.05, 0.02],
        [-0.4, -0.3],
        [0.31, 0.27],
    ];
    let (force, at) = ([120.0, -70.0], [0.6, 0.5]);
    for n in 2..=all.len() {
        let pins = &all[..n];
        let mut text = String::from("bodies.ground.type = \"ground\"\n");
        text += "bodies.plate.type = \"rigid_body\"\nbodies.plate.mass = 2.0\nbodies.plate.inertia = 0.1\n";
        text += "bodies.plate.points.load = [0.6, 0.5]\n";
        for (k, [x, y]) in pins.iter().enumerate() {
            text += &format!(
                "bodies.ground.points.P{k} = [{x:?}, {y:?}]\n\
                 bodies.plate.points.p{k} = [{x:?}, {y:?}]\n\
                 joints.J{k} = {{ type = \"revolute\", model = \"ideal\", bearing = \"ground.P{k}\", journal = \"plate.p{k}\" }}\n"
            );
        }
        text += "forces.load = { type = \"force\", point = \"plate.load\", x = 120.0, y = -70.0, frame = \"ground\" }\n";
        let (last, report) = analysed(&text);
        let mean = |d: usize| pins.iter().map(|p| p[d]).sum::<f64>() / n as f64;
        let centre = [mean(0), mean(1)];
        let arm = |p: &[f64; 2]| [p[0] - centre[0], p[1] - centre[1]];
        let [x, y] = arm(&at);
        let moment = x * force[1] - y * force[0];
        let squares: f64 = pins.iter().flat_map(|p| arm(p).map(|x| x * x)).sum();
        for (k, pin) in pins.iter().enumerate() {
            let [x, y] = arm(pin);
            let expected = [
                -force[0] / n as f64 + moment * y / squares,
                -force[1] / n as f64 - moment * x / squares,
            ];
            for (expected, axis) in expected.into_iter().zip(["fx", "fy"]) {
                let found = last(&format!("J{k}.{axis}"));
                assert!(
                    (found - expected).abs() < ROUNDING * moment.abs(),
                    "{n} J{k}.{axis}: {found} {expected}"
                );
            }
        }
        assert_eq!(report.one_of_many.len(), n);
        assert_eq!(report.redundant.len(), 2 * n - 3);
        assert!(
            report
                .notes()
                .iter()
                .any(|note| note.contains("one of many"))
        );
        assert!(report.warnings().is_empty(), "{:?}", report.warnings());
    }
}

/// A bar of length L under a transverse force P at a L, held at its end and, with a torque, at its start: the least
/// F_1^2 + F_2^2 + (M/L)^2 with F_1 + F_2 = P, M + F_2 L = a P L is that of F_2 = P (1 + a)/3. A weld and a drive hold alike.
#[test]
fn torques_count_with_the_length_of_the_mechanism() {
    let (length, part, load) = (0.4, 0.25, 60.0);
    let weld =
        "joints.W = { type = \"weld\", first = \"ground.A\", second = \"bar.a\", angle = 0.0 }\n";
    let driven = "joints.W = { type = \"revolute\", model = \"ideal\", bearing = \"ground.A\", journal = \"bar.a\" }\n\
                  drives.motor = { type = \"angle\", joint = \"W\", angle = 0.0 }\n";
    for (hold, freedoms) in [
        (weld, "0 degrees of freedom"),
        (
            driven,
            "0 degrees of freedom; 1 prescribed coordinate repeats other constraints",
        ),
    ] {
        let text = format!(
            "bodies.ground = {{ type = \"ground\", points.A = [0.0, 0.0], points.B = [{length:?}, 0.0] }}\n\
             bodies.bar = {{ type = \"rigid_body\", mass = 1.0, inertia = 0.1, points.a = [0.0, 0.0], points.b = [{length:?}, 0.0], \
             points.load = [{:?}, 0.0] }}\n\
             {hold}\
             joints.P = {{ type = \"revolute\", model = \"ideal\", bearing = \"ground.B\", journal = \"bar.b\" }}\n\
             forces.load = {{ type = \"force\", point = \"bar.load\", x = 0.0, y = {:?}, frame = \"ground\" }}\n",
            part * length,
            -load
        );
        let (last, report) = analysed(&text);
        let counted = Freedoms::of(&scene(&text)).unwrap();
        assert_eq!(counted.to_string(), freedoms);
        let second = load * (1.0 + part) / 3.0;
        for (channel, expected) in [
            ("P.fy", second),
            ("W.fy", load - second),
            ("W.torque", (part * load - second) * length),
        ] {
            let found = last(channel);
            assert!(
                (found - expected).abs() < ROUNDING * load,
                "{channel}: {found} {expected}"
            );
        }
        assert_eq!(report.one_of_many, ["W", "P"]);
    }
}

/// What the balance of forces determines stays as it is, and is not marked: the pin of a pendulum on the carriage that two parallel
/// guides hold.
#[test]
fn determined_reactions_are_not_marked() {
    let text = "bodies.ground = { type = \"ground\", points.A = [0.0, 0.0], points.B = [1.0, 0.0] }\n\
        bodies.plate = { type = \"rigid_body\", mass = 2.0, inertia = 0.1, points.a = [0.0, 0.0], points.b = [1.0, 0.0], points.c = [0.5, 0.0] }\n\
        bodies.bob = { type = \"rigid_body\", mass = 3.0, inertia = 0.1, points.top = [0.0, 0.2], points.low = [0.0, 0.0] }\n\
        joints.A = { type = \"revolute\", model = \"ideal\", bearing = \"ground.A\", journal = \"plate.a\" }\n\
        joints.B = { type = \"revolute\", model = \"ideal\", bearing = \"ground.B\", journal = \"plate.b\" }\n\
        joints.C = { type = \"revolute\", model = \"ideal\", bearing = \"plate.c\", journal = \"bob.top\" }\n\
        forces.load = { type = \"force\", point = \"bob.top\", x = 7.0, y = -20.0, frame = \"ground\" }\n\
        forces.spring = { type = \"torsion_spring\", joint = \"C\", stiffness = 5.0, damping = 0.0, rest_angle = 0.0 }\n\
        initial.sketch = { bob = { top = [0.5, 0.0], low = [0.5, -0.2] } }\n";
    let (last, report) = analysed(text);
    assert!((last("C.fx") + 7.0).abs() < ROUNDING * 20.0);
    assert!((last("C.fy") - 20.0).abs() < ROUNDING * 20.0);
    assert!((last("A.fx") + 3.5).abs() < ROUNDING * 20.0);
    assert_eq!(report.one_of_many, ["A", "B"]);
}

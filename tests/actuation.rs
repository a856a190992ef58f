//! What the joints of drives control: too few of them, too many, and poses in which they lose control.

use crate::support::{load, run};
use looselink::compile::drive_limit::{DriveCourse, LossOfControl};
use looselink::initial::Freedoms;
use looselink::scene::Scene;
use looselink::simulate::{Recording, Simulation};

/// A robot of two cranks and two couplers, which meet in a tool.
const ROBOT: &str = r#"
format = 1
title = "a five-bar robot"
simulation = { duration = 0.4 }
integrator = { method = "bathe", step = 1e-3, newton_tolerance = 1e-10 }
output = { interval = 1e-2, channels = ["*"] }
materials.aluminium = { density = 2700.0, youngs_modulus = 70e9, poissons_ratio = 0.33 }
materials.rubber = { density = 1000.0, youngs_modulus = 1e7, poissons_ratio = 0.5 }
sections.bar = { width = 0.02, height = 0.01 }
bodies.ground = { type = "ground", points.A1 = [-0.125, 0.0], points.A2 = [0.125, 0.0] }
bodies.crank1 = { type = "link", model = "rigid", length = 0.25, section = "bar", material = "aluminium" }
bodies.crank2 = { type = "link", model = "rigid", length = 0.25, section = "bar", material = "aluminium" }
bodies.coupler1 = { type = "link", model = "rigid", length = 0.35, section = "bar", material = "aluminium" }
bodies.coupler2 = { type = "link", model = "rigid", length = 0.35, section = "bar", material = "aluminium" }
bodies.tool = { type = "rigid_body", mass = 0.5, inertia = 1e-4, points.center = [0.0, 0.0] }
joints.A1 = { type = "revolute", bearing = "ground.A1", journal = "crank1.start", model = "ideal" }
joints.A2 = { type = "revolute", bearing = "ground.A2", journal = "crank2.start", model = "ideal" }
joints.B1 = { type = "revolute", bearing = "crank1.end", journal = "coupler1.start", model = "ideal" }
joints.B2 = { type = "revolute", bearing = "crank2.end", journal = "coupler2.start", model = "ideal" }
joints.C1 = { type = "revolute", bearing = "coupler1.end", journal = "tool.center", model = "ideal" }
joints.C2 = { type = "revolute", bearing = "coupler2.end", journal = "tool.center", model = "ideal" }
"#;

fn scene(text: &str, changes: &[&str]) -> Scene {
    let changes: Vec<String> = changes.iter().map(ToString::to_string).collect();
    Scene::parse("scene.toml", &format!("{ROBOT}{text}"), &changes).unwrap()
}

/// The robot whose tool goes to a point along a line.
fn along_line(joints: &str, to: [f64; 2], changes: &[&str]) -> Scene {
    let [x, y] = to;
    let text = format!(
        "initial.sketch = {{ B1 = [-0.31, 0.17], B2 = [0.25, 0.22] }}\n[drives.move]\ntype = \"inverse_kinematics\"\n\
         joints = {joints}\nbody = \"tool\"\npath = {{ type = \"line\", from = [-0.05, 0.4, 0.0], to = [{x}, {y}, 0.0], duration = 0.4 }}\n"
    );
    scene(&text, changes)
}

/// Pivots of the cranks, and on which side of the line to the tool their ends are.
const STARTS: [(f64, f64); 2] = [(-0.125, 1.0), (0.125, -1.0)];

/// The angle of a crank with the tool at (-0.05, 0.4) m.
fn angle_at_start((pivot, side): (f64, f64)) -> f64 {
    let (dx, dy) = (-0.05 - pivot, 0.4_f64);
    let far = dy.hypot(dx);
    let cosine = (0.25_f64.powi(2) - 0.35_f64.powi(2) + far * far) / (0.5 * far);
    dy.atan2(dx) + side * cosine.acos()
}

/// The robot whose motors turn by functions of time from there.
fn turned(first: &str, second: &str, changes: &[&str]) -> Scene {
    let [one, two] = STARTS.map(angle_at_start);
    let text = format!(
        "drives.m1 = {{ type = \"angle\", joint = \"A1\", angle = \"{one} {first}\" }}\n\
         drives.m2 = {{ type = \"angle\", joint = \"A2\", angle = \"{two} {second}\" }}\n\
         initial.sketch = {{ B1 = [-0.31, 0.17], B2 = [0.25, 0.22], C1 = [-0.05, 0.4] }}\n\
         initial.bodies.tool = {{ x = -0.05, y = 0.4, theta = 0.0 }}\n"
    );
    scene(&text, changes)
}

fn simulated(scene: &Scene) -> Simulation {
    let mut simulation = Simulation::new(scene).unwrap();
    simulation.run(&mut Recording::new(&simulation)).unwrap();
    simulation
}

fn loss(scene: &Scene) -> LossOfControl {
    match Simulation::new(scene).unwrap().drive_course() {
        DriveCourse::LosesControl(found) => (**found).clone(),
        other => panic!("{other:?}"),
    }
}

/// The tool turns freely, whatever the two motors do.
#[test]
fn joints_of_inverse_kinematics_are_counted_by_what_they_determine() {
    let to = [0.05, 0.4];
    for (joints, counted, left_out) in [
        (
            r#"["A1", "A2"]"#,
            "2 of 3 degrees of freedom are driven",
            None,
        ),
        (
            r#"["A1"]"#,
            "1 of 3 degrees of freedom is driven",
            Some(
                "drive move: its joint A1 does not determine the position of tool, which will not follow its path: 2 of 3 degrees of \
                 freedom are left, with which crank2, coupler1, coupler2 and tool move; name further joints in `joints`",
            ),
        ),
        (
            r#"["A1", "B1"]"#,
            "2 of 3 degrees of freedom are driven",
            None,
        ),
        (
            r#"["A1", "A2", "B1"]"#,
            "2 of 3 degrees of freedom are driven; 1 prescribed coordinate repeats other constraints",
            None,
        ),
    ] {
        let scene = along_line(joints, to, &[]);
        assert_eq!(Freedoms::of(&scene).unwrap().to_string(), counted);
        let simulation = simulated(&scene);
        let inspected = simulation.inspect().freedoms.unwrap();
        assert_eq!(inspected.to_string(), counted);
        let course = simulation.drive_course();
        assert_eq!(course.doubt(0.0).as_deref(), left_out, "{joints}");
        let report = simulation.report();
        assert_eq!(report.warnings().first().map(String::as_str), left_out);
        assert!(report.notes().iter().any(|note| note == counted));
    }
    // as with drives that prescribe the same angles
    let counted = Freedoms::of(&turned("-t", "-t", &[])).unwrap().to_string();
    assert_eq!(counted, "2 of 3 degrees of freedom are driven");
}

/// Without its third motor the platform of a 3-RRR keeps a freedom, in which its position changes.
#[test]
fn a_platform_without_one_of_its_motors_does_not_follow_its_path() {
    let changes = [
        r#"drives.input.joints=["A1", "A2"]"#,
        "simulation.duration=0.01",
        "output.interval=0.01",
    ];
    let (_, report) = run("3rrr/case1.toml", &changes);
    let told = report.warnings();
    assert!(
        told[0].contains("joints A1 and A2 do not determine the position of platform")
            && told[0].contains("1 of 3 degrees of freedom is left, with which crank3, link1, link2, link3 and platform move"),
        "{told:?}"
    );
    let freedoms = Freedoms::of(&load("3rrr/case1.toml", &changes)).unwrap();
    assert_eq!((freedoms.driven, freedoms.left), (2, 1));
}

/// Twice the area of the triangle of B1, B2 and the tool, which goes from (-0.05, 0.4) m to `to`: zero with the couplers in line.
fn triangle(t: f64, to: [f64; 2]) -> f64 {
    let u = t / 0.4;
    let s = u.powi(3) * (10.0 - 15.0 * u + 6.0 * u * u);
    let (x, y) = (-0.05 + s * (to[0] + 0.05), 0.4 + s * (to[1] - 0.4));
    // from the tool, by the intersection of two circles
    let elbow = |pivot: f64, side: f64| {
        let (dx, dy) = (pivot - x, -y);
        let square = dx * dx + dy * dy;
        let along = (square + 0.35_f64.powi(2) - 0.25_f64.powi(2)) / (2.0 * square);
        let across = side * (0.35_f64.powi(2) / square - along * along).sqrt();
        (along * dx - across * dy, along * dy + across * dx)
    };
    let (first, second) = (elbow(-0.125, -1.0), elbow(0.125, 1.0));
    first.0 * second.1 - first.1 * second.0
}

/// The couplers come into line, where the tool can move across them whatever the motors do.
#[test]
fn a_singular_pose_of_the_second_kind_is_told() {
    let to = [0.0, 0.1];
    let scene = along_line(r#"["A1", "A2"]"#, to, &[]);
    let found = loss(&scene);
    assert_eq!(
        found.cause,
        "coupler1 and coupler2 are in line at joints B1, C1 and B2"
    );
    let [t] = found.times[..] else {
        panic!("{:?}", found.times)
    };
    assert!(triangle(0.0, to).abs() > 0.1 && triangle(t, to).abs() < 1e-12);
    assert!((t - 0.337_456_019).abs() < 1e-9, "{t}");
    let told = "drive move loses control of tool at t = 0.33745602 s, in a singular pose: coupler1 and coupler2 are in line at joints \
                B1, C1 and B2; the torques and forces have no bound near it, and the largest recorded ones depend on the step";
    assert_eq!(found.to_string(), told);
    assert!(
        simulated(&scene)
            .report()
            .warnings()
            .contains(&told.to_owned())
    );

    // a run that ends before, and one that comes to rest in the pose with the couplers along y = B1.y = B2.y
    let short = along_line(r#"["A1", "A2"]"#, to, &["simulation.duration=0.3"]);
    assert!(simulated(&short).report().warnings().is_empty());
    let rest = [0.0, (0.25_f64.powi(2) - 0.225_f64.powi(2)).sqrt()];
    let found = loss(&along_line(r#"["A1", "A2"]"#, rest, &[]));
    assert_eq!(found.times, [0.4]);
}

/// A flexible coupler bounds the forces: then nothing depends on the step.
#[test]
fn a_flexible_robot_loses_control_in_the_ideal_mechanism() {
    let flexible = [
        "bodies.coupler1.model=flexible",
        "bodies.coupler1.elements=2",
    ];
    let told = loss(&along_line(r#"["A1", "A2"]"#, [0.0, 0.1], &flexible)).to_string();
    let ends = "of the ideal rigid mechanism: coupler1 and coupler2 are in line at joints B1, C1 and B2; the torques and forces of the ideal \
                mechanism have no bound near it";
    assert!(told.ends_with(ends), "{told}");
}

/// Of scenes/hard/type-2-singularity.toml, which gives the instants with three digits.
#[test]
fn lines_of_three_links_that_meet_are_told() {
    let found = loss(&load("hard/type-2-singularity.toml", &[]));
    assert_eq!(
        found.cause,
        "the lines of link1, link2 and link3 meet in one point"
    );
    let [first, second] = found.times[..] else {
        panic!("{:?}", found.times)
    };
    assert!((first - 0.336).abs() < 5e-4 && (second - 0.485).abs() < 5e-4);
    assert_eq!(found.up_to(0.4).unwrap().times, [first]);
    assert_eq!(found.up_to(0.3), None);
}

/// A flexible link lets the motors turn past the limit of the ideal mechanism: the run says what `check` says.
#[test]
fn a_run_past_the_limit_of_the_ideal_mechanism_says_so() {
    let soft = [
        "bodies.coupler1.model=flexible",
        "bodies.coupler1.elements=2",
        "bodies.coupler1.material=rubber",
    ];
    for (duration, is_told) in [
        ("simulation.duration=0.14", false),
        ("simulation.duration=0.16", true),
    ] {
        let changes = [&soft[..], &[duration]].concat();
        let simulation = simulated(&turned("+3*t", "-3*t", &changes));
        let DriveCourse::Limited(limit) = simulation.drive_course() else {
            assert!(!is_told);
            continue;
        };
        // the couplers are stretched out between the cranks
        let elbow = |pivot: f64, angle: f64| (pivot + 0.25 * angle.cos(), 0.25 * angle.sin());
        let [first, second] = STARTS.map(angle_at_start);
        let first = elbow(-0.125, first + 3.0 * limit.t);
        let second = elbow(0.125, second - 3.0 * limit.t);
        let apart = (second.0 - first.0).hypot(second.1 - first.1);
        assert!((apart - 0.7).abs() < 1e-9, "{limit}");
        assert_eq!(
            limit.cause,
            "coupler1 and coupler2 are in line at joints B1, C1 and B2"
        );
        let warnings = simulation.report().warnings();
        assert_eq!(
            warnings.contains(&limit.to_string()),
            is_told,
            "{warnings:?}"
        );
    }
}

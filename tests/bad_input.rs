//! Every class of fault in a scene: the message names the cause, the underlined text is the culprit.

use looselink::scene::{Scene, SceneError};
use miette::{GraphicalReportHandler, GraphicalTheme};

pub const CASE4: &str = include_str!("../scenes/3rrr/case4-friction.toml");

/// Text in the scene, what it is replaced by, a part of the message, the underlined text.
type BadInput = (&'static str, &'static str, &'static str, &'static str);

fn edited(from: &str, to: &str) -> String {
    assert!(CASE4.contains(from), "`{from}` is not in the scene");
    CASE4.replacen(from, to, 1)
}

pub fn rendered(error: &SceneError) -> String {
    let mut out = String::new();
    let handler = GraphicalReportHandler::new_themed(GraphicalTheme::unicode_nocolor());
    handler
        .with_width(200)
        .render_report(&mut out, error)
        .unwrap();
    out
}

pub fn fault(text: &str, overrides: &[&str]) -> SceneError {
    let overrides: Vec<String> = overrides.iter().map(|o| o.to_string()).collect();
    match Scene::parse("scene.toml", text, &overrides) {
        Ok(_) => panic!("the scene loads: {overrides:?}"),
        Err(error) => error,
    }
}

pub fn check(error: &SceneError, case: &str, message: &str, underlined: &str) {
    assert!(
        error.to_string().contains(message),
        "{case}:\n{error}\n does not contain\n{message}"
    );
    assert_eq!(error.underlined(), underlined, "{case}: {error}");
    // The place shown to the user is where the text stands.
    let (file, line, column) = error.place().expect("every fault of a text has a place");
    let place = format!("{file}:{line}:{column}");
    assert!(
        rendered(error).contains(&place),
        "{case}: no {place} in\n{}",
        rendered(error)
    );
}

pub fn check_all(cases: &[BadInput]) {
    for (from, to, message, underlined) in cases {
        check(
            &fault(&edited(from, to), &[]),
            &format!("`{from}` -> `{to}`"),
            message,
            underlined,
        );
    }
}

#[test]
fn unknown_keys() {
    #[rustfmt::skip]
    check_all(&[
        ("length = 0.245", "lenght = 0.245", "unknown key `lenght` in bodies.crank1; did you mean `length`?", "lenght"),
        ("format = 1", "format = 1\nforce = 2", "unknown key `force` in the scene", "force"),
        ("[simulation]", "[simulation]\ndurations = 1", "unknown key `durations` in simulation; did you mean `duration`?", "durations"),
        ("method =", "metod = 1\nmethod =", "unknown key `metod` in integrator; did you mean `method`?", "metod"),
        ("interval =", "intervall = 1\ninterval =", "did you mean `interval`?", "intervall"),
        ("density =", "densty = 1\ndensity =", "unknown key `densty` in materials.aluminium; did you mean `density`?", "densty"),
        ("width =", "with = 1\nwidth =", "unknown key `with` in sections.driving; did you mean `width`?", "with"),
        ("exponent =", "exponnent = 1\nexponent =", "did you mean `exponent`?", "exponnent"),
        ("v0 = 1e-4 ", "V0 = 1e-4 ", "unknown key `V0` in contacts.pin.friction; did you mean `v0`?", "V0"),
        ("circumradius =", "circumradus = 1, circumradius =", "unknown key `circumradus` in bodies.platform.plate", "circumradus"),
        ("radius = 0.4,", "radius = 0.4, angle = 3,", "unknown key `angle` in bodies.ground.points.A1", "angle"),
        ("bearing = \"ground.A1\"", "baering = \"ground.A1\"", "unknown key `baering` in joints.A1; did you mean `bearing`?", "baering"),
        ("body = \"platform\"", "bodie = \"platform\"", "unknown key `bodie` in drives.input; did you mean `body`?", "bodie"),
        ("frequency =", "frequenzy = 1, frequency =", "did you mean `frequency`?", "frequenzy"),
        ("[initial]", "[initial]\nsketsh.B1 = [0, 0]", "unknown key `sketsh` in initial; did you mean `sketch`?", "sketsh"),
        ("type = \"ground\"", "typ = \"ground\"", "unknown key `typ` in bodies.ground; did you mean `type`?", "typ"),
    ]);
}

#[test]
fn missing_keys_point_at_the_table() {
    #[rustfmt::skip]
    check_all(&[
        ("format = 1\n", "", "missing key `format` in the scene", ""),
        ("title = \"3-RRR, case 4 with friction in B and C\"\n", "", "missing key `title` in the scene", ""),
        ("duration = 3.0", "", "missing key `duration` in simulation", "[simulation]"),
        ("method = \"bathe\"", "", "missing key `method` in integrator", "[integrator]"),
        ("step = 1.25e-6 ", "", "missing key `step` in integrator", "[integrator]"),
        ("interval = 1e-4", "", "missing key `interval` in output", "[output]"),
        ("width = 0.015", "", "missing key `width` in sections.driving", "[sections.driving]"),
        ("clearance = 2e-5", "", "missing key `clearance` in contacts.pin", "[contacts.pin]"),
        ("journal_material = \"aluminium\"", "", "missing key `journal_material`", "[contacts.pin]"),
        ("restitution = 0.9 ", "", "missing key `restitution` in contacts.pin", "[contacts.pin]"),
        ("impact_velocity_floor = 1e-6", "", "missing key `impact_velocity_floor`", "[contacts.pin]"),
        ("coefficient = 0.1 ", "", "missing key `coefficient` in contacts.pin.friction", "[contacts.pin.friction]"),
        ("elements = 1", "", "missing key `elements` in bodies.link1", "[bodies.link1]"),
        ("length = 0.242", "", "missing key `length` in bodies.link1", "[bodies.link1]"),
        ("contact = \"pin\"", "", "missing key `contact` in joints.B1", "[joints.B1]"),
        ("type = \"revolute\"", "", "missing key `type` in joints.A1", "[joints.A1]"),
        ("phase = 0.0, ", "", "missing key `phase` in drives.input.path", "{ type = \"circle\", center = [0.0, 0.0], radius = 0.1, frequency = 1.0, theta = 0.0 }"),
        ("poissons_ratio = 0.33", "", "the material \"aluminium\" has no `poissons_ratio`", "\"aluminium\""),
        ("youngs_modulus = 7e9 ", "", "the material \"passive\" has no `youngs_modulus`", "\"passive\""),
        ("[initial]", "[initial]\nbodies.platform = { x = 0, y = 0 }", "missing key `theta` in initial.bodies.platform", "{ x = 0, y = 0 }"),
        ("[initial]", "[initial]\nbodies.platform = { x = 0, y = 0, theta = 0, vx = 1 }", "missing key `vy`", "{ x = 0, y = 0, theta = 0, vx = 1 }"),
        ("type = \"ground\"", "type = \"rigid_body\"\nmass = 1\ninertia = 1", "no body of type \"ground\"", "bodies"),
    ]);
}

#[test]
fn a_missing_key_is_explained() {
    let shown = rendered(&fault(&edited("duration = 3.0", ""), &[]));
    assert!(
        shown.contains("`duration` is the simulated time from t = 0"),
        "{shown}"
    );
}

#[test]
fn wrong_types() {
    #[rustfmt::skip]
    check_all(&[
        ("duration = 3.0", "duration = \"3\"", "`simulation.duration` must be a number, not a string", "\"3\""),
        ("format = 1", "format = 1.0", "`format` must be an integer, not a number", "1.0"),
        ("title = \"3-RRR, case 4 with friction in B and C\"", "title = 4", "`title` must be a string, not an integer", "4"),
        ("title = \"3-RRR, case 4 with friction in B and C\"", "title = \" \"", "`title` must not be empty", "\" \""),
        ("elements = 1", "elements = 1.5", "`bodies.link1.elements` must be an integer, not a number", "1.5"),
        ("model = \"ideal\"", "model = true", "`joints.A1.model` must be a string, not a boolean", "true"),
        ("length = 0.245", "length = 1979-05-27", "must be a number, not a date", "1979-05-27"),
        ("joints = [\"A1\", \"A2\", \"A3\"]", "joints = \"A1\"", "`drives.input.joints` must be an array, not a string", "\"A1\""),
        ("\"platform.*\",", "7,", "`output.channels.0` must be a string, not an integer", "7"),
        ("center = [0.0, 0.0]", "center = [0.0]", "`drives.input.path.center` must be [x, y], not 1 value", "[0.0]"),
        ("center = [0.0, 0.0]", "center = [0.0, \"a\"]", "`drives.input.path.center.1` must be a number", "\"a\""),
        ("material = \"aluminium\" }", "material = 3 }", "`bodies.platform.plate.material` must be a string", "3"),
        ("duration = 3.0", "duration = 3.0\ngravity = 9.81", "`simulation.gravity` must be [gx, gy], not a number", "9.81"),
        ("\"materials.aluminium.density\" =", "materials.aluminium.density =", "`assumptions.materials` is a table", "materials"),
    ]);
}

#[test]
fn dangling_names() {
    #[rustfmt::skip]
    check_all(&[
        ("material = \"aluminium\"", "material = \"aluminum\"", "there is no material `aluminum`; did you mean `aluminium`?", "\"aluminum\""),
        ("section = \"passive\"", "section = \"pasive\"", "there is no section `pasive`; did you mean `passive`?", "\"pasive\""),
        ("bearing = \"ground.A1\"", "bearing = \"grund.A1\"", "there is no body `grund`; did you mean `ground`?", "\"grund.A1\""),
        ("bearing = \"ground.A1\"", "bearing = \"ground.A\"", "there is no point of `ground` called `A`", "\"ground.A\""),
        ("journal = \"link1.start\"", "journal = \"link1.strat\"", "did you mean `start`?", "\"link1.strat\""),
        ("journal = \"link1.start\"", "journal = \"link1\"", "must be \"body.point\"", "\"link1\""),
        ("contact = \"pin\"", "contact = \"pins\"", "there is no contact `pins`; did you mean `pin`?", "\"pins\""),
        ("model = \"ideal\"", "model = \"ideal\"\ncontact = \"bolt\"", "there is no contact `bolt`", "\"bolt\""),
        ("joints = [\"A1\"", "joints = [\"D1\"", "there is no joint `D1`; did you mean `A1`?", "\"D1\""),
        ("body = \"platform\"", "body = \"plattform\"", "there is no body `plattform`; did you mean `platform`?", "\"plattform\""),
        ("bearing_material = \"aluminium\"", "bearing_material = \"steel\"", "there is no material `steel`", "\"steel\""),
        ("\nsketch.B1", "\nsketch.B4", "there is no joint or body `B4`; did you mean `B1`?", "B4"),
        ("[initial]", "[initial]\nbodies.plat = { x = 0, y = 0, theta = 0 }", "there is no body `plat`", "plat"),
        ("\"materials.aluminium.density\"", "\"materials.aluminium.densty\"", "the scene has no `materials.aluminium.densty`; did you mean `materials.aluminium.density`?", "\"materials.aluminium.densty\""),
        ("law = \"lankarani_nikravesh\"", "law = \"lankarani\"", "`contacts.pin.law` cannot be \"lankarani\"", "\"lankarani\""),
        ("method = \"bathe\"", "method = \"bath\"", "`integrator.method` cannot be \"bath\"; did you mean `bathe`?", "\"bath\""),
    ]);
}

#[test]
fn numbers_that_are_not_physical() {
    #[rustfmt::skip]
    check_all(&[
        ("duration = 3.0", "duration = inf", "`simulation.duration` must be finite, not inf", "inf"),
        ("duration = 3.0", "duration = 1e999", "must be finite, not 1e999", "1e999"),
        ("duration = 3.0", "duration = nan", "must be finite", "nan"),
        ("duration = 3.0", "duration = 0", "must be greater than zero, not 0", "0"),
        ("step = 1.25e-6", "step = -1e-5", "`integrator.step` must be greater than zero", "-1e-5"),
        ("step = 1.25e-6", "step = 1e-12", "`integrator.step` is too small: 3e12 steps", "1e-12"),
        ("step = 1.25e-6", "step = 5.0", "must not be longer than the duration of 3 s", "5.0"),
        ("method =", "gamma = 1.0\nmethod =", "`integrator.gamma` must lie between 0 and 1", "1.0"),
        ("method =", "gamma = 0\nmethod =", "`integrator.gamma` must lie between 0 and 1", "0"),
        ("newton_tolerance = 1e-11", "newton_tolerance = 0.0", "must be greater than zero", "0.0"),
        ("onset_tolerance = 1e-13", "onset_tolerance = 1e-3", "must be less than every clearance", "1e-3"),
        ("interval = 1e-4", "interval = 4.0", "must not be longer than the duration", "4.0"),
        ("density = 2700.0", "density = -2700", "`materials.aluminium.density` must be greater than zero", "-2700"),
        ("youngs_modulus = 70e9", "youngs_modulus = 0", "must be greater than zero", "0"),
        ("poissons_ratio = 0.33", "poissons_ratio = 0.51", "must lie above -1 and not above 0.5", "0.51"),
        ("poissons_ratio = 0.33", "poissons_ratio = -1", "must lie above -1 and not above 0.5", "-1"),
        ("width = 0.015", "width = 0.0", "`sections.driving.width` must be greater than zero", "0.0"),
        ("width = 0.015", "width = 1e-200", "`sections.driving` gives a second moment of 0.0", "driving"),
        ("bearing_radius = 0.010", "bearing_radius = -0.01", "must be greater than zero", "-0.01"),
        ("clearance = 2e-5", "clearance = 0.0", "`contacts.pin.clearance` must be greater than zero", "0.0"),
        ("clearance = 2e-5", "clearance = 0.01", "or no journal is left", "0.01"),
        ("exponent = 1.5", "exponent = 0.5", "must be at least 1", "0.5"),
        ("restitution = 0.9 ", "restitution = 1.1 ", "must lie between 0 and 1, not 1.1", "1.1"),
        ("restitution = 0.9 ", "restitution = -0.1 ", "must lie between 0 and 1", "-0.1"),
        ("impact_velocity_floor = 1e-6", "impact_velocity_floor = 0", "must be greater than zero", "0"),
        ("coefficient = 0.1", "coefficient = -0.1", "must not be negative", "-0.1"),
        ("v1 = 1e-3", "v1 = 1e-4", "`contacts.pin.friction.v1` must be greater than `v0` = 0.0001, not 1e-4", "1e-4"),
        ("law = \"ambrosio\"\ncoefficient = 0.1 # assumed\nv0 = 1e-4         # assumed [m/s]\nv1 = 1e-3         # assumed [m/s]", "law = \"ambrosio\"\ncoefficient = 0.1\nv0 = 2e-3", "`contacts.pin.friction.v0` must be less than `v1` = 0.001, not 2e-3", "2e-3"),
        ("length = 0.245", "length = 0", "`bodies.crank1.length` must be greater than zero", "0"),
        ("elements = 1", "elements = 0", "must lie between 1 and 10000, not 0", "0"),
        ("elements = 1", "elements = 10001", "must lie between 1 and 10000", "10001"),
        ("thickness = 0.01", "thickness = 0.0", "must be greater than zero", "0.0"),
        ("radius = 0.1,", "radius = -0.1,", "`drives.input.path.radius` must be greater than zero", "-0.1"),
        ("elements = 1", "elements = 99999999999999999999", "this integer is too large", "99999999999999999999"),
    ]);
}

#[test]
fn functions_of_time() {
    let circle = "{ type = \"circle\", center = [0.0, 0.0], radius = 0.1, frequency = 1.0, phase = 0.0, theta = 0.0 }";
    let motion = |x: &str, message: &str, underlined: &str| {
        let path = format!("{{ type = \"coordinates\", x = {x}, y = 0.0, theta = 0.0 }}");
        check(&fault(&edited(circle, &path), &[]), x, message, underlined);
    };
    let text = |text: &str, message: &str| {
        let text = format!("\"{text}\"");
        motion(&text, message, &text);
    };
    text(
        "sin(t",
        "the expression of `drives.input.path.x` cannot be read: a `(` is not closed",
    );
    text("sine(t)", "`sine` is not known; did you mean `sin`?");
    text("", "`drives.input.path.x` must not be empty");
    text(
        "0.1 * abs(t - 0.25)",
        "`drives.input.path.x` has a kink where `abs(...)` switches: at t = 0.25 s its velocity jumps by 0.2 m/s",
    );
    text(
        "0.5 * max(0, t - 1)^2",
        "where `max(...)` switches: at t = 1 s its acceleration jumps by 1 m/s2",
    );
    text(
        "0.5 * max(0, t - 1)^1.5",
        "where `max(...)` switches: at t = 1 s its acceleration becomes infinite",
    );
    text(
        "max(0, sin(3 * t))",
        "where `max(...)` switches: at t = 1.0472 s its velocity jumps by 3 m/s",
    );
    text(
        "abs(t - 0.2501) / (t - 0.2501)",
        "where `abs(...)` switches: at t = 0.2501 s its value is not a number",
    );
    text(
        "sqrt(t)",
        "the rate of `drives.input.path.x` is inf at t = 0 s",
    );
    text(
        "t^1.5",
        "the acceleration of `drives.input.path.x` is inf at t = 0 s",
    );
    // 0.9 s of 3 s is one of the times
    text(
        "sqrt((t - 0.9)^2 - 1e-9)",
        "the value of `drives.input.path.x` is NaN at t = 0.9 s",
    );
    text("1 / (3 - t)", "is inf at t = 3 s");
    let ramp = "{ type = \"ramp\", from = 0, to = 1, start = 0, duration = 1 }";
    motion(
        ramp,
        "`drives.input.path.x` cannot follow a ramp: its velocity would jump",
        "\"ramp\"",
    );
    let lines = "{ type = \"piecewise\", rows = [[0, 0], [3, 1]] }";
    motion(
        lines,
        "`drives.input.path.x` cannot follow straight lines",
        "\"piecewise\"",
    );

    // of a load the value alone must be finite
    let load = |x: &str| {
        let force =
            "[forces.push]\ntype = \"force\"\npoint = \"platform.C1\"\nframe = \"ground\"\ny = 0.0";
        edited("[initial]", &format!("{force}\nx = {x}\n[initial]"))
    };
    for x in [
        ramp,
        lines,
        "\"sqrt(t)\"",
        "\"max(0, sin(t))\"",
        "\"sqrt(3 - t)\"",
    ] {
        let scene = Scene::parse("scene.toml", &load(x), &[]);
        assert!(scene.is_ok(), "{x}: {}", scene.unwrap_err());
    }
    let fault = fault(&load("\"log(t)\""), &[]);
    check(
        &fault,
        "log(t)",
        "the value of `forces.push.x` is -inf at t = 0 s",
        "\"log(t)\"",
    );
}

/// Of what is written without quotes.
#[test]
fn advice_says_what_to_type() {
    for (change, advice) in [
        (
            "initial.equilibrium=\"true\"",
            "known: \"nearest\"\nor true or false, without quotes",
        ),
        ("output.motion=\"false\"", "write it without quotes: false"),
        ("integrator.step=\"1e-6\"", "write it without quotes: 1e-6"),
    ] {
        let fault = fault(CASE4, &[change]);
        let said = fault.advice().unwrap_or_default();
        assert!(said.contains(advice), "{change}: {fault}: {said}");
    }
}

#[test]
fn combinations_that_make_no_sense() {
    let circle = "{ type = \"circle\", center = [0.0, 0.0], radius = 0.1, frequency = 1.0, phase = 0.0, theta = 0.0 }";
    let platform = "plate = { shape = \"equilateral_triangle\", circumradius = 0.112, thickness = 0.01, material = \"aluminium\" }";
    #[rustfmt::skip]
    check_all(&[
        (circle, "{ type = \"table\", rows = [[0, 0, 0, 0], [2, 0, 0, 0], [2, 0, 0, 0]] }", "the times of `drives.input.path.rows` must increase", "[2, 0, 0, 0]"),
        (circle, "{ type = \"table\", rows = [[0.5, 0, 0, 0], [4, 0, 0, 0]] }", "must not be later than 0", "[0.5, 0, 0, 0]"),
        (circle, "{ type = \"table\", rows = [[0, 0, 0, 0], [2.5, 0, 0, 0]] }", "must reach the duration of 3 s", "[2.5, 0, 0, 0]"),
        (circle, "{ type = \"table\", rows = [[0, 0, 0, 0]] }", "needs two rows or more", "[[0, 0, 0, 0]]"),
        (circle, "{ type = \"line\", from = [0, 0, 0], to = [0, 0, 0], duration = -1 }", "must be greater than zero", "-1"),
        (platform, "mass = 1.0\ninertia = 0.0", "`bodies.platform.inertia` must be greater than zero", "0.0"),
        ("\ntype = \"rigid_body\"", "\ntype = \"rigid_body\"\ninertia = 1.0", "`bodies.platform.inertia` is already given by the plate", "inertia"),
        ("exponent = 1.5", "exponent = 1.5\nstiffness = 1e11", "cannot be combined with a given `stiffness`", "bearing_material"),
        ("law = \"lankarani_nikravesh\"", "law = \"hertz\"", "law \"hertz\" has no damping", "0.9"),
        ("joints = [\"A1\", \"A2\"", "joints = [\"A1\", \"A1\"", "the joint `A1` is driven twice", "\"A1\""),
        ("joints = [\"A1\", \"A2\", \"A3\"]", "joints = []", "names no joint", "[]"),
        ("body = \"platform\"", "body = \"link1\"", "must be a body of type \"rigid_body\"", "\"link1\""),
        ("journal = \"crank1.start\"", "journal = \"ground.A2\"", "connects a body to itself", "\"ground.A2\""),
        ("[joints.A1]", "[joints.link1]", "`link1` names both a body and a joint", "link1"),
        ("[joints.A1]", "[joints.energy]", "the name `energy` is reserved", "energy"),
        ("[bodies.link1]", "[bodies.error]", "the name `error` is reserved", "error"),
        ("[bodies.link1]", "[bodies.\"a.b\"]", "`a.b` is not a valid name", "\"a.b\""),
        ("[bodies.link1]", "[bodies.\"\"]", "`` is not a valid name", "\"\""),
        ("[bodies.link1]", "[bodies.ground2]\ntype = \"ground\"\n[bodies.link1]", "`ground` and `ground2` are both ground", "[bodies.ground2]"),
        ("[initial]", "[initial]\nbodies.ground = { x = 0, y = 0, theta = 0 }", "`ground` is the ground and has no initial state", "ground"),
        ("format = 1", "format = 2", "this program reads scene format 1, not 2", "2"),
    ]);
}

#[test]
fn the_interval_is_a_whole_number_of_steps() {
    let error = fault(
        &edited("interval = 1e-4", "interval = 1.04e-4"),
        &["integrator.step=1e-5"],
    );
    check(
        &error,
        "10.4 steps",
        "must be a whole multiple of `integrator.step` = 1e-5, not 1.04e-4",
        "1.04e-4",
    );
    assert!(
        rendered(&error).contains("nearest valid: 0.0001 or 0.00011"),
        "{}",
        rendered(&error)
    );
    let error = fault(
        &edited("interval = 1e-4", "interval = 5e-6"),
        &["integrator.step=1e-5"],
    );
    assert!(
        rendered(&error).contains("nearest valid: 1e-5"),
        "{}",
        rendered(&error)
    );
}

/// What a message about an unknown name or a number offers.
#[test]
fn advice_says_what_to_write() {
    for (change, advice) in [
        ("drives.input.body=plat", "nearest of 8: platform, "),
        ("bodies.link1.material=titan", "known: aluminium, passive"),
        (
            "bodies.link1={ type = \"rigid_body\", length = 1 }",
            "`length` is a key of type \"link\"",
        ),
        (
            "simulation.gravity=[0, 9,81]",
            "a number has a decimal point: 9.81",
        ),
        (
            "bodies.link1.length=\"0.25\"",
            "write it without quotes: 0.25",
        ),
        (
            "bodies.link1.length=\"25 cm\"",
            "25 cm is 0.25 m in SI units",
        ),
    ] {
        let error = fault(CASE4, &[change]);
        let given = error.advice().unwrap_or_default();
        assert!(given.contains(advice), "{change}: {error}: {given}");
    }
    let other = CASE4.replace("[contacts.pin", "[contacts.other");
    let error = fault(&other.replace("contacts.pin", "contacts.other"), &[]);
    assert_eq!(error.advice(), Some("known: other"), "{error}");
}

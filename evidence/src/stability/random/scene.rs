//! Scenes that nobody drew, in their pose: bodies go through points, so that every loop is closed, and are joined where they have
//! a point in common.

use super::genes::Tape;
use super::layout::{Layout, OPEN, TOPOLOGIES, layout};
use looselink::contact::normal::LAWS;
use looselink::math::plane::{Vec2, quarter_turn, rotation, unit};
use serde_json::{Value, json};

/// How a body is made.
#[derive(Clone, Copy, PartialEq)]
enum Form {
    Ground,
    Rigid,
    Flexible,
    Body,
    Mass,
}

/// A body in its pose; member 0 is the ground.
struct Member {
    name: String,
    /// Indices of its points; of a link start and end.
    points: Vec<usize>,
    form: Form,
    /// Its centre of mass \[m\].
    centre: Vec2,
    /// Its direction \[rad\].
    theta: f64,
}

/// A point of a member: indices of both.
#[derive(Clone, Copy)]
struct Pin {
    member: usize,
    point: usize,
}

/// Two members joined.
struct Hinge {
    name: String,
    /// Bearing, guide or first side; journal, slider or second side.
    sides: [Pin; 2],
    /// Whether it turns, and whether it has play.
    turns: bool,
    loose: bool,
}

/// A motion at its start.
#[derive(Default)]
struct Drive {
    /// Whether it moves at t = 0.
    moving: bool,
    /// Members that it moves without equations of their own.
    moves: Vec<usize>,
}

/// A scene under way, with the scales by which its numbers are chosen, so that they act on each other.
#[derive(Default)]
struct Drawing {
    scene: Value,
    topology: &'static str,
    points: Vec<Vec2>,
    members: Vec<Member>,
    hinges: Vec<Hinge>,
    /// Length \[m\] and mass \[kg\], at first of a body, at last the mean.
    size: f64,
    mass: f64,
    /// Time within which things move by the length \[s\].
    time: f64,
    /// Step, or what it would be without an accuracy \[s\].
    step: f64,
    duration: f64,
}

/// The text of the scene that genes make.
pub fn draw(genes: &[f64]) -> String {
    let mut tape = Tape(genes);
    let mut d = Drawing {
        topology: tape.pick(&TOPOLOGIES),
        size: tape.decades(-2.0, 1.0),
        mass: tape.decades(-2.0, 2.0),
        time: tape.decades(-3.0, 1.0),
        ..Drawing::default()
    };
    let near_singular = tape.chance(0.1) && !OPEN.contains(&d.topology);
    d.scene = json!({ "format": 1, "title": d.topology });
    let layout = layout(d.topology, &mut tape.part(30), d.size, near_singular);
    d.bodies(&mut tape.part(270), layout);
    d.pace(&mut tape.part(20));
    let (heavy, weight) = (tape.chance(0.5), tape.vector(-1.0, 1.0));
    if heavy {
        let weight = weight * d.size / d.time.powi(2);
        d.scene["simulation"]["gravity"] = json!([weight.x, weight.y]);
    }
    let drive = d.drive(&mut tape.part(40));
    d.forces(&mut tape.part(90));
    let clearance = d.contacts(&mut tape.part(150));
    let part = 0.45 * clearance.min(d.size);
    d.start(&mut tape.part(60), drive.as_ref(), part);
    d.scene["bodies"]["ground"] = json!({ "type": "ground" });
    d.place_points(0);
    toml::to_string(&d.scene).expect("finite numbers")
}

impl Drawing {
    fn speed(&self) -> f64 {
        self.size / self.time
    }

    /// Mass times acceleration \[N\].
    fn force(&self) -> f64 {
        self.mass * self.size / self.time.powi(2)
    }

    fn is_mass(&self, pin: Pin) -> bool {
        self.members[pin.member].form == Form::Mass
    }

    fn point_name(&self, pin: Pin) -> String {
        let member = &self.members[pin.member];
        let point = match member.form {
            Form::Rigid | Form::Flexible if member.points[0] == pin.point => "start".to_owned(),
            Form::Rigid | Form::Flexible => "end".to_owned(),
            Form::Mass => "center".to_owned(),
            Form::Ground | Form::Body => format!("p{}", pin.point),
        };
        format!("{}.{point}", member.name)
    }

    /// Bodies through the points of a layout, and joints where they have one in common.
    fn bodies(&mut self, tape: &mut Tape, layout: Layout) {
        self.points = layout.points;
        let size = self.mass;
        self.mass = 0.0;
        for digits in layout.members.split(' ') {
            let points = digits.chars().filter_map(|c| c.to_digit(10));
            let points = points.map(|digit| digit as usize).collect();
            self.body(&mut tape.part(14), points, size);
        }
        self.mass /= (self.members.len() - 1) as f64;
        for point in 0..self.points.len() {
            let there = self.members.iter().enumerate();
            let there = there.filter(|(_, member)| member.points.contains(&point));
            let pins: Vec<Pin> = there.map(|(member, _)| Pin { member, point }).collect();
            for second in pins.iter().skip(1) {
                self.join(&mut tape.part(8), pins[0], *second);
            }
        }
        if let Some((guide, slider, direction)) = layout.slide {
            let [guide, slider] = [guide, slider].map(|[member, point]| Pin { member, point });
            let locks = self.topology == "slider" && !self.is_mass(slider);
            let locked = locks && !tape.chance(0.2);
            if !self.members[guide.member].points.contains(&guide.point) {
                self.members[guide.member].points.push(guide.point);
            }
            self.slide([guide, slider], direction, locked);
        }
    }

    /// A body through points, of any form that they allow; the first one is the ground.
    fn body(&mut self, tape: &mut Tape, points: Vec<usize>, mass: f64) {
        let index = self.members.len();
        let (body, flexible) = (tape.chance(0.25), tape.chance(0.4));
        let light = tape.chance(0.2) || ["chain", "springs"].contains(&self.topology);
        let theta = tape.between(-3.0, 3.0);
        let mass = mass * tape.decades(-2.0, 2.0);
        let sum: Vec2 = points.iter().map(|p| self.points[*p]).sum();
        let middle = sum / points.len() as f64;
        let off = self.size * tape.between(0.0, 0.3) * unit(theta);
        let inertia = mass * self.size.powi(2) * tape.decades(-3.0, 0.0);
        let (form, theta, centre) = match points[..] {
            _ if index == 0 => (Form::Ground, 0.0, Vec2::zeros()),
            [_] if light => (Form::Mass, 0.0, middle),
            [a, b] if !body => {
                let way = self.points[b] - self.points[a];
                let form = [Form::Rigid, Form::Flexible][usize::from(flexible)];
                (form, way.y.atan2(way.x), middle)
            }
            _ => (Form::Body, theta, middle + off),
        };
        let table = match form {
            Form::Ground => Value::Null,
            Form::Mass => json!({ "type": "point_mass", "mass": mass }),
            Form::Body => json!({ "type": "rigid_body", "mass": mass, "inertia": inertia }),
            Form::Rigid | Form::Flexible => self.link(tape, &points, form, mass),
        };
        let name = match index {
            0 => "ground".to_owned(),
            _ => format!("body{index}"),
        };
        self.mass += f64::from(u8::from(index > 0)) * mass;
        self.scene["bodies"][&name] = table;
        self.members.push(Member {
            name,
            points,
            form,
            centre,
            theta,
        });
        if form == Form::Body {
            self.place_points(index);
        }
    }

    /// Names the points of a member of which they are not known.
    fn place_points(&mut self, index: usize) {
        let member = &self.members[index];
        for point in &member.points {
            let at = rotation(-member.theta) * (self.points[*point] - member.centre);
            self.scene["bodies"][&member.name]["points"][format!("p{point}")] = json!([at.x, at.y]);
        }
    }

    /// A link with its section and material.
    fn link(&mut self, tape: &mut Tape, ends: &[usize], form: Form, mass: f64) -> Value {
        let index = self.members.len();
        let length = (self.points[ends[1]] - self.points[ends[0]]).norm();
        let [width, height] = [0, 1].map(|_| length * tape.decades(-2.0, -1.0));
        let density = mass / (width * height * length);
        let (section, material) = (format!("s{index}"), format!("m{index}"));
        let mut link = json!({
            "type": "link", "model": "rigid", "length": length,
            "section": &section, "material": &material
        });
        self.scene["sections"][section] = json!({ "width": width, "height": height });
        let material = &mut self.scene["materials"][material];
        material["density"] = json!(density);
        // the first bending frequency of a pinned link, in units of 1/time
        let frequency = tape.decades(0.0, 4.0) / self.time;
        let modulus = 12.0 * density * (frequency * length * length / (9.87 * width)).powi(2);
        let (damped, kelvin) = (tape.chance(0.3), tape.chance(0.7));
        let tau = tape.decades(-4.0, 0.0);
        if form == Form::Flexible {
            material["youngs_modulus"] = json!(modulus);
            link["model"] = json!("flexible");
            link["elements"] = json!(tape.whole(1, 3));
            let (mass, stiffness) = (tau / self.time, tau / frequency);
            match (damped, kelvin) {
                (true, true) => link["kelvin_voigt"] = json!(stiffness),
                (true, false) => link["rayleigh"] = json!({ "mass": mass, "stiffness": stiffness }),
                _ => {}
            }
        }
        link
    }

    /// Joins two pins; welds and slides are frequent where the mechanism has freedoms enough for them.
    fn join(&mut self, tape: &mut Tape, first: Pin, second: Pin) {
        let (loose, weld) = (tape.chance(0.3), tape.chance(0.5));
        let other = tape.chance(if self.topology == "chain" { 0.25 } else { 0.03 });
        let (direction, locked) = (tape.angle(), tape.chance(0.5));
        let slope = tape.pick(&["direction", "vector"]);
        let masses = [first, second].map(|pin| self.is_mass(pin));
        let journal = self.topology == "journal";
        match (other && !journal, weld, masses) {
            (true, true, [false, false]) => {
                let [a, b] = [first, second].map(|pin| self.point_name(pin));
                let angle = self.turned([first, second]);
                let table = json!({
                    "type": "weld", "first": a, "second": b, "angle": angle, "slope": slope
                });
                self.hinge(table, [first, second]);
            }
            (true, false, [false, mass]) => self.slide([first, second], direction, locked && !mass),
            _ => {
                let mut sides = [first, second];
                sides.rotate_left(usize::from(tape.chance(0.3)));
                let [a, b] = sides.map(|pin| self.point_name(pin));
                let mut table = json!({ "type": "revolute", "bearing": a, "journal": b });
                table["model"] = json!("ideal");
                if loose || journal {
                    table["model"] = json!("clearance");
                    table["contact"] = json!(format!("joint{}", self.hinges.len() + 1));
                }
                self.hinge(table, sides);
            }
        }
    }

    fn slide(&mut self, sides: [Pin; 2], direction: f64, locked: bool) {
        let [guide, slider] = sides.map(|pin| self.point_name(pin));
        let along = unit(direction - self.members[sides[0].member].theta);
        let mut table = json!({
            "type": "prismatic", "guide": guide, "slider": slider, "direction": [along.x, along.y],
            "rotation": "free"
        });
        if locked {
            table["rotation"] = json!("locked");
            table["angle"] = json!(self.turned(sides));
        }
        self.hinge(table, sides);
    }

    fn hinge(&mut self, table: Value, sides: [Pin; 2]) {
        let name = format!("joint{}", self.hinges.len() + 1);
        self.hinges.push(Hinge {
            name: name.clone(),
            sides,
            turns: table["type"] == "revolute",
            loose: table["model"] == "clearance",
        });
        self.scene["joints"][name] = table;
    }

    /// The angle between the members of two pins \[rad\].
    fn turned(&self, [first, second]: [Pin; 2]) -> f64 {
        self.members[second.member].theta - self.members[first.member].theta
    }

    /// Method, step or accuracy, duration.
    fn pace(&mut self, tape: &mut Tape) {
        // contacts last a small part of the time in which things move
        let loose = self.hinges.iter().any(|hinge| hinge.loose);
        self.step = self.time * tape.decades(-5.5, if loose { -2.5 } else { -0.5 });
        let interval = tape.whole(1, 10) as f64 * self.step;
        self.duration = tape.whole(2, 20) as f64 * interval;
        let methods = "bathe bathe trapezoidal generalized_alpha hht backward_euler dormand_prince dop853 \
                       esdirk3 esdirk5";
        let mut method = tape.pick(&methods.split_whitespace().collect::<Vec<_>>());
        // velocity Verlet keeps no constraints
        let free = ["springs", "journal"].contains(&self.topology);
        if tape.chance(0.3) && free {
            method = "velocity_verlet";
        }
        let mut integrator = json!({ "method": method });
        let (with_gamma, gamma) = (tape.chance(0.2), tape.between(0.2, 0.8));
        let (with_radius, radius) = (tape.chance(0.3), tape.between(0.0, 1.0));
        match method {
            "bathe" if with_gamma => integrator["gamma"] = json!(gamma),
            "bathe" if with_radius => integrator["spectral_radius"] = json!(radius),
            "generalized_alpha" => integrator["spectral_radius"] = json!(radius),
            "hht" => integrator["spectral_radius"] = json!(0.5 + 0.5 * radius),
            _ => {}
        }
        let (follows, digits) = (tape.chance(0.3), tape.decades(-8.0, -3.0));
        let (of_energy, whole) = (tape.chance(0.2), tape.chance(0.5));
        let stepping = "generalized_alpha hht backward_euler velocity_verlet";
        if follows && !stepping.contains(method) {
            let horizon = if whole { 1.0 } else { 0.3 } * self.duration;
            let mut accuracy = json!({ "position": digits * self.size, "horizon": horizon });
            if of_energy {
                let masses = self.mass * (self.members.len() - 1) as f64;
                accuracy["energy"] = json!(digits * masses * self.speed().powi(2));
            }
            integrator["accuracy"] = accuracy;
        } else {
            integrator["step"] = json!(self.step);
        }
        let tolerance = self.speed() * tape.decades(-12.0, -8.0);
        if !["dormand_prince", "dop853", "velocity_verlet"].contains(&method) {
            integrator["newton_tolerance"] = json!(tolerance);
        }
        self.scene["integrator"] = integrator;
        self.scene["simulation"] = json!({ "duration": self.duration });
        self.scene["output"] = json!({ "interval": interval, "channels": ["*"] });
    }

    /// Contacts of the loose joints; the least clearance \[m\].
    fn contacts(&mut self, tape: &mut Tape) -> f64 {
        let mut least = f64::INFINITY;
        let (tolerance, located) = (tape.decades(-6.0, -2.0), !tape.chance(0.1));
        let speed = self.speed();
        for hinge in self.hinges.iter().filter(|hinge| hinge.loose) {
            let mut tape = tape.part(14);
            let clearance = self.size * tape.decades(-4.0, -2.0);
            let radius = clearance * tape.decades(0.5, 2.0);
            let (law, exponent) = (tape.pick(&LAWS), tape.pick(&[1.5, 1.0, 2.0]));
            // the stiffness at which an impact at the speed of the scene lasts from a few tenths of a step to many
            let depth = (speed * self.step * tape.decades(-0.5, 2.0)).min(clearance);
            let energy = 0.5 * self.mass * speed.powi(2);
            let table = &mut self.scene["contacts"][&hinge.name];
            *table = json!({
                "law": law.name, "bearing_radius": radius, "clearance": clearance,
                "stiffness": (exponent + 1.0) * energy / depth.powf(exponent + 1.0),
                "exponent": exponent
            });
            let (restitution, floor) = (tape.between(0.2, 1.0), tape.decades(-8.0, -3.0));
            if law.is_damped {
                table["restitution"] = json!(restitution);
                table["impact_velocity_floor"] = json!(speed * floor);
            }
            let (friction, coefficient) = (tape.chance(0.4), tape.decades(-2.0, 0.0));
            let v0 = speed * tape.decades(-5.0, -2.0);
            let v1 = v0 * tape.decades(0.5, 2.0);
            let slip = tape.pick(&["material", "paper"]);
            if friction {
                table["friction"] = json!({
                    "law": "ambrosio", "coefficient": coefficient, "v0": v0, "v1": v1, "slip": slip
                });
            }
            least = least.min(clearance);
        }
        if least.is_finite() {
            self.scene["integrator"]["onset_tolerance"] = json!(least * tolerance);
            self.scene["integrator"]["locate_onsets"] = json!(located);
        }
        least
    }

    /// A function of time with this value at t = 0 that changes by about `amount` within the time of the scales, smooth where a
    /// motion follows it; and whether its rate at t = 0 is not zero.
    fn function(&self, tape: &mut Tape, start: f64, amount: f64, smooth: bool) -> (Value, bool) {
        let (t, end) = (self.time, self.duration);
        let (kind, a, phase) = (tape.whole(0, 4), tape.between(0.1, 1.0), tape.angle());
        let to = start + amount * (end / t).min(1.0);
        let value = match kind {
            1 => json!({
                "type": "polynomial", "coefficients": [start, amount / t, 0.3 * amount / (t * t)]
            }),
            2 => json!({
                "type": "harmonic", "mean": start - amount * phase.sin(), "amplitude": amount,
                "frequency": a / t, "phase": phase
            }),
            4 if !smooth => json!({
                "type": "ramp", "from": start, "to": to, "start": 0.2 * end, "duration": a * end
            }),
            3 | 4 => json!({
                "type": "smooth_step", "from": start, "to": to, "start": 0.0, "duration": a * end
            }),
            _ => json!(start),
        };
        (value, kind == 1 || kind == 2)
    }

    /// Hinges that turn and whose members have angles.
    fn angles(&self) -> Vec<&Hinge> {
        let fits =
            |hinge: &&Hinge| hinge.turns && !hinge.sides.iter().any(|pin| self.is_mass(*pin));
        self.hinges.iter().filter(fits).collect()
    }

    /// Adds a drive, or none.
    fn drive(&mut self, tape: &mut Tape) -> Option<Drive> {
        if !tape.chance(0.35) {
            return None;
        }
        let choices = self.angles();
        let (inner, other) = (tape.chance(0.3), tape.between(0.0, 1.0));
        let other = (other * choices.len() as f64) as usize;
        let hinge = choices.get(if inner { other } else { 0 })?;
        let amount = tape.signed_decades(-1.0, 0.5);
        let (angle, moving) = self.function(tape, self.turned(hinge.sides), amount, true);
        let members = hinge.sides.map(|pin| pin.member);
        let moves = members.into_iter().filter(|member| {
            let form = self.members[*member].form;
            !hinge.loose && members.contains(&0) && matches!(form, Form::Rigid | Form::Body)
        });
        let moves = moves.collect();
        let table = json!({ "type": "angle", "joint": hinge.name, "angle": angle });
        self.scene["drives"]["drive1"] = table;
        Some(Drive { moving, moves })
    }

    /// A point of a body that moves.
    fn random_pin(&self, tape: &mut Tape) -> Pin {
        let member = tape.whole(1, self.members.len() - 1);
        let points = &self.members[member].points;
        let point = points[tape.whole(0, points.len() - 1)];
        Pin { member, point }
    }

    /// Adds springs and loads; anchors of springs become points of the ground.
    fn forces(&mut self, tape: &mut Tape) {
        let mut made = Vec::new();
        let masses = self.topology == "springs";
        let one = usize::from(tape.chance(0.3));
        for k in 1..=if masses { self.members.len() - 1 } else { one } {
            let mut tape = tape.part(10);
            let (to, off) = (self.random_pin(&mut tape), tape.vector(-0.5, 0.0));
            let [from, to] = if masses {
                [k - 1, k].map(|member| Pin {
                    member,
                    point: member,
                })
            } else {
                self.points.push(self.points[to.point] + self.size * off);
                let point = self.points.len() - 1;
                self.members[0].points.push(point);
                [Pin { member: 0, point }, to]
            };
            let distance = (self.points[to.point] - self.points[from.point]).norm();
            let stiffness = self.mass / self.time.powi(2) * tape.decades(-1.0, 3.0);
            let damping = self.mass / self.time * tape.decades(-2.0, 0.5);
            let rest = distance * tape.between(0.7, 1.3);
            let (damped, linear) = (tape.chance(0.4), tape.chance(0.3));
            made.push(json!({
                "type": "spring_damper", "from": self.point_name(from), "to": self.point_name(to),
                "stiffness": stiffness, "damping": if damped { damping } else { 0.0 },
                "rest_length": if linear { 0.0 } else { rest }
            }));
        }
        let (coil, load, motor) = (tape.chance(0.2), tape.chance(0.25), tape.chance(0.2));
        let couple = self.force() * self.size;
        if let (true, Some(hinge)) = (coil, self.angles().first()) {
            let (stiffness, damping) = (tape.decades(-2.0, 2.0), tape.decades(-3.0, 0.0));
            made.push(json!({
                "type": "torsion_spring", "joint": hinge.name, "stiffness": couple * stiffness,
                "damping": couple * self.time * damping,
                "rest_angle": self.turned(hinge.sides) + tape.between(-1.0, 1.0)
            }));
        }
        let (on, at) = (self.random_pin(tape), self.random_pin(tape));
        let body = tape.chance(0.4) && !self.is_mass(on);
        let [x, y, value] = [self.force(), self.force(), couple].map(|unit| {
            let size = unit * tape.signed_decades(-2.0, 1.0);
            self.function(tape, 0.3 * size, size, false).0
        });
        if load {
            let frame = if body { "body" } else { "ground" };
            let point = self.point_name(on);
            made.push(json!({ "type": "force", "point": point, "x": x, "y": y, "frame": frame }));
        }
        if motor && !self.is_mass(at) {
            let point = self.point_name(at);
            made.push(json!({ "type": "torque", "point": point, "value": value }));
        }
        for (k, table) in made.into_iter().enumerate() {
            self.scene["forces"][format!("force{k}")] = table;
        }
    }

    /// Which members hang together by joints without play, as the lowest index among them.
    fn components(&self) -> Vec<usize> {
        let mut of: Vec<usize> = (0..self.members.len()).collect();
        for _ in 0..self.members.len() {
            for hinge in self.hinges.iter().filter(|hinge| !hinge.loose) {
                let [i, j] = hinge.sides.map(|pin| pin.member);
                let least = of[i].min(of[j]);
                (of[i], of[j]) = (least, least);
            }
        }
        of
    }

    /// `[initial]`: exact poses in which parts that joints with play leave free are moved, by up to `part` \[m\]; poses with a
    /// velocity to be completed; or a sketch.
    fn start(&mut self, tape: &mut Tape, drive: Option<&Drive>, part: f64) {
        let (sketched, completed) = (tape.chance(0.15), tape.chance(0.4));
        let jitter = tape.between(0.0, 0.02) * self.size;
        let moved = |b: &usize| drive.is_some_and(|d| d.moves.contains(b));
        let free = (1..self.members.len()).filter(|b| !moved(b));
        let moving = drive.is_some_and(|d| d.moving);
        let mut initial = json!({});
        let sketched = sketched && !self.hinges.is_empty();
        if sketched || completed || moving {
            let ends = |b: &usize| {
                let own = |h: &&Hinge| h.sides.iter().any(|pin| pin.member == *b);
                self.hinges.iter().filter(own).count() < 2
            };
            for b in free.clone().filter(|b| !sketched || ends(b)) {
                initial["bodies"][&self.members[b].name] = self.pose(b, Vec2::zeros());
            }
        }
        if sketched {
            initial["sketch"] = self.sketch(&self.hinges, jitter);
        } else if completed || moving {
            let chosen = &self.members[tape.whole(1, self.members.len() - 1)];
            let speed = self.speed() * tape.signed_decades(-2.0, 0.5);
            if moving {
                // the poses are held; a joint in the sketch asks for velocities that fit the drive
                let last = self.hinges.len() - 1;
                initial["sketch"] = self.sketch(&self.hinges[last..], 0.0);
            } else if drive.is_none() {
                initial["velocities"][&chosen.name] = match chosen.form {
                    Form::Mass => json!({ "vx": speed }),
                    _ => json!({ "omega": speed / self.size }),
                };
            }
        } else {
            // a driven joint may lead to a part that is free otherwise
            let moves = if drive.is_some() { 0.0 } else { 1.0 };
            let motions = self.members.iter().map(|_| {
                let mut tape = tape.part(6);
                let shift = part * tape.between(0.0, 1.0) * unit(tape.angle());
                let drift = moves * self.speed() * tape.signed_decades(-2.0, 0.0);
                let turn = moves / self.time * tape.signed_decades(-2.0, 0.5);
                (shift, drift * Vec2::new(1.0, 0.5), turn)
            });
            let motions: Vec<(Vec2, Vec2, f64)> = motions.collect();
            let of = self.components();
            for b in free {
                let (member, (shift, drift, turn)) = (&self.members[b], motions[of[b]]);
                let pose = &mut initial["bodies"][&member.name];
                if of[b] == 0 {
                    *pose = self.pose(b, Vec2::zeros());
                    continue;
                }
                // the part turns about the first point of its first member, and drifts
                let pivot = self.points[self.members[of[b]].points[0]];
                let velocity = drift + turn * quarter_turn(member.centre - pivot);
                *pose = self.pose(b, shift);
                (pose["vx"], pose["vy"]) = (json!(velocity.x), json!(velocity.y));
                if member.form != Form::Mass {
                    pose["omega"] = json!(turn);
                }
            }
        }
        self.scene["initial"] = initial;
    }

    /// An entry of `initial.bodies`.
    fn pose(&self, b: usize, shift: Vec2) -> Value {
        let member = &self.members[b];
        let at = member.centre + shift;
        match member.form {
            Form::Mass => json!({ "x": at.x, "y": at.y }),
            _ => json!({ "x": at.x, "y": at.y, "theta": member.theta }),
        }
    }

    /// Where joints are, a little off.
    fn sketch(&self, hinges: &[Hinge], jitter: f64) -> Value {
        let entry = |(j, hinge): (usize, &Hinge)| {
            let at = self.points[hinge.sides[1].point] + jitter * unit(2.4 * j as f64);
            (hinge.name.clone(), json!([at.x, at.y]))
        };
        Value::Object(hinges.iter().enumerate().map(entry).collect())
    }
}

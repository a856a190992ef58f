//! Mechanisms in a pose: pins are placed first, bodies are drawn through them, so that every loop is closed.

use super::genes::Tape;

/// A point of the plane \[m\].
pub type PlanePoint = [f64; 2];

pub(super) fn add(a: PlanePoint, b: PlanePoint) -> PlanePoint {
    [a[0] + b[0], a[1] + b[1]]
}

pub(super) fn sub(a: PlanePoint, b: PlanePoint) -> PlanePoint {
    [a[0] - b[0], a[1] - b[1]]
}

pub(super) fn scale(s: f64, a: PlanePoint) -> PlanePoint {
    [s * a[0], s * a[1]]
}

pub(super) fn norm(a: PlanePoint) -> f64 {
    a[0].hypot(a[1])
}

/// a turned by `angle` \[rad\].
pub(super) fn rotate(angle: f64, a: PlanePoint) -> PlanePoint {
    let (s, c) = angle.sin_cos();
    [c * a[0] - s * a[1], s * a[0] + c * a[1]]
}

/// How a body is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Form {
    /// The ground.
    Ground,
    /// A rigid link between two pins.
    Rigid,
    /// A flexible link between two pins.
    Flexible {
        /// Elements.
        elements: usize,
    },
    /// A rigid body; its centre of mass in the plane \[m\].
    Body {
        /// Centre of mass.
        centre: PlanePoint,
    },
    /// A point mass.
    Mass,
}

/// A body in its pose.
#[derive(Debug, Clone)]
pub struct Member {
    /// Its pins in the plane \[m\]; of a link start and end.
    pub pins: Vec<PlanePoint>,
    /// How it is made.
    pub form: Form,
    /// Its direction \[rad\].
    pub theta: f64,
    /// Its mass \[kg\].
    pub mass: f64,
}

/// A pin of a member.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PinRef {
    /// Index of the member.
    pub member: usize,
    /// Index of the pin among its pins.
    pub pin: usize,
}

/// What a hinge allows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HingeKind {
    /// Turning.
    Ideal,
    /// Turning, with play.
    Loose,
    /// Nothing.
    Weld {
        /// Whether the slope of a flexible end is held as a vector.
        vector: bool,
    },
    /// Sliding along a direction of the plane \[rad\], and turning or not.
    Slide {
        /// Direction.
        direction: f64,
        /// Whether the relative angle is held.
        locked: bool,
    },
}

/// Two members joined.
#[derive(Debug, Clone, Copy)]
pub struct Hinge {
    /// Bearing, guide or first side.
    pub first: PinRef,
    /// Journal, slider or second side.
    pub second: PinRef,
    /// What it allows.
    pub kind: HingeKind,
}

/// Kinds of mechanism.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Topology {
    Chain,
    FourBar,
    FiveBar,
    SliderCrank,
    Slot,
    TwoLoops,
    Parallelogram,
    Parallel,
    Masses,
    Journal,
}

impl Topology {
    /// All of them, the plainest first; what there is most to vary of stands more than once.
    const ALL: [Topology; 15] = [
        Topology::Chain,
        Topology::Chain,
        Topology::Chain,
        Topology::FourBar,
        Topology::FourBar,
        Topology::SliderCrank,
        Topology::SliderCrank,
        Topology::FiveBar,
        Topology::Slot,
        Topology::TwoLoops,
        Topology::Parallelogram,
        Topology::Parallel,
        Topology::Parallel,
        Topology::Masses,
        Topology::Journal,
    ];

    /// Its name in tallies.
    pub fn name(self) -> &'static str {
        match self {
            Topology::Chain => "chain",
            Topology::FourBar => "four-bar",
            Topology::FiveBar => "five-bar",
            Topology::SliderCrank => "slider-crank",
            Topology::Slot => "slotted lever",
            Topology::TwoLoops => "two loops",
            Topology::Parallelogram => "parallelogram",
            Topology::Parallel => "parallel mechanism",
            Topology::Masses => "masses on springs",
            Topology::Journal => "journal in a bearing",
        }
    }
}

/// Bodies and what joins them; the ground is member 0.
#[derive(Debug, Clone)]
pub struct RandomMechanism {
    /// What kind of mechanism it is.
    pub topology: Topology,
    /// Its size \[m\].
    pub size: f64,
    /// Bodies.
    pub members: Vec<Member>,
    /// Joints.
    pub hinges: Vec<Hinge>,
    /// Whether it starts near a singular pose.
    pub near_singular: bool,
}

/// Draws members while the pins are placed.
struct Drawing<'a, 'b> {
    tape: &'b mut Tape<'a>,
    size: f64,
    mass: f64,
    members: Vec<Member>,
    hinges: Vec<Hinge>,
    near_singular: bool,
}

/// A mechanism.
pub fn mechanism(tape: &mut Tape) -> RandomMechanism {
    let topology = tape.pick(&Topology::ALL);
    let mut drawing = Drawing {
        size: tape.decades(-2.0, 1.0),
        mass: tape.decades(-2.0, 2.0),
        near_singular: tape.chance(0.1),
        tape,
        members: vec![Member {
            pins: Vec::new(),
            form: Form::Ground,
            theta: 0.0,
            mass: 0.0,
        }],
        hinges: Vec::new(),
    };
    match topology {
        Topology::Chain => drawing.chain(),
        Topology::FourBar => drawing.four_bar(),
        Topology::FiveBar => drawing.five_bar(),
        Topology::SliderCrank => drawing.slider_crank(),
        Topology::Slot => drawing.slot(),
        Topology::TwoLoops => drawing.two_loops(),
        Topology::Parallelogram => drawing.parallelogram(),
        Topology::Parallel => drawing.parallel(),
        Topology::Masses => drawing.masses(),
        Topology::Journal => drawing.journal(),
    }
    let has_arch = !matches!(
        topology,
        Topology::Chain | Topology::Slot | Topology::Masses | Topology::Journal
    );
    RandomMechanism {
        topology,
        size: drawing.size,
        members: drawing.members,
        hinges: drawing.hinges,
        near_singular: drawing.near_singular && has_arch,
    }
}

impl Drawing<'_, '_> {
    /// A pin of the ground.
    fn ground(&mut self, at: PlanePoint) -> PinRef {
        self.members[0].pins.push(at);
        PinRef {
            member: 0,
            pin: self.members[0].pins.len() - 1,
        }
    }

    /// A body through pins, of any form that such pins allow; returns its index.
    fn member(&mut self, pins: &[PlanePoint]) -> usize {
        let mut tape = self.tape.part(8);
        let body = tape.chance(if pins.len() == 2 { 0.25 } else { 1.0 });
        let flexible = tape.chance(0.4);
        let (elements, theta) = (tape.whole(1, 3), tape.between(-3.0, 3.0));
        let mass = self.mass * tape.signed_decades(-2.0, 2.0).abs();
        let off = tape.between(0.0, 0.3);
        let (form, theta) = if body {
            let sum = pins.iter().fold([0.0; 2], |sum, p| add(sum, *p));
            let middle = scale(1.0 / pins.len() as f64, sum);
            let off = rotate(theta, [off * self.size, 0.0]);
            (
                Form::Body {
                    centre: add(middle, off),
                },
                theta,
            )
        } else {
            let way = sub(pins[1], pins[0]);
            let form = match flexible {
                true => Form::Flexible { elements },
                false => Form::Rigid,
            };
            (form, way[1].atan2(way[0]))
        };
        self.members.push(Member {
            pins: pins.to_vec(),
            form,
            theta,
            mass,
        });
        self.members.len() - 1
    }

    /// A point mass; returns its index.
    fn point_mass(&mut self, at: PlanePoint) -> usize {
        let mass = self.mass * self.tape.decades(-2.0, 2.0);
        self.members.push(Member {
            pins: vec![at],
            form: Form::Mass,
            theta: 0.0,
            mass,
        });
        self.members.len() - 1
    }

    /// Joins two pins; `free` where the mechanism has freedoms enough for welds and slides.
    fn join(&mut self, first: PinRef, second: PinRef, free: bool) {
        let mut tape = self.tape.part(8);
        let loose = tape.chance(0.3);
        let other = tape.chance(if free { 0.25 } else { 0.03 });
        let weld = tape.chance(0.5);
        let (vector, direction, locked) = (tape.chance(0.5), tape.angle(), tape.chance(0.5));
        let point = |pin: PinRef| self.members[pin.member].form == Form::Mass;
        let kind = match (other, weld) {
            (true, true) if !point(first) && !point(second) => HingeKind::Weld { vector },
            (true, false) if !point(first) => HingeKind::Slide {
                direction,
                locked: locked && !point(second),
            },
            _ if loose => HingeKind::Loose,
            _ => HingeKind::Ideal,
        };
        let swapped = tape.chance(0.3) && matches!(kind, HingeKind::Ideal | HingeKind::Loose);
        let (first, second) = if swapped {
            (second, first)
        } else {
            (first, second)
        };
        self.hinges.push(Hinge {
            first,
            second,
            kind,
        });
    }

    /// A point beside the middle of two others, out of their line: the third corner of a triangle.
    fn apex(&mut self, a: PlanePoint, b: PlanePoint) -> PlanePoint {
        let mut tape = self.tape.part(3);
        let near = tape.decades(-4.0, -2.0);
        let height = match self.near_singular {
            true => near,
            false => tape.between(0.3, 1.0),
        };
        let along = tape.between(0.35, 0.65);
        let way = sub(b, a);
        add(a, add(scale(along, way), scale(height, [-way[1], way[0]])))
    }

    fn chain(&mut self) {
        let links = self.tape.whole(1, 4);
        let grounded = !self.tape.chance(0.3);
        let hung = self.tape.chance(0.4);
        let mut at = [0.0; 2];
        let mut last = grounded.then(|| self.ground(at));
        for _ in 0..links {
            let (direction, length) = (self.tape.angle(), self.size * self.tape.between(0.5, 1.5));
            let next = add(at, rotate(direction, [length, 0.0]));
            let member = self.member(&[at, next]);
            if let Some(last) = last {
                self.join(last, PinRef { member, pin: 0 }, true);
            }
            last = Some(PinRef { member, pin: 1 });
            at = next;
        }
        if let (true, Some(last)) = (hung, last) {
            let member = self.point_mass(at);
            self.join(last, PinRef { member, pin: 0 }, true);
        }
    }

    /// A crank of the ground; returns its pin at the far end and where that is.
    fn crank(&mut self, axis: PlanePoint) -> (PinRef, PlanePoint) {
        let (direction, length) = (self.tape.angle(), self.size * self.tape.between(0.2, 0.5));
        let end = add(axis, rotate(direction, [length, 0.0]));
        let ground = self.ground(axis);
        let member = self.member(&[axis, end]);
        self.join(ground, PinRef { member, pin: 0 }, false);
        (PinRef { member, pin: 1 }, end)
    }

    /// Two bodies that meet in an apex between two pins.
    fn dyad(&mut self, from: PinRef, a: PlanePoint, to: PinRef, b: PlanePoint) -> [usize; 2] {
        let apex = self.apex(a, b);
        let (left, right) = (self.member(&[a, apex]), self.member(&[apex, b]));
        self.join(
            from,
            PinRef {
                member: left,
                pin: 0,
            },
            false,
        );
        let (first, second) = (
            PinRef {
                member: left,
                pin: 1,
            },
            PinRef {
                member: right,
                pin: 0,
            },
        );
        self.join(first, second, false);
        self.join(
            PinRef {
                member: right,
                pin: 1,
            },
            to,
            false,
        );
        [left, right]
    }

    fn four_bar(&mut self) {
        let (crank, b) = self.crank([0.0, 0.0]);
        let foot = [self.size * self.tape.between(0.8, 1.5), 0.0];
        let ground = self.ground(foot);
        self.dyad(crank, b, ground, foot);
    }

    fn five_bar(&mut self) {
        let (left, b) = self.crank([0.0, 0.0]);
        let (right, d) = self.crank([self.size * 1.5, 0.0]);
        self.dyad(left, b, right, d);
    }

    fn slider_crank(&mut self) {
        let (crank, b) = self.crank([0.0, 0.0]);
        let mut tape = self.tape.part(5);
        let reach = if self.near_singular {
            tape.decades(-4.0, -2.0)
        } else {
            tape.between(0.6, 1.2)
        };
        let pin = [b[0] + self.size * reach, self.size * tape.between(0.0, 0.1)];
        let (light, locked) = (tape.chance(0.2), !tape.chance(0.2));
        let rod = self.member(&[b, pin]);
        self.join(
            crank,
            PinRef {
                member: rod,
                pin: 0,
            },
            false,
        );
        let block = match light {
            true => self.point_mass(pin),
            false => self.member(&[pin]),
        };
        self.join(
            PinRef {
                member: rod,
                pin: 1,
            },
            PinRef {
                member: block,
                pin: 0,
            },
            false,
        );
        let guide = self.ground(pin);
        self.hinges.push(Hinge {
            first: guide,
            second: PinRef {
                member: block,
                pin: 0,
            },
            kind: HingeKind::Slide {
                direction: 0.0,
                locked: locked && !light,
            },
        });
    }

    fn slot(&mut self) {
        let (crank, b) = self.crank([0.0, 0.0]);
        let foot = [0.0, -self.size];
        let ground = self.ground(foot);
        let way = sub(b, foot);
        let lever = self.member(&[foot, add(foot, scale(1.5, way))]);
        let pivot = PinRef {
            member: lever,
            pin: 0,
        };
        self.join(ground, pivot, false);
        self.hinges.push(Hinge {
            first: pivot,
            second: crank,
            kind: HingeKind::Slide {
                direction: way[1].atan2(way[0]),
                locked: false,
            },
        });
    }

    fn two_loops(&mut self) {
        let (crank, b) = self.crank([0.0, 0.0]);
        let foot = [self.size * 1.2, 0.0];
        let ground = self.ground(foot);
        let c = self.apex(b, foot);
        let p = add(b, rotate(1.0, scale(0.7, sub(c, b))));
        let (coupler, rocker) = (self.member(&[b, c, p]), self.member(&[c, foot]));
        let of = |member, pin| PinRef { member, pin };
        self.join(crank, of(coupler, 0), false);
        self.join(of(coupler, 1), of(rocker, 0), false);
        self.join(of(rocker, 1), ground, false);
        let far = [-0.3 * self.size, 1.3 * self.size];
        let ground = self.ground(far);
        self.dyad(of(coupler, 2), p, ground, far);
    }

    /// Three equal bars between the ground and one body: the third repeats the constraints of the others.
    fn parallelogram(&mut self) {
        let bar = rotate(
            if self.near_singular {
                self.tape.decades(-4.0, -2.0)
            } else {
                self.tape.between(0.4, 2.7)
            },
            [0.6 * self.size, 0.0],
        );
        let feet = [0.0, 0.5, 1.0].map(|x| [x * self.size, 0.0]);
        let tops = feet.map(|foot| add(foot, bar));
        let coupler = self.member(&tops);
        for (k, (foot, top)) in feet.into_iter().zip(tops).enumerate() {
            let ground = self.ground(foot);
            let member = self.member(&[foot, top]);
            self.join(ground, PinRef { member, pin: 0 }, false);
            self.join(
                PinRef { member, pin: 1 },
                PinRef {
                    member: coupler,
                    pin: k,
                },
                false,
            );
        }
    }

    /// A platform on three legs, each a crank and a rod.
    fn parallel(&mut self) {
        let turn = self.tape.between(-0.3, 0.3);
        let angles = [0.5, 2.6, 4.7];
        let feet = angles.map(|a: f64| rotate(a, [self.size, 0.0]));
        let corners = angles.map(|a: f64| rotate(a + turn, [0.3 * self.size, 0.0]));
        let elbows = [0, 1, 2].map(|k| self.apex(feet[k], corners[k]));
        let mut ends = Vec::new();
        for k in 0..3 {
            let ground = self.ground(feet[k]);
            let member = self.member(&[feet[k], elbows[k]]);
            self.join(ground, PinRef { member, pin: 0 }, false);
            ends.push(PinRef { member, pin: 1 });
        }
        let platform = self.member(&corners);
        for k in 0..3 {
            let member = self.member(&[elbows[k], corners[k]]);
            self.join(ends[k], PinRef { member, pin: 0 }, false);
            self.join(
                PinRef { member, pin: 1 },
                PinRef {
                    member: platform,
                    pin: k,
                },
                false,
            );
        }
    }

    fn masses(&mut self) {
        self.ground([0.0, 0.0]);
        let count = self.tape.whole(1, 4);
        for k in 0..count {
            let at = [
                self.size * (1.0 + k as f64),
                self.size * self.tape.between(0.0, 0.3),
            ];
            self.point_mass(at);
        }
    }

    /// A journal in a bearing of the ground or of a body that flies.
    fn journal(&mut self) {
        let flies = self.tape.chance(0.5);
        let at = [0.0, 0.0];
        let bearing = match flies {
            true => PinRef {
                member: self.member(&[at]),
                pin: 0,
            },
            false => self.ground(at),
        };
        let light = self.tape.chance(0.2);
        let member = match light {
            true => self.point_mass(at),
            false => self.member(&[at]),
        };
        self.hinges.push(Hinge {
            first: bearing,
            second: PinRef { member, pin: 0 },
            kind: HingeKind::Loose,
        });
    }
}

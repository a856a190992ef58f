//! A flexible link: planar cubic ANCF elements (eqs. 6-15) between nodes with positions and slopes.

use super::{
    Body, Content, Deformation, Frame, Levels, Link, Point, Pose, RigidLink, Slot, Strain, carried,
    rigid_link,
};
use crate::force::{ElementDamping, MassDamping};
use crate::link::{AncfCable, ElasticRoute};
use crate::marker::{Marker, Spin};
use crate::math::plane::{Vec2, pair, quarter_turn, unit};
use crate::terms::{Inertia, Owner, Terms};
use std::sync::Arc;

/// A unit of slope of a cubic beam moves points by this part of its length at most, x (1 - x)^2 at x = 1/3.
const SLOPE_WAY: f64 = 4.0 / 27.0;

/// A link of equal elements. Its slots are position and slope of every node, from `start` to `end`.
#[derive(Debug, Clone)]
pub struct FlexibleLink {
    /// Dimensions and points.
    pub link: Link,
    /// Number of elements.
    pub elements: usize,
    /// Young's modulus \[Pa\].
    pub youngs_modulus: f64,
    /// The node of each point.
    pub nodes: Vec<usize>,
    /// Structural damping, absent when the scene names none.
    pub damping: Option<Damping>,
}

/// Structural damping.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Damping {
    /// Retardation time of the strain rates \[s\]: Kelvin-Voigt, or the second half of Rayleigh's.
    pub strain: f64,
    /// Damping proportional to mass \[1/s\], the first half of Rayleigh's.
    pub mass: f64,
}

impl FlexibleLink {
    /// Length of an element \[m\].
    pub fn element_length(&self) -> f64 {
        self.link.length / self.elements as f64
    }

    /// The same link if it were rigid.
    pub fn rigid_link(&self) -> RigidLink {
        RigidLink {
            link: self.link.clone(),
            coordinates: None,
        }
    }

    /// The same link without its points between the ends.
    #[must_use]
    pub fn without_inner_points(&self) -> FlexibleLink {
        let mut link = self.clone();
        link.nodes.truncate(2);
        link.link.points.truncate(2);
        link.link.shares.truncate(2);
        link
    }

    fn kernel(&self) -> AncfCable {
        let (e, link) = (self.youngs_modulus, &self.link);
        AncfCable::new(self.element_length(), e * link.area, e * link.second_moment)
    }

    fn damping_terms(&self, firsts: [usize; 4], body: usize, terms: &mut Terms) {
        let (Some(damping), l) = (self.damping, self.element_length()) else {
            return;
        };
        let link = &self.link;
        if damping.strain > 0.0 {
            let viscosity = self.youngs_modulus * damping.strain;
            let term = ElementDamping::new(
                firsts.iter().flat_map(|&x| [x, x + 1]).collect(),
                l,
                viscosity * link.area,
                viscosity * link.second_moment,
            );
            terms.damping.push((Box::new(term), body));
        }
        if damping.mass > 0.0 {
            let m = AncfCable::mass(l, link.density * link.area);
            let part = Inertia::planar(m, firsts, POSITIONS, [0.0; 2]);
            let term = MassDamping {
                coordinates: part.coordinates,
                values: part.values.iter().map(|m| damping.mass * m).collect(),
            };
            terms.damping.push((Box::new(term), body));
        }
    }
}

/// Which of r_i, r_i', r_j, r_j' are positions.
const POSITIONS: [bool; 4] = [true, false, true, false];

impl Body for FlexibleLink {
    fn points(&self) -> &[Point] {
        &self.link.points
    }

    fn slots(&self) -> Vec<Slot> {
        let position = |k: usize| match k {
            0 => Slot::node("start", 0),
            k if k == self.elements => Slot::node("end", 1),
            k => Slot::own(format!(".node{k}"), Content::Position),
        };
        let slope = |k: usize| Slot::own(format!(".node{k}.slope"), Content::Slope);
        let nodes = 0..=self.elements;
        nodes.flat_map(|k| [position(k), slope(k)]).collect()
    }

    fn mass(&self) -> Option<f64> {
        Some(self.link.mass())
    }

    fn link(&self) -> Option<&Link> {
        Some(&self.link)
    }

    fn is_rigid(&self) -> bool {
        false
    }

    fn size(&self) -> f64 {
        self.link.length
    }

    fn marker(&self, point: usize, x: &[usize]) -> Marker {
        Marker::Node {
            x: x[2 * self.nodes[point]],
        }
    }

    fn spin(&self, point: usize, x: &[usize]) -> Spin {
        Spin::Slope {
            x: x[2 * self.nodes[point] + 1],
        }
    }

    fn carrier(&self, point: usize) -> usize {
        point
    }

    fn lever(&self, slot: usize) -> f64 {
        match slot % 2 {
            1 => SLOPE_WAY * self.element_length(),
            _ => 1.0,
        }
    }

    fn terms(&self, x: &[usize], owner: Owner, terms: &mut Terms) {
        for k in 0..self.elements {
            let firsts = std::array::from_fn(|i| x[2 * k + i]);
            let m = AncfCable::mass(self.element_length(), self.link.density * self.link.area);
            let inertia = Inertia::planar(m, firsts, POSITIONS, terms.gravity);
            terms.inertia.push(inertia);
            let coordinates = firsts.iter().flat_map(|&x| [x, x + 1]).collect();
            terms.elements.push((self.kernel(), coordinates));
            self.damping_terms(firsts, owner.sides[0], terms);
        }
    }

    fn pose(&self, x: &[usize], levels: Levels) -> Pose {
        let last = x[x.len() - 2];
        rigid_link::pose(
            levels.map(|l| mean(l, x, self.element_length())),
            levels.map(|l| pair(l, last) - pair(l, x[0])),
        )
    }

    fn frame(&self, position: [f64; 3], velocity: [f64; 3]) -> Frame {
        rigid_link::frame(self.link.length, position, velocity)
    }

    fn frame_at(&self, _: &[usize], _: &[f64], _: &[f64]) -> Option<Frame> {
        None
    }

    fn place(&self, frame: &Frame) -> Vec<[[f64; 3]; 2]> {
        let ([.., theta], [.., omega]) = (frame.position, frame.velocity);
        let slope = [unit(theta), omega * quarter_turn(unit(theta))];
        let slope = slope.map(|x| x.push(0.0).into());
        let node = |k: usize| carried(frame, self.link.length * k as f64 / self.elements as f64);
        (0..=self.elements).flat_map(|k| [node(k), slope]).collect()
    }

    fn place_deformed(&self, frame: &Frame, deformation: &Deformation) -> Vec<[[f64; 3]; 2]> {
        let mut values = self.place(frame);
        // adding zero would change the sign of a negative zero
        if *deformation == Deformation::default() {
            return values;
        }
        let ([.., theta], [.., omega]) = (frame.position, frame.velocity);
        let length = self.link.length;
        let (e, n) = (unit(theta), quarter_turn(unit(theta)));
        let stretched = deformation.stretch() - 1.0;
        for (k, node) in values.chunks_exact_mut(2).enumerate() {
            let xi = length * (k as f64 / self.elements as f64 - 0.5);
            let [rate, slope_rate] = deformation.bending(length, xi);
            let changes = [
                [stretched * xi * e, (stretched * xi * omega + rate) * n],
                [stretched * e, (stretched * omega + slope_rate) * n],
            ];
            for (level, change) in node
                .as_flattened_mut()
                .iter_mut()
                .zip(changes.as_flattened())
            {
                level[0] += change.x;
                level[1] += change.y;
            }
        }
        values
    }

    fn velocity(&self, _: usize, _: &[usize], _: &[f64]) -> Option<Vec<(usize, f64)>> {
        None
    }

    fn rigid(&self) -> Option<Arc<dyn Body>> {
        Some(Arc::new(self.rigid_link()))
    }

    fn strain(&self, x: &[usize], q: &[f64]) -> Option<Strain> {
        let kernel = self.kernel();
        // of a rectangular section
        let height = (12.0 * self.link.second_moment / self.link.area).sqrt();
        let mut largest = Strain::default();
        for k in 0..self.elements {
            let local = std::array::from_fn(|i| q[x[2 * k + i / 2] + i % 2]);
            for sample in 0..=10 {
                let xi = f64::from(sample) / 10.0;
                largest.see(&Strain {
                    axial: kernel.strain(&local, xi),
                    bending: kernel.curvature(&local, xi) * height,
                });
            }
        }
        Some(largest)
    }

    fn slope_slot(&self, point: usize) -> Option<usize> {
        Some(2 * self.nodes[point] + 1)
    }
}

/// Mean over the length: sum over the elements of the integrals of the shape functions.
fn mean(level: &[f64], x: &[usize], element_length: f64) -> Vec2 {
    let mut sum = Vec2::zeros();
    for element in x.windows(4).step_by(2) {
        let [r_i, s_i, r_j, s_j] = [0, 1, 2, 3].map(|i| pair(level, element[i]));
        sum += 0.5 * (r_i + r_j);
        sum += element_length / 12.0 * (s_i - s_j);
    }
    1.0 / (x.len() / 2 - 1) as f64 * sum
}

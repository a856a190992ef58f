//! Springs, applied loads and structural damping of a scene as terms.

use super::Compiler;
use super::joints::spin;
use super::mass::planar_inertia;
use super::numbering::Numbering;
use super::terms::Terms;
use crate::force::{ElementDamping, MassDamping, PointForce, SpringDamper, Torque, TorsionSpring};
use crate::link::AncfCable;
use crate::marker::Spin;
use crate::model::BodyCoordinates;
use crate::scene::{Analysis, BodyKind, ForceKind, Function, LinkModel};

/// Adds the forces of a scene.
pub(super) fn add(c: &Compiler, numbering: &Numbering, terms: &mut Terms) {
    for force in &c.scene.forces {
        terms
            .named_forces
            .push((force.name.clone(), terms.forces.len()));
        let marker = |p: crate::scene::PointRef| c.marker(&numbering.bodies[p.body], p);
        match &force.kind {
            ForceKind::SpringDamper {
                from,
                to,
                stiffness,
                damping,
                rest_length,
            } => {
                let term = SpringDamper {
                    from: marker(*from),
                    to: marker(*to),
                    stiffness: *stiffness,
                    damping: *damping,
                    rest_length: *rest_length,
                };
                terms.forces.push((Box::new(term), [from.body, to.body]));
            }
            ForceKind::TorsionSpring {
                joint,
                stiffness,
                damping,
                rest_angle,
            } => {
                let points = [
                    c.scene.joints[*joint].bearing,
                    c.scene.joints[*joint].journal,
                ];
                let [first, second] = points.map(|p| spin(numbering, p));
                let term = TorsionSpring {
                    first,
                    second,
                    stiffness: *stiffness,
                    damping: *damping,
                    rest_angle: *rest_angle,
                    memory: terms.angles,
                };
                terms.angles += 1;
                terms.forces.push((Box::new(term), points.map(|p| p.body)));
            }
            ForceKind::PointForce {
                point,
                components,
                follower,
            } => {
                let term = PointForce {
                    marker: marker(*point),
                    spin: if *follower {
                        spin(numbering, *point)
                    } else {
                        Spin::Fixed
                    },
                    components: components.clone().map(|f| load(c, f)),
                };
                terms.forces.push((Box::new(term), [point.body; 2]));
            }
            ForceKind::Torque {
                point,
                reaction,
                value,
            } => {
                let term = Torque {
                    first: reaction.map_or(Spin::Fixed, |p| spin(numbering, p)),
                    second: spin(numbering, *point),
                    value: load(c, value.clone()),
                };
                let first = reaction.map_or(point.body, |p| p.body);
                terms.forces.push((Box::new(term), [first, point.body]));
            }
        }
    }
    for b in 0..c.scene.bodies.len() {
        damping(c, numbering, b, terms);
    }
}

/// A constant load of a static analysis grows in proportion to t.
fn load(c: &Compiler, f: Function) -> Function {
    match (c.scene.simulation.analysis, f) {
        (Analysis::Static, Function::Constant(value)) => {
            Function::Polynomial(vec![0.0, value / c.scene.simulation.duration])
        }
        (_, f) => f,
    }
}

/// Structural damping of a flexible link.
fn damping(c: &Compiler, numbering: &Numbering, b: usize, terms: &mut Terms) {
    let (
        BodyKind::Link(link),
        BodyCoordinates::FlexibleLink {
            nodes,
            slopes,
            element_length,
            ..
        },
    ) = (&c.scene.bodies[b].kind, &numbering.bodies[b])
    else {
        return;
    };
    let (Some(damping), LinkModel::Flexible { youngs_modulus, .. }) = (link.damping, link.model)
    else {
        return;
    };
    for k in 0..nodes.len() - 1 {
        let firsts = [nodes[k], slopes[k], nodes[k + 1], slopes[k + 1]];
        if damping.strain > 0.0 {
            let coordinates = firsts.iter().flat_map(|&x| [x, x + 1]).collect();
            let viscosity = youngs_modulus * damping.strain;
            let term = ElementDamping::new(
                coordinates,
                *element_length,
                viscosity * link.area,
                viscosity * link.second_moment,
            );
            terms.forces.push((Box::new(term), [b, b]));
        }
        if damping.mass > 0.0 {
            let m = AncfCable::mass(*element_length, link.density * link.area);
            let part = planar_inertia(m, firsts, [true, false, true, false], [0.0; 2]);
            let term = MassDamping {
                coordinates: part.coordinates,
                values: part.values.iter().map(|m| damping.mass * m).collect(),
            };
            terms.forces.push((Box::new(term), [b, b]));
        }
    }
}

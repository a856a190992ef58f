#include "angles.hpp"

#include <cmath>

#include "body_motion.hpp"

namespace {

double nearest(double angle, double near) { return near + std::remainder(angle - near, 2.0 * 3.14159265358979323846); }

double body_angle(const Body &body, const VectorXd &q) {
    if (body.is_link()) {
        const Vec<double> d = chord(body, q);
        return std::atan2(d.y, d.x);
    }
    return body.size == 3 ? q[body.offset + 2] : 0.0;
}

} // namespace

Angles starting_angles(const Model &model) {
    const System &system = model.system;
    const Inputs inputs = system.inputs(0.0);
    Angles near;
    near.body.setZero(static_cast<int>(system.bodies().size()));
    for (std::size_t i = 0; i < system.bodies().size(); ++i) {
        const Body &body = system.bodies()[i];
        const bool free = body.is_link() && !model.scene.initial.states[i];
        near.body[static_cast<int>(i)] = free ? 0.0 : model.poses[i].theta;
    }
    near.joint.setZero(static_cast<int>(system.joints().size()));
    for (const AngleDrive &drive : model.scene.angle_drives)
        near.joint[drive.joint] = evaluate(drive.angle, 0.0).value;
    near.spring.setZero(static_cast<int>(system.torsion_springs().size()));
    for (int i = 0; i < near.spring.size(); ++i) near.spring[i] = system.torsion_springs()[i].rest_angle + model.memory.turn[i];
    return continued(system, near, model.q);
}

Angles continued(const System &system, const Angles &near, const VectorXd &q) {
    Angles angles = near;
    for (int i = 0; i < near.body.size(); ++i)
        angles.body[i] = nearest(body_angle(system.bodies()[i], q), near.body[i]);
    for (int k = 0; k < near.joint.size(); ++k) {
        const Joint &joint = system.joints()[k];
        if (!joint.driven) continue;
        const Vec<double> d1 = direction(joint.bearing, q.data() + joint.bearing.offset),
                          d2 = direction(joint.journal, q.data() + joint.journal.offset);
        angles.joint[k] = nearest(std::atan2(cross(d1, d2), dot(d1, d2)), near.joint[k]);
    }
    for (int i = 0; i < near.spring.size(); ++i) {
        const TorsionSpring &spring = system.torsion_springs()[i];
        angles.spring[i] = spring.rest_angle + deviation(spring, near.spring[i] - spring.rest_angle, q);
    }
    return angles;
}

VectorXd spring_turns(const System &system, const Angles &angles) {
    VectorXd turns = angles.spring;
    for (int i = 0; i < turns.size(); ++i) turns[i] -= system.torsion_springs()[i].rest_angle;
    return turns;
}

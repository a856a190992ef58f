#include "pressed.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "acceleration.hpp"
#include "body_motion.hpp"
#include "closing.hpp"
#include "redundancy.hpp"

namespace {

// Rigid links in place of flexible ones, ideal joints in place of contacts. All else acts as in the scene.
Scene rigid_scene(const Scene &scene) {
    Scene rigid = scene;
    for (BodyDescription &body : rigid.bodies)
        if (body.kind == BodyKind::flexible_link) {
            body.kind = BodyKind::rigid_link;
            body.strain_damping = body.mass_damping = 0.0;
        }
    for (JointDescription &joint : rigid.joints) {
        joint.law.reset();
        joint.slope_vector = false;
    }
    return rigid;
}

// Least norm over the places of joints and ends of links, positions and angles: the end that several links share counts once.
VectorXd freedom(const System &system) {
    std::map<int, int> place; // first coordinate of an end -> the smallest one of an end that coincides with it
    auto root = [&](int i) {
        while (place.count(i) > 0 && place[i] != i) i = place[i];
        return i;
    };
    auto is_end = [](const Attachment &a) { return a.kind == BodyKind::rigid_link && (a.share == 0.0 || a.share == 1.0); };
    auto first = [](const Attachment &a) { return a.offset + (a.share == 1.0 ? 2 : 0); };
    for (const Joint &joint : system.joints()) {
        const bool coincide = joint.kind == JointKind::revolute || joint.kind == JointKind::weld;
        if (!coincide || joint.rows[0] < 0 || !is_end(joint.bearing) || !is_end(joint.journal)) continue;
        const auto [low, high] = std::minmax({root(first(joint.bearing)), root(first(joint.journal))});
        place[low] = low;
        place[high] = low;
    }
    std::map<int, int> count;
    for (const auto &entry : place) ++count[root(entry.first)];
    VectorXd scale = VectorXd::Ones(system.coordinates());
    for (const auto &entry : place) scale.segment<2>(entry.first).setConstant(std::sqrt(count[root(entry.first)]));
    for (const Body &body : system.bodies())
        if (body.kind == BodyKind::moving) scale.segment(body.offset, body.size).setZero();
    return scale;
}

// The rows of Phi in the middle and the eccentricity at which the normal law has the force of the joint.
VectorXd pressed_rows(const Scene &scene, const System &system, const VectorXd &lambda, std::vector<bool> &closed) {
    VectorXd target = VectorXd::Zero(system.constraints());
    for (std::size_t i = 0; i < scene.joints.size(); ++i) {
        const JointDescription &d = scene.joints[i];
        if (!d.law) continue;
        const std::array<int, 2> &rows = system.joints()[i].rows;
        double square = 0.0;
        for (int row : rows)
            if (row >= 0) square += lambda[row] * lambda[row];
        const double force = std::sqrt(square), delta = std::pow(force / d.law->stiffness, 1.0 / d.law->exponent);
        if (delta <= scene.onset_tolerance) continue;
        require(delta <= d.law->clearance, d.source, "the force at the start, " + text_of(force) +
                                                         " N, would press the journal in by " + text_of(delta) +
                                                         " m, more than its clearance");
        closed[i] = true;
        for (int row : rows)
            if (row >= 0) target[row] = (d.law->clearance + delta) / force * lambda[row];
    }
    return target;
}

Assembled poses_of(const System &system, const VectorXd &q, const VectorXd &v, const Assembled &near) {
    constexpr double turn = 2.0 * 3.14159265358979323846;
    Assembled start;
    for (std::size_t i = 0; i < system.bodies().size(); ++i) {
        const Body &body = system.bodies()[i];
        const Vec<double> place = center(body, q), speed = center(body, v);
        Frame pose, velocity;
        if (body.size > 0) {
            pose = {place.x, place.y, 0.0};
            velocity = {speed.x, speed.y, 0.0};
        }
        if (body.is_link()) {
            const Vec<double> d = chord(body, q), rate = chord(body, v);
            const double before = near.poses[i].theta;
            pose.theta = before + std::remainder(std::atan2(d.y, d.x) - before, turn);
            velocity.theta = cross(d, rate) / dot(d, d);
        } else if (body.size == 3) {
            pose.theta = q[body.offset + 2];
            velocity.theta = v[body.offset + 2];
        }
        start.poses.push_back(pose);
        start.velocities.push_back(velocity);
    }
    return start;
}

} // namespace

Pressed press(const Scene &scene, std::shared_ptr<const DrivenAngles> driven_angles, const Assembled &start) {
    System system(rigid_scene(scene), std::move(driven_angles));
    VectorXd q = VectorXd::Zero(system.coordinates()), v = q;
    for (std::size_t i = 0; i < start.poses.size(); ++i)
        put_body(system.bodies()[i], start.poses[i], start.velocities[i], {}, q, v);
    const VectorXd scale = freedom(system);
    close_rows(system, VectorXd::Zero(system.constraints()), scale, q);
    system.leave_out(redundant_rows(system, q));

    Acceleration level(system);
    level.project_velocities(0.0, q, v);
    Memory memory = system.memory();
    system.count_turns(q, memory);
    level.solve(0.0, q, v, memory, true);

    Pressed pressed;
    pressed.closed.resize(scene.joints.size(), false);
    close_rows(system, pressed_rows(scene, system, level.lambda, pressed.closed), scale, q);
    level.project_velocities(0.0, q, v);
    pressed.start = poses_of(system, q, v, start);
    return pressed;
}

#include "model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "acceleration.hpp"
#include "assembly.hpp"
#include "ideal.hpp"
#include "placing.hpp"
#include "pressed.hpp"
#include "redundancy.hpp"
#include "statics.hpp"

namespace {

bool can_have_state(const BodyDescription &body) {
    return body.kind != BodyKind::ground && body.kind != BodyKind::moving;
}

bool needs_assembly(const Scene &scene) {
    const Initial &initial = scene.initial;
    if (!initial.joints.empty() || !initial.points.empty() || !initial.velocities.empty()) return true;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
        if (can_have_state(scene.bodies[i]) && !initial.states[i]) return true;
    return false;
}

// A straight line of another length, or one that bends, is not the rigid link that an assembly moves.
void refuse_deformations(const Scene &scene, const char *why) {
    for (const std::optional<State> &state : scene.initial.states)
        if (state && state->deformation.any()) refuse(state->source, why);
}

// States as they are; of moving bodies those of their paths.
Assembled exact_states(const Scene &scene) {
    Assembled start;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        Frame pose, velocity;
        if (const std::optional<State> &state = scene.initial.states[i]) {
            pose = state->pose;
            velocity = state->velocity.value_or(Frame{});
        }
        if (const std::optional<Path> &path = scene.bodies[i].path) {
            const Prescribed x = evaluate((*path)[0], 0.0), y = evaluate((*path)[1], 0.0),
                             theta = evaluate((*path)[2], 0.0);
            pose = {x.value, y.value, theta.value};
            velocity = {x.rate, y.rate, theta.rate};
        }
        start.poses.push_back(pose);
        start.velocities.push_back(velocity);
    }
    return start;
}

// The longest body between its joints; a body with one joint reaches to its centre of mass.
double length_of(const Scene &scene) {
    std::vector<std::vector<Vec<double>>> points(scene.bodies.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        if (can_have_state(scene.bodies[i])) points[i].push_back({0.5 * scene.bodies[i].length, 0.0});
    for (const JointDescription &joint : scene.joints)
        for (const PointReference *side : {&joint.first, &joint.second})
            points[static_cast<std::size_t>(side->body)].push_back(side->at);
    double length = 0.0;
    for (const auto &of_body : points)
        for (const Vec<double> &a : of_body)
            for (const Vec<double> &b : of_body) length = std::max(length, std::hypot(a.x - b.x, a.y - b.y));
    return length > 0.0 ? length : 1.0;
}

// A start as it is given must fit the joints. Where everything comes to rest its velocities do not count.
void check_exact_start(const Scene &scene, const System &system, const VectorXd &q, const VectorXd &v) {
    constexpr double rounding = 1e-8;
    const double length = length_of(scene), limit = rounding * length;
    const double fastest = v.size() > 0 ? v.cwiseAbs().maxCoeff() : 0.0, speed_limit = rounding * std::max(length, fastest);
    const bool moves = !scene.is_static && scene.initial.equilibrium == Initial::Rest::none;
    const Inputs inputs = system.inputs(0.0);
    VectorXd phi, phi_t;
    MatrixXd phi_q;
    system.constraint_rows(inputs, q, phi, phi_q, phi_t);
    const VectorXd rate = phi_q * v + phi_t;
    for (int k = 0; k < system.constraints(); ++k) {
        if (std::abs(phi[k]) > limit)
            refuse(system.row_source(k), "the given states violate " + system.row_name(k) + " by " + text_of(phi[k]));
        if (moves && std::abs(rate[k]) > speed_limit)
            refuse(system.row_source(k), "the given velocities violate " + system.row_name(k) + " by " + text_of(rate[k]));
    }
    system.check_angles(inputs, q);
    for (int k : system.loose_joints())
        if (system.gap(k, q.data(), v.data()).delta() > system.law(k).clearance)
            refuse(scene.joints[k].source, system.joints()[k].kind == JointKind::prismatic
                                               ? "the slider starts outside its guide"
                                               : "the journal starts outside its bearing");
}

// Contacts that begin closed because the start presses them in.
std::vector<bool> pressed_in(const Scene &scene, const System &system, const VectorXd &q, const VectorXd &v) {
    std::vector<bool> closed(scene.joints.size(), false);
    for (int k : system.loose_joints()) closed[k] = system.gap(k, q.data(), v.data()).delta() > scene.onset_tolerance;
    return closed;
}

void start_at_rest(Model &model) {
    Statics statics(model.system);
    Equilibrium x{0.0, model.q, VectorXd::Zero(model.system.constraints()), model.memory};
    if (model.scene.initial.equilibrium == Initial::Rest::nearest)
        statics.approach(x);
    else
        statics.descend(x);
    model.rest = statics.stability(x);
    model.q = x.q;
    model.memory = x.memory;
    model.v.setZero();
    Acceleration(model.system).project(0.0, model.q, model.v, std::numeric_limits<double>::infinity());
}

} // namespace

Model make_model(Scene scene) {
    const bool prescribed_pose = scene.inverse_kinematics.has_value(), assembled = needs_assembly(scene);
    const Scene ideal = idealised(scene);
    std::shared_ptr<const DrivenAngles> driven_angles;
    Assembled start;
    if (prescribed_pose) {
        start = assemble(ideal, true);
        driven_angles = make_driven_angles(ideal, start.poses);
        for (std::size_t i = 0; i < scene.bodies.size(); ++i)
            if (const std::optional<State> &state = scene.initial.states[i]) {
                start.poses[i] = state->pose;
                start.velocities[i] = state->velocity.value_or(Frame{});
            }
    } else {
        if (assembled)
            refuse_deformations(scene, "a link with a strain or bending_rate cannot be assembled: give every body a state, and "
                                       "neither a sketch nor velocities");
        start = assembled ? assemble(ideal, false) : exact_states(scene);
    }

    System system(scene, driven_angles);
    VectorXd q = VectorXd::Zero(system.coordinates()), v = q;
    auto put_bodies = [&] {
        for (std::size_t i = 0; i < start.poses.size(); ++i) {
            const std::optional<State> &state = scene.initial.states[i];
            put_body(system.bodies()[i], start.poses[i], start.velocities[i], state ? state->deformation : Deformation{}, q, v);
        }
    };
    put_bodies();
    check_exact_start(scene, system, q, v);
    std::vector<bool> closed = pressed_in(scene, system, q, v);
    if (scene.initial.pressed && !system.loose_joints().empty()) {
        refuse_deformations(scene, "a link with a strain or bending_rate cannot start with pressed journals");
        Pressed pressed = press(scene, driven_angles, start);
        start = std::move(pressed.start);
        closed = std::move(pressed.closed);
        put_bodies();
    }

    const std::vector<int> redundant = redundant_rows(system, q);
    std::vector<std::string> names;
    for (int row : redundant) names.push_back(system.row_name(row));
    system.leave_out(redundant);
    Memory memory = system.memory();
    for (int k : system.loose_joints())
        if (closed[k])
            memory.impact_velocity[k] = std::max(system.gap(k, q.data(), v.data()).rate(), system.law(k).impact_velocity_floor);
    system.count_turns(q, memory);
    Model model{std::move(scene), std::move(system), std::move(q), std::move(v), std::move(memory), std::move(start.poses),
                std::move(names), {}};
    if (model.scene.initial.equilibrium != Initial::Rest::none) start_at_rest(model);
    return model;
}

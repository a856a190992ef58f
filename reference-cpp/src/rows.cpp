// The constraint rows of the mechanism, in the order of the header, and what errors call them.
#include <cmath>

#include "failure.hpp"
#include "names.hpp"
#include "system.hpp"

namespace {

const char *kind_name(ls_joint_kind kind) {
    return kind == LS_REVOLUTE ? " (revolute)" : kind == LS_PRISMATIC ? " (prismatic)" : " (weld)";
}

} // namespace

void System::add_row(const Constraint &row, const std::string &name) {
    constraints_.push_back(row);
    row_names_.push_back(name);
}

void System::add_constraints(const ls_mechanism &m) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const Body &b = bodies_[i];
        const std::string name = named("body", static_cast<int>(i));
        if (b.kind == LS_RIGID_LINK) add_row(length_constraint(b), name + " (rigid link), length");
        if (b.kind != LS_MOVING_BODY) continue;
        const char *coordinates[3] = {" (moving body), x", " (moving body), y", " (moving body), theta"};
        for (int k = 0; k < 3; ++k) {
            prescribed_.push_back({b.offset + k, constraints()});
            add_row(coordinate_constraint(b, k, b.function + k), name + coordinates[k]);
        }
    }
    for (int i = 0; i < joints(); ++i)
        if (joints_[i].contact < 0) add_joint_rows(joints_[i], m.joints[i], i);
    first_drive_ = constraints();
    for (int i = 0; i < legs(); ++i)
        add_row(drive_constraint(bodies_[legs_[i].crank], legs_[i].crank_from_start, i), named("leg", i));
    for (int i = 0; i < m.n_motions; ++i) add_motion_row(m.motions[i], i);
}

void System::add_joint_rows(Joint &joint, const ls_joint &j, int number) {
    const std::string name = named("joint", number) + kind_name(joint.kind);
    joint.constraint = constraints();
    if (joint.kind == LS_PRISMATIC) {
        add_row(slide_constraint(joint.bearing, joint.journal, j.direction), name + ", line");
    } else {
        for (int axis : {0, 1})
            add_row(coincide_constraint(joint.bearing, joint.journal, axis), name + (axis == 0 ? ", x" : ", y"));
    }
    joint.holding = constraints();
    if (j.hold_slope) {
        for (int axis : {0, 1})
            add_row(slope_constraint(joint.bearing, joint.journal, j.angle, axis),
                    name + (axis == 0 ? ", slope x" : ", slope y"));
    } else if (joint.kind == LS_WELD || j.hold_rotation) {
        add_row(align_constraint(joint.bearing, joint.journal, j.angle), name + ", rotation");
    }
    joint.held = constraints() - joint.holding;
}

void System::add_motion_row(const ls_motion &m, int number) {
    const std::string name = named("motion", number);
    require(m.kind == LS_ANGLE || m.kind == LS_COORDINATE, name + ": unknown kind");
    const int function = use_smooth_function(m.function, name);
    motions_.push_back(constraints());
    auto moves = [](const Attachment &a) { return a.size > 0 && a.kind != LS_MOVING_BODY; };
    if (m.kind == LS_ANGLE) {
        const Joint &j = turning_joint(m.joint, name);
        require(moves(j.bearing) || moves(j.journal), name + ": the motion of both sides is prescribed already");
        add_row(turn_constraint(j.bearing, j.journal, function), name + " (angle)");
        return;
    }
    constexpr double rounding = 1e-9;
    const Attachment point = attachment(m.point, name);
    require(moves(point), name + ": the point is fixed or its motion prescribed already");
    require(std::abs(std::hypot(m.nx, m.ny) - 1.0) <= rounding, name + ": n is not a unit vector");
    add_row(place_constraint(point, {m.nx, m.ny}, function), name + " (coordinate)");
}

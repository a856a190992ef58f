// The constraint rows of the mechanism and their names, in the order of the header.
#include <algorithm>
#include <cmath>

#include "system.hpp"

int System::add_row(const Constraint &row, const std::string &name, const Source &source) {
    constraints_.push_back(row);
    row_sources_.push_back(source);
    row_names_.push_back(name);
    return constraints() - 1;
}

void System::add_constraints(const Scene &scene) {
    const char *axes[3] = {".x", ".y", ".theta"};
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const Body &b = bodies_[i];
        if (b.kind == BodyKind::rigid_link) add_row(length_constraint(b), b.name + ".length", scene.bodies[i].source);
        if (!scene.bodies[i].path) continue;
        for (int k = 0; k < 3; ++k) {
            const int given = add_function((*scene.bodies[i].path)[k]);
            const int row = add_row(coordinate_constraint(b, k, given), b.name + axes[k], scene.bodies[i].source);
            if (b.kind == BodyKind::moving) prescribed_.push_back({b.offset + k, row});
        }
    }
    for (std::size_t i = 0; i < joints_.size(); ++i)
        if (!joints_[i].law) add_joint_rows(joints_[i], scene.joints[i]);
    for (const AngleDrive &drive : scene.angle_drives) {
        Joint &joint = joints_[drive.joint];
        joint.drive = add_row(turn_constraint(joint.bearing, joint.journal, add_function(drive.angle)),
                              drive.name + ".angle", drive.source);
        joint.driven = true;
    }
    for (const PointDrive &drive : scene.point_drives) {
        const Attachment point = attachment(drive.point);
        if (drive.x) add_row(place_constraint(point, 0, add_function(*drive.x)), drive.name + ".x", drive.source);
        if (drive.y) add_row(place_constraint(point, 1, add_function(*drive.y)), drive.name + ".y", drive.source);
    }
    if (!driven_angles_) return;
    for (const TimeFunction &function : scene.inverse_kinematics->path) add_breaks(function, breaks_);
    int given = static_cast<int>(functions_.size());
    for (int j : scene.inverse_kinematics->joints) {
        Joint &joint = joints_[j];
        joint.drive = add_row(turn_constraint(joint.bearing, joint.journal, given++),
                              scene.inverse_kinematics->name + "." + joint.name, scene.inverse_kinematics->source);
        joint.driven = true;
    }
}

void System::add_joint_rows(Joint &joint, const JointDescription &d) {
    if (joint.kind == JointKind::prismatic) {
        joint.rows[0] =
            add_row(slide_constraint(joint.bearing, joint.journal, d.direction), joint.name + ".line", d.source);
    } else if (joint.kind == JointKind::rod) {
        joint.rows[0] = add_row(distance_constraint(joint.bearing, joint.journal, d.length), joint.name + ".length", d.source);
    } else {
        for (int axis : {0, 1})
            joint.rows[axis] = add_row(coincide_constraint(joint.bearing, joint.journal, axis),
                                       joint.name + (axis == 0 ? ".x" : ".y"), d.source);
    }
    const bool bends = joint.bearing.kind == BodyKind::flexible_link || joint.journal.kind == BodyKind::flexible_link;
    if (d.slope_vector && bends) {
        for (int axis : {0, 1})
            joint.holds[axis] = add_row(slope_constraint(joint.bearing, joint.journal, d.angle, axis),
                                        joint.name + (axis == 0 ? ".slope_x" : ".slope_y"), d.source);
    } else if (d.holds_angle()) {
        joint.holds[0] =
            add_row(align_constraint(joint.bearing, joint.journal, d.angle), joint.name + ".rotation", d.source);
    }
}

void System::leave_out(const std::vector<int> &rows) {
    std::vector<int> moved(constraints_.size());
    std::vector<Constraint> kept;
    std::vector<std::string> names;
    std::vector<Source> sources;
    for (int k = 0; k < constraints(); ++k) {
        const bool out = std::find(rows.begin(), rows.end(), k) != rows.end();
        moved[k] = out ? -1 : static_cast<int>(kept.size());
        if (out) {
            left_out_.push_back({constraints_[k], row_names_[k], row_sources_[k]});
            continue;
        }
        kept.push_back(constraints_[k]);
        names.push_back(row_names_[k]);
        sources.push_back(row_sources_[k]);
    }
    constraints_ = std::move(kept);
    row_names_ = std::move(names);
    row_sources_ = std::move(sources);
    auto move = [&](int &row) { row = row < 0 ? -1 : moved[row]; };
    for (Joint &joint : joints_) {
        for (int axis : {0, 1}) {
            move(joint.rows[axis]);
            move(joint.holds[axis]);
        }
        move(joint.drive);
    }
    for (PrescribedCoordinate &p : prescribed_) move(p.row);
}

void System::check_left_out(const Inputs &inputs, const VectorXd &q, double t) const {
    constexpr double limit = 1e-4; // generous: between two steps rows hold to the tolerance of the run only
    for (const LeftOut &c : left_out_)
        if (const double open = evaluate(c.row, q, prescription(c.row, inputs).value).value; std::abs(open) > limit)
            refuse(c.source, c.name + " contradicts the other constraints: it repeats them at the start, but is open by " +
                                 text_of(open) + " at t = " + text_of(t));
}

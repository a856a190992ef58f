// From the description to the mechanism; what makes no sense is refused here.
#include "system.hpp"

#include <algorithm>
#include <cmath>

#include "failure.hpp"
#include "names.hpp"

namespace {

void require_list(std::int32_t count, const void *items, const char *what) {
    require(count >= 0 && (count == 0 || items), std::string(what) + " are missing");
}

void require_not_negative(double x, const std::string &name, const char *field) {
    require(std::isfinite(x) && x >= 0.0, name + ": " + field + " must not be negative");
}

void require_finite(double x, const std::string &name, const char *field) {
    require(std::isfinite(x), name + ": " + field + " is not finite");
}

bool is_flag(std::int32_t x) { return x == 0 || x == 1; }

} // namespace

System::System(const ls_mechanism &m) {
    require(m.n_bodies > 0 && m.bodies, "there are no bodies");
    require_list(m.n_joints, m.joints, "joints");
    require_list(m.n_contacts, m.contacts, "contacts");
    require_list(m.n_legs, m.legs, "legs");
    require_list(m.n_functions, m.functions, "functions");
    require_list(m.n_springs, m.springs, "springs");
    require_list(m.n_torsion_springs, m.torsion_springs, "torsion springs");
    require_list(m.n_loads, m.loads, "loads");
    require_list(m.n_motions, m.motions, "motions");
    require_finite(m.gravity_x, "gravity", "x");
    require_finite(m.gravity_y, "gravity", "y");

    for (int i = 0; i < m.n_functions; ++i) functions_.push_back(make_function(m.functions[i], named("function", i)));
    add_bodies(m);
    for (int i = 0; i < m.n_contacts; ++i) laws_.push_back(make_contact_law(m.contacts[i], named("contact", i)));
    for (int i = 0; i < m.n_joints; ++i) add_joint(m.joints[i], i);
    if (m.n_legs > 0) {
        const ls_path &p = m.path;
        require(body(p.body, "path").kind == LS_RIGID_BODY, "path: the driven body must be a rigid body");
        for (double x : {p.centre_x, p.centre_y, p.radius, p.frequency, p.phase, p.theta})
            require(std::isfinite(x), "path: a value is not finite");
        path_ = {p.body, {p.centre_x, p.centre_y}, p.radius, p.frequency, p.phase, p.theta};
        for (int i = 0; i < m.n_legs; ++i) add_leg(m.legs[i], i, m);
    }
    add_springs(m);
    for (int i = 0; i < m.n_loads; ++i) add_load(m.loads[i], i);
    add_constraints(m);
    complete_mass(m.gravity_x, m.gravity_y);
    find_undriven();

    std::sort(breaks_.begin(), breaks_.end());
    breaks_.erase(std::unique(breaks_.begin(), breaks_.end()), breaks_.end());
}

void System::add_bodies(const ls_mechanism &m) {
    for (int i = 0; i < m.n_bodies; ++i) {
        const std::string name = named("body", i);
        bodies_.push_back(make_body(m.bodies[i], n_, name));
        Body &b = bodies_.back();
        n_ += b.size;
        if (b.kind != LS_MOVING_BODY) continue;
        for (int k = 0; k < 3; ++k) use_smooth_function(b.function + k, name);
    }
    require(n_ > 0, "no body can move");
}

const Body &System::body(int index, const std::string &name) const {
    require(index >= 0 && index < static_cast<int>(bodies_.size()), name + ": there is no body " + std::to_string(index));
    return bodies_[index];
}

Attachment System::attachment(const ls_point &p, const std::string &name) const {
    return make_attachment(body(p.body, name), p, name);
}

Attachment System::directed_attachment(const ls_point &p, const std::string &name) const {
    const Attachment a = attachment(p, name);
    require(a.has_direction(), name + ": a point mass has no direction");
    return a;
}

int System::use_function(int index, const std::string &name) {
    require(index >= 0 && index < static_cast<int>(functions_.size()),
            name + ": there is no function " + std::to_string(index));
    add_breaks(functions_[index], breaks_);
    return index;
}

// The acceleration of what is prescribed must exist.
int System::use_smooth_function(int index, const std::string &name) {
    use_function(index, name);
    require(functions_[index].kind != LS_RAMP,
            name + ": function " + std::to_string(index) + " is a ramp, which no motion can follow");
    return index;
}

void System::add_joint(const ls_joint &j, int number) {
    const std::string name = named("joint", number);
    require(j.kind == LS_REVOLUTE || j.kind == LS_PRISMATIC || j.kind == LS_WELD, name + ": unknown kind");
    const Body &bearing = body(j.bearing.body, name + ", bearing");
    const Body &journal = body(j.journal.body, name + ", journal");
    require(j.bearing.body != j.journal.body, name + ": bearing and journal are on the same body");
    require(bearing.size + journal.size > 0, name + ": neither side can move");
    require(is_flag(j.hold_rotation) && is_flag(j.hold_slope), name + ": hold_rotation and hold_slope must be 0 or 1");
    require(j.kind != LS_REVOLUTE || j.hold_rotation == 0, name + ": a revolute joint cannot hold the rotation");
    require(j.kind == LS_WELD || j.hold_slope == 0, name + ": only a weld can hold the slope");

    Joint joint;
    joint.kind = static_cast<ls_joint_kind>(j.kind);
    joint.bearing = attachment(j.bearing, name + ", bearing");
    joint.journal = attachment(j.journal, name + ", journal");
    if (joint.kind != LS_REVOLUTE) {
        require_finite(j.direction, name, "direction");
        require_finite(j.angle, name, "angle");
        directed_attachment(j.bearing, name + ", bearing");
        if (joint.kind == LS_WELD || j.hold_rotation) directed_attachment(j.journal, name + ", journal");
        require(j.hold_slope == 0 || bearing.kind == LS_FLEXIBLE_LINK || journal.kind == LS_FLEXIBLE_LINK,
                name + ": only a flexible link has a slope to hold");
    }
    if (j.contact >= 0) {
        require(joint.kind == LS_REVOLUTE, name + ": only a revolute joint can have play");
        require(j.contact < static_cast<int>(laws_.size()), name + ": there is no contact " + std::to_string(j.contact));
        joint.contact = j.contact;
        const ContactLaw &law = laws_[j.contact];
        require(!law.friction || !law.material_slip || (joint.bearing.has_direction() && joint.journal.has_direction()),
                name + ": slip of the material needs rotations, and a point mass has no direction");
        loose_.push_back(number);
    } else {
        require(bearing.can_move() || journal.can_move(), name + ": the motion of both sides is prescribed");
    }
    joints_.push_back(joint);
}

// The joint of a torsion spring or of a prescribed angle.
const Joint &System::turning_joint(int index, const std::string &name) const {
    require(index >= 0 && index < joints(), name + ": there is no joint " + std::to_string(index));
    const Joint &j = joints_[index];
    require(j.kind == LS_REVOLUTE, name + ": joint " + std::to_string(index) + " is not a revolute joint");
    require(j.bearing.has_direction() && j.journal.has_direction(),
            name + ": joint " + std::to_string(index) + " is on a point mass, which has no direction");
    return j;
}

void System::add_springs(const ls_mechanism &m) {
    for (int i = 0; i < m.n_springs; ++i) {
        const ls_spring &s = m.springs[i];
        const std::string name = named("spring", i);
        require_not_negative(s.stiffness, name, "stiffness");
        require_not_negative(s.damping, name, "damping");
        require_not_negative(s.rest_length, name, "rest_length");
        const Attachment from = attachment(s.from, name + ", from"), to = attachment(s.to, name + ", to");
        require(from.size + to.size > 0, name + ": neither end can move");
        require(s.from.body != s.to.body || s.from.x != s.to.x || s.from.y != s.to.y, name + ": its ends are the same point");
        springs_.push_back({from, to, s.stiffness, s.damping, s.rest_length, i});
    }
    for (int i = 0; i < m.n_torsion_springs; ++i) {
        const ls_torsion_spring &s = m.torsion_springs[i];
        const std::string name = named("torsion spring", i);
        const Joint &j = turning_joint(s.joint, name);
        require_not_negative(s.stiffness, name, "stiffness");
        require_not_negative(s.damping, name, "damping");
        require_finite(s.rest_angle, name, "rest_angle");
        torsion_springs_.push_back({j.bearing, j.journal, s.stiffness, s.damping, s.rest_angle});
    }
}

void System::add_load(const ls_load &l, int number) {
    const std::string name = named("load", number);
    require(l.kind == LS_DEAD_FORCE || l.kind == LS_FOLLOWER_FORCE || l.kind == LS_TORQUE, name + ": unknown kind");
    Load load{};
    load.kind = static_cast<ls_load_kind>(l.kind);
    load.x = use_function(l.x, name);
    load.y = l.kind == LS_TORQUE ? load.x : use_function(l.y, name);
    load.point = l.kind == LS_DEAD_FORCE ? attachment(l.point, name) : directed_attachment(l.point, name);
    load.reaction = l.kind == LS_TORQUE && l.reaction.body >= 0 ? directed_attachment(l.reaction, name + ", reaction")
                                                                 : ground_attachment();
    require(load.point.size + load.reaction.size > 0, name + ": it acts on the ground alone");
    loads_.push_back(load);
}

void System::complete_mass(double gravity_x, double gravity_y) {
    mass_ = MatrixXd::Zero(n_, n_);
    levers_ = VectorXd::Ones(n_);
    VectorXd gravity = VectorXd::Zero(n_);
    for (const Body &b : bodies_) {
        add_mass(b, mass_);
        add_translation(b, gravity_x, gravity_y, gravity);
        if (b.kind == LS_RIGID_BODY) levers_[b.offset + 2] = b.lever;
        if (b.kind == LS_FLEXIBLE_LINK)
            for (int i = 0; i <= b.elements; ++i) levers_.segment<2>(b.offset + 4 * i + 2).setConstant(b.lever);
    }
    // the frame of a moving body has no length of its own, only points at a distance
    for (const Joint &j : joints_)
        for (const Attachment *a : {&j.bearing, &j.journal})
            if (a->kind == LS_MOVING_BODY) {
                double &lever = levers_[a->offset + 2];
                lever = std::max(lever, std::hypot(a->point.x, a->point.y));
            }
    sparse_mass_ = mass_.sparseView();
    weight_ = sparse_mass_ * gravity;
    MatrixXd inverse = MatrixXd::Zero(n_, n_), damping = MatrixXd::Zero(n_, n_);
    for (const Body &b : bodies_)
        if (b.can_move()) {
            const auto block = mass_.block(b.offset, b.offset, b.size, b.size);
            inverse.block(b.offset, b.offset, b.size, b.size) = block.llt().solve(MatrixXd::Identity(b.size, b.size));
            damping.block(b.offset, b.offset, b.size, b.size) = b.mass_damping * block;
        }
    inverse_mass_ = inverse.sparseView();
    mass_damping_ = damping.sparseView();
}

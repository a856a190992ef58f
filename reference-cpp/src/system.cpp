// From the scene to the mechanism.
#include "system.hpp"

#include <algorithm>
#include <cmath>

namespace {

// The angle of a body at t = 0 with its full turns, where the scene gives them.
std::optional<double> given_angle(const Scene &scene, int body) {
    if (scene.bodies[body].kind == BodyKind::ground) return 0.0;
    if (scene.bodies[body].path) return evaluate((*scene.bodies[body].path)[2], 0.0).value;
    if (const std::optional<State> &state = scene.initial.states[body]) return state->pose.theta;
    return {};
}

// phi - phi_0 with the turns of a drive of the joint or of the two bodies. A sketch gives none: within half a turn of 0.
double starting_deviation(const Scene &scene, const TorsionSpringDescription &spring) {
    for (const AngleDrive &drive : scene.angle_drives)
        if (drive.joint == spring.joint) return evaluate(drive.angle, 0.0).value - spring.rest_angle;
    const JointDescription &joint = scene.joints[spring.joint];
    const std::optional<double> first = given_angle(scene, joint.first.body), second = given_angle(scene, joint.second.body);
    return first && second ? *second - *first - spring.rest_angle : 0.0;
}

} // namespace

System::System(const Scene &scene, std::shared_ptr<const DrivenAngles> driven_angles)
    : driven_angles_(std::move(driven_angles)), full_load_(scene.is_static ? scene.duration : 0.0) {
    add_bodies(scene);
    add_joints(scene);
    add_forces(scene);
    add_constraints(scene);
    complete_mass(scene);
    std::sort(breaks_.begin(), breaks_.end());
    breaks_.erase(std::unique(breaks_.begin(), breaks_.end()), breaks_.end());
}

void System::add_bodies(const Scene &scene) {
    for (const BodyDescription &description : scene.bodies) {
        bodies_.push_back(make_body(description, n_));
        n_ += bodies_.back().size;
        for (const std::string &name : coordinate_names(bodies_.back())) coordinate_names_.push_back(name);
    }
    require(n_ > 0, "the scene has no body that can move");
}

void System::add_joints(const Scene &scene) {
    auto moves = [&](int body) { return scene.bodies[body].kind != BodyKind::ground && !scene.bodies[body].path; };
    for (const JointDescription &d : scene.joints) {
        Joint joint;
        joint.name = d.name;
        joint.kind = d.kind;
        joint.bearing = attachment(d.first);
        joint.journal = attachment(d.second);
        joint.law = d.law;
        joint.direction = d.direction;
        joint.holds_angle = d.holds_angle();
        require(moves(d.first.body) || moves(d.second.body) || scene.inverse_kinematics, d.source,
                "the motion of both sides is prescribed");
        if (d.law) loose_.push_back(static_cast<int>(joints_.size()));
        if (d.law && d.law->friction.has_bristles()) joint.bristle = bristles_++;
        joints_.push_back(joint);
    }
}

int System::add_function(const TimeFunction &function, bool grows) {
    add_breaks(function, breaks_);
    functions_.push_back(function);
    grows_.push_back(grows);
    return static_cast<int>(functions_.size()) - 1;
}

void System::add_forces(const Scene &scene) {
    for (const SpringDescription &s : scene.springs)
        springs_.push_back(
            {s.name, attachment(s.from), attachment(s.to), s.stiffness, s.damping, s.rest_length});
    for (const TorsionSpringDescription &s : scene.torsion_springs) {
        const Joint &joint = joints_[s.joint];
        torsion_springs_.push_back({s.name, joint.bearing, joint.journal, s.stiffness, s.damping, s.rest_angle,
                                    starting_deviation(scene, s)});
    }
    elongation_.resize(static_cast<int>(scene.maxwells.size()));
    for (const MaxwellDescription &m : scene.maxwells) {
        elongation_[static_cast<int>(maxwells_.size())] = m.elongation;
        maxwells_.push_back({m.name, attachment(m.from), attachment(m.to), m.stiffness, m.damping, m.rest_length});
    }
    auto add_load_function = [&](const TimeFunction &f) {
        return add_function(f, scene.is_static && std::holds_alternative<Constant>(f));
    };
    for (const LoadDescription &l : scene.loads)
        loads_.push_back({l.name, l.kind, add_load_function(l.x), add_load_function(l.y), attachment(l.point),
                          l.kind == LoadKind::torque ? attachment(l.reaction) : ground_attachment()});
}

void System::complete_mass(const Scene &scene) {
    levers_ = VectorXd::Ones(n_);
    VectorXd gravity = VectorXd::Zero(n_);
    Entries mass, damping, massless;
    has_mass_ = VectorXd::Ones(n_);
    for (const Body &b : bodies_) {
        Entries own;
        add_mass(b, own);
        mass.insert(mass.end(), own.begin(), own.end());
        add_translation(b, scene.gravity.x, scene.gravity.y, gravity);
        if (b.kind == BodyKind::rigid_body) levers_[b.offset + 2] = b.lever;
        for (int i = 0; i <= b.elements && b.kind == BodyKind::flexible_link; ++i)
            levers_.segment<2>(b.offset + 4 * i + 2).setConstant(b.lever);
        if (b.mass_damping > 0.0)
            for (const auto &entry : own) damping.emplace_back(entry.row(), entry.col(), b.mass_damping * entry.value());
        if (b.can_move()) continue;
        has_mass_.segment(b.offset, b.size).setZero();
        for (int i = b.offset; i < b.offset + b.size; ++i) massless.emplace_back(i, i, 1.0);
    }
    // the frame of a moving body has no length of its own, only points at a distance
    for (const Joint &j : joints_)
        for (const Attachment *a : {&j.bearing, &j.journal})
            if (a->kind == BodyKind::moving) {
                double &lever = levers_[a->offset + 2];
                lever = std::max(lever, std::hypot(a->point.x, a->point.y));
            }
    auto assembled = [&](const Entries &entries) {
        SparseMatrix matrix(n_, n_);
        matrix.setFromTriplets(entries.begin(), entries.end());
        return matrix;
    };
    mass_ = assembled(mass);
    mass_damping_ = assembled(damping);
    weight_ = mass_ * gravity;
    mass.insert(mass.end(), massless.begin(), massless.end());
    mass_factor_ = std::make_shared<const Eigen::SimplicialLDLT<SparseMatrix>>(assembled(mass));

    std::vector<bool> constrained(n_, false);
    for (const Constraint &c : constraints_)
        for (int i = 0; i < c.size; ++i) constrained[c.index[i]] = true;
    Entries inverse;
    for (int column = 0; column < n_; ++column) {
        if (!constrained[column]) continue;
        const VectorXd x = divided_by_mass(VectorXd::Unit(n_, column));
        for (int row = 0; row < n_; ++row)
            if (x[row] != 0.0) inverse.emplace_back(row, column, x[row]);
    }
    inverse_mass_ = assembled(inverse);
}

VectorXd System::divided_by_mass(const VectorXd &x) const {
    return has_mass_.cwiseProduct(mass_factor_->solve(x));
}

std::string System::state_name(int state) const {
    if (state >= bristles_) return maxwells_[state - bristles_].name + ".elongation";
    const auto has_it = [state](const Joint &joint) { return joint.bristle == state; };
    return std::find_if(joints_.begin(), joints_.end(), has_it)->name + ".bristle";
}

int System::moves_most(const VectorXd &motion) const {
    VectorXd size = levers_.cwiseProduct(motion).cwiseAbs();
    for (const Body &b : bodies_)
        for (int i = 0; i <= b.elements && b.kind == BodyKind::flexible_link; ++i)
            size.segment<2>(b.offset + 4 * i + 2).setZero();
    int coordinate = 0;
    size.maxCoeff(&coordinate);
    return coordinate;
}

Inputs System::inputs(double t) const {
    Inputs inputs;
    const bool grows = full_load_ > 0.0;
    inputs.weight = grows ? t / full_load_ : 1.0;
    inputs.weight_rate = grows ? 1.0 / full_load_ : 0.0;
    for (std::size_t i = 0; i < functions_.size(); ++i) {
        inputs.given.push_back(evaluate(functions_[i], t));
        if (!grows_[i]) continue;
        Prescribed &load = inputs.given.back(); // of a constant
        load.rate = load.value * inputs.weight_rate;
        load.value *= inputs.weight;
    }
    if (driven_angles_)
        for (const Prescribed &angle : driven_angles_->at_time(t)) inputs.given.push_back(angle);
    return inputs;
}

Memory System::memory() const {
    VectorXd turn(static_cast<int>(torsion_springs_.size()));
    for (int i = 0; i < turn.size(); ++i) turn[i] = torsion_springs_[i].start;
    VectorXd state = VectorXd::Zero(states());
    state.tail(elongation_.size()) = elongation_;
    return {VectorXd::Zero(static_cast<int>(joints_.size())), std::move(turn), std::move(state)};
}

void System::count_turns(const VectorXd &q, Memory &memory) const {
    for (int i = 0; i < memory.turn.size(); ++i) memory.turn[i] = deviation(torsion_springs_[i], memory.turn[i], q);
}

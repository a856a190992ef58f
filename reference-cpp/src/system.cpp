#include "system.hpp"

#include <cmath>

#include "failure.hpp"

namespace {

std::string named(const char *what, int index) { return std::string(what) + " " + std::to_string(index); }

const Body &body_at(const std::vector<Body> &bodies, int index, const std::string &name) {
    require(index >= 0 && index < static_cast<int>(bodies.size()), name + ": there is no body " + std::to_string(index));
    return bodies[index];
}

bool is_link(const Body &b) { return b.kind == LS_RIGID_LINK || b.kind == LS_FLEXIBLE_LINK; }

} // namespace

System::System(const ls_mechanism &m) {
    require(m.n_bodies > 0 && m.bodies, "there are no bodies");
    require(m.n_joints >= 0 && (m.n_joints == 0 || m.joints), "joints are missing");
    require(m.n_contacts >= 0 && (m.n_contacts == 0 || m.contacts), "contacts are missing");
    require(m.n_legs >= 0 && (m.n_legs == 0 || m.legs), "legs are missing");

    for (int i = 0; i < m.n_bodies; ++i) {
        bodies_.push_back(make_body(m.bodies[i], n_, named("body", i)));
        n_ += bodies_.back().size;
    }
    require(n_ > 0, "no body can move");
    for (int i = 0; i < m.n_contacts; ++i) laws_.push_back(make_contact_law(m.contacts[i], named("contact", i)));
    for (int i = 0; i < m.n_joints; ++i) add_joint(m.joints[i], i, m);
    if (m.n_legs > 0) {
        const ls_path &p = m.path;
        require(body_at(bodies_, p.body, "path").kind == LS_RIGID_BODY, "path: the driven body must be a rigid body");
        for (double x : {p.centre_x, p.centre_y, p.radius, p.frequency, p.phase, p.theta})
            require(std::isfinite(x), "path: a value is not finite");
        path_ = {p.body, {p.centre_x, p.centre_y}, p.radius, p.frequency, p.phase, p.theta};
        for (int i = 0; i < m.n_legs; ++i) add_leg(m.legs[i], i, m);
    }
    add_constraints();
    complete_mass();

    std::vector<bool> placed(bodies_.size(), false);
    for (const Leg &leg : legs_) placed[leg.crank] = placed[leg.passive] = true;
    if (!legs_.empty()) placed[path_.body] = true;
    if (legs_.empty()) undriven_ = "there are no legs";
    for (std::size_t i = 0; i < bodies_.size(); ++i)
        if (undriven_.empty() && bodies_[i].size > 0 && !placed[i])
            undriven_ = named("body", static_cast<int>(i)) + " belongs to no leg";
}

void System::add_joint(const ls_joint &j, int number, const ls_mechanism &m) {
    const std::string name = named("joint", number);
    const Body &bearing = body_at(bodies_, j.bearing.body, name + ", bearing");
    const Body &journal = body_at(bodies_, j.journal.body, name + ", journal");
    require(j.bearing.body != j.journal.body, name + ": bearing and journal are on the same body");
    require(bearing.size + journal.size > 0, name + ": neither side can move");
    require(j.contact < m.n_contacts, name + ": there is no contact " + std::to_string(j.contact));
    Joint joint;
    joint.bearing = make_attachment(bearing, j.bearing, name + ", bearing");
    joint.journal = make_attachment(journal, j.journal, name + ", journal");
    joint.contact = j.contact < 0 ? -1 : j.contact;
    if (joint.contact >= 0) loose_.push_back(number);
    joints_.push_back(joint);
}

void System::add_leg(const ls_leg &l, int number, const ls_mechanism &m) {
    const std::string name = named("leg", number);
    for (int joint : {l.joint_a, l.joint_b, l.joint_c})
        require(joint >= 0 && joint < joints(), name + ": there is no joint " + std::to_string(joint));
    require(l.elbow == 1 || l.elbow == -1, name + ": elbow must be 1 or -1");
    const ls_joint &a = m.joints[l.joint_a], &b = m.joints[l.joint_b], &c = m.joints[l.joint_c];
    const int crank = a.journal.body, passive = b.journal.body;
    require(bodies_[a.bearing.body].kind == LS_GROUND, name + ": the bearing of joint A must be on ground");
    require(bodies_[crank].kind == LS_RIGID_LINK, name + ": the crank, journal of joint A, must be a rigid link");
    require(b.bearing.body == crank, name + ": the bearing of joint B must be on the crank");
    require(is_link(bodies_[passive]), name + ": the journal of joint B must be on a link");
    require(c.journal.body == passive, name + ": the journal of joint C must be on the passive link");
    require(c.bearing.body == m.path.body, name + ": the bearing of joint C must be on the driven body");
    const Joint &ja = joints_[l.joint_a], &jc = joints_[l.joint_c];
    require(b.bearing.x != a.journal.x, name + ": joints A and B are at the same end of the crank");
    require(c.journal.x != b.journal.x, name + ": joints B and C are at the same end of the passive link");
    for (const Leg &other : legs_)
        require(other.crank != crank && other.passive != passive, name + ": shares a link with another leg");
    legs_.push_back({crank, passive, ja.journal.end == 0, b.journal.x == 0.0, ja.bearing.point, jc.bearing.point,
                     bodies_[crank].length, bodies_[passive].length, l.elbow});
}

void System::add_constraints() {
    for (const Body &b : bodies_)
        if (b.kind == LS_RIGID_LINK) constraints_.push_back(length_constraint(b));
    for (Joint &j : joints_) {
        if (j.contact >= 0) continue;
        j.constraint = constraints();
        for (int axis : {0, 1}) constraints_.push_back(coincide_constraint(j.bearing, j.journal, axis));
    }
    first_drive_ = constraints();
    for (int i = 0; i < legs(); ++i)
        constraints_.push_back(drive_constraint(bodies_[legs_[i].crank], legs_[i].crank_from_start, i));
}

void System::complete_mass() {
    mass_ = MatrixXd::Zero(n_, n_);
    levers_ = VectorXd::Ones(n_);
    for (const Body &b : bodies_) {
        add_mass(b, mass_);
        if (b.kind == LS_RIGID_BODY) levers_[b.offset + 2] = b.lever;
        if (b.kind == LS_FLEXIBLE_LINK)
            for (int i = 0; i <= b.elements; ++i) levers_.segment<2>(b.offset + 4 * i + 2).setConstant(b.lever);
    }
    sparse_mass_ = mass_.sparseView();
    MatrixXd inverse = MatrixXd::Zero(n_, n_);
    for (const Body &b : bodies_)
        if (b.size > 0) {
            const auto block = mass_.block(b.offset, b.offset, b.size, b.size);
            inverse.block(b.offset, b.offset, b.size, b.size) = block.llt().solve(MatrixXd::Identity(b.size, b.size));
        }
    inverse_mass_ = inverse.sparseView();
}

std::vector<CrankAngle> System::crank_angles(double t) const {
    std::vector<CrankAngle> angles;
    const Jet time = time_jet(t);
    for (int i = 0; i < legs(); ++i) {
        const Jet phi = crank_angle(legs_[i], path_, time, i);
        angles.push_back({value_of(phi), rate_of(phi), acceleration_of(phi)});
    }
    return angles;
}

namespace {

void put(VectorXd &q, VectorXd &v, int i, const Vec<Jet> &x) {
    q[i] = value_of(x.x);
    q[i + 1] = value_of(x.y);
    v[i] = rate_of(x.x);
    v[i + 1] = rate_of(x.y);
}

// A link along the straight line from `start` to `end`.
void put_link(VectorXd &q, VectorXd &v, const Body &b, const Vec<Jet> &start, const Vec<Jet> &end) {
    if (b.kind == LS_RIGID_LINK) {
        put(q, v, b.offset, start);
        put(q, v, b.offset + 2, end);
        return;
    }
    const Vec<Jet> chord = end - start;
    const Jet inverse = 1.0 / sqrt(dot(chord, chord)); // of the length, exactly: unit slopes carry no strain
    for (int i = 0; i <= b.elements; ++i) {
        put(q, v, b.offset + 4 * i, start + Jet(static_cast<double>(i) / b.elements) * chord);
        put(q, v, b.offset + 4 * i + 2, inverse * chord);
    }
}

} // namespace

void System::start(double t, VectorXd &q, VectorXd &v) const {
    require(undriven_.empty(), "the start is undetermined: " + undriven_);
    q.setZero(n_);
    v.setZero(n_);
    const Jet time = time_jet(t);
    for (int i = 0; i < legs(); ++i) {
        const Leg &leg = legs_[i];
        const Jet phi = crank_angle(leg, path_, time, i);
        const Vec<Jet> a{Jet(leg.a.x), Jet(leg.a.y)};
        const Vec<Jet> b = a + Jet(leg.crank_length) * Vec<Jet>{cos(phi), sin(phi)};
        const Vec<Jet> c = path_point(path_, leg.c_on_body, time);
        put_link(q, v, bodies_[leg.crank], leg.crank_from_start ? a : b, leg.crank_from_start ? b : a);
        put_link(q, v, bodies_[leg.passive], leg.passive_from_start ? b : c, leg.passive_from_start ? c : b);
    }
    const int o = bodies_[path_.body].offset;
    put(q, v, o, path_centre(path_, time));
    q[o + 2] = path_.theta;
}

void System::force(const VectorXd &q, const VectorXd &v, const VectorXd &z, VectorXd &f) const {
    f.setZero(n_);
    for (const Body &b : bodies_)
        for (int e = 0; e < b.elements; ++e)
            f.segment<8>(b.offset + 4 * e) += element_force(b.element, q.data() + b.offset + 4 * e);
    for (int k : loose_) {
        if (z[k] <= 0.0) continue;
        const Joint &j = joints_[k];
        const LooseForces<double> l = loose(k, q, v, z[k]);
        for (int i = 0; i < j.bearing.size; ++i) f[j.bearing.offset + i] -= l.bearing[i];
        for (int i = 0; i < j.journal.size; ++i) f[j.journal.offset + i] -= l.journal[i];
    }
}

void System::force_derivatives(const VectorXd &q, const VectorXd &v, const VectorXd &z, MatrixXd &by_q,
                               MatrixXd &by_v) const {
    by_q.setZero(n_, n_);
    by_v.setZero(n_, n_);
    for (const Body &b : bodies_)
        for (int e = 0; e < b.elements; ++e) {
            const int o = b.offset + 4 * e;
            by_q.block<8, 8>(o, o) += element_tangent(b.element, q.data() + o);
        }

    // independent variables of a joint: q of the bearing, q of the journal, then v likewise
    using D = Dual<double, 4 * attachment_size>;
    for (int k : loose_) {
        if (z[k] <= 0.0) continue;
        const Joint &j = joints_[k];
        D qs[2][attachment_size], vs[2][attachment_size];
        const Attachment *side[2] = {&j.bearing, &j.journal};
        for (int s = 0; s < 2; ++s)
            for (int i = 0; i < side[s]->size; ++i) {
                const int variable = attachment_size * s + i;
                qs[s][i].value = q[side[s]->offset + i];
                qs[s][i].slope[variable] = 1.0;
                vs[s][i].value = v[side[s]->offset + i];
                vs[s][i].slope[2 * attachment_size + variable] = 1.0;
            }
        const LooseForces<D> l = loose_forces(law(k), z[k], j.bearing, j.journal, qs[0], vs[0], qs[1], vs[1]);
        const D *forces[2] = {l.bearing, l.journal};
        for (int r = 0; r < 2; ++r)
            for (int i = 0; i < side[r]->size; ++i)
                for (int c = 0; c < 2; ++c)
                    for (int m = 0; m < side[c]->size; ++m) {
                        const int variable = attachment_size * c + m;
                        by_q(side[r]->offset + i, side[c]->offset + m) -= forces[r][i].slope[variable];
                        by_v(side[r]->offset + i, side[c]->offset + m) -=
                            forces[r][i].slope[2 * attachment_size + variable];
                    }
    }
}

void System::constraint_rows(const std::vector<CrankAngle> &cranks, const VectorXd &q, VectorXd &phi, MatrixXd &phi_q,
                             VectorXd &phi_t) const {
    const int m = constraints();
    phi.resize(m);
    phi_t.resize(m);
    phi_q.setZero(m, n_);
    for (int k = 0; k < m; ++k) {
        const Constraint &c = constraints_[k];
        const bool drive = c.kind == Constraint::drive;
        const ConstraintRow r = evaluate(c, q, drive ? cranks[c.leg].angle : 0.0);
        phi[k] = r.value;
        phi_t[k] = drive ? r.by_angle * cranks[c.leg].rate : 0.0;
        for (int i = 0; i < c.size; ++i) phi_q(k, c.index[i]) = r.by_q[i];
    }
}

void System::reduce_mass(const MatrixXd &phi_q, MatrixXd &w, MatrixXd &s) const {
    const int m = constraints();
    w.setZero(n_, m);
    s.resize(m, m);
    for (int k = 0; k < m; ++k) {
        const Constraint &c = constraints_[k];
        for (int i = 0; i < c.size; ++i)
            for (Eigen::SparseMatrix<double>::InnerIterator entry(inverse_mass_, c.index[i]); entry; ++entry)
                w(entry.row(), k) += entry.value() * phi_q(k, c.index[i]);
    }
    for (int k = 0; k < m; ++k)
        for (int l = k; l < m; ++l) {
            const Constraint &c = constraints_[l];
            double sum = 0.0;
            for (int i = 0; i < c.size; ++i) sum += phi_q(l, c.index[i]) * w(c.index[i], k);
            s(k, l) = s(l, k) = sum;
        }
}

void System::convective(const std::vector<CrankAngle> &cranks, const VectorXd &q, const VectorXd &v,
                        VectorXd &gamma) const {
    gamma.resize(constraints());
    for (int k = 0; k < constraints(); ++k) {
        const Constraint &c = constraints_[k];
        gamma[k] = convective_acceleration(c, q, v, c.kind == Constraint::drive ? cranks[c.leg] : CrankAngle{});
    }
}

void System::constraint_derivatives(const std::vector<CrankAngle> &cranks, const VectorXd &q, const VectorXd &v,
                                    const VectorXd &lambda, MatrixXd &stiffness, MatrixXd &rate_by_q) const {
    rate_by_q.setZero(constraints(), n_);
    ConstraintHessian h;
    for (int k = 0; k < constraints(); ++k) {
        const Constraint &c = constraints_[k];
        if (c.linear) continue;
        const CrankAngle crank = c.kind == Constraint::drive ? cranks[c.leg] : CrankAngle{};
        hessian(c, q, crank.angle, h);
        for (int i = 0; i < c.size; ++i) {
            double rate = c.kind == Constraint::drive ? h(i, c.size) * crank.rate : 0.0;
            for (int j = 0; j < c.size; ++j) {
                stiffness(c.index[i], c.index[j]) += lambda[k] * h(i, j);
                rate += h(i, j) * v[c.index[j]];
            }
            rate_by_q(k, c.index[i]) = rate;
        }
    }
}

Gap System::gap(int k, const double *q, const double *v) const {
    const Joint &j = joints_[k];
    const double *qi = q + j.bearing.offset, *qj = q + j.journal.offset;
    const double *vi = v + j.bearing.offset, *vj = v + j.journal.offset;
    return {position(j.journal, qj) - position(j.bearing, qi),
            velocity(j.journal, qj, vj) - velocity(j.bearing, qi, vi), law(k).clearance};
}

LooseForces<double> System::loose(int k, const VectorXd &q, const VectorXd &v, double z) const {
    const Joint &j = joints_[k];
    return loose_forces<double>(law(k), z, j.bearing, j.journal, q.data() + j.bearing.offset,
                                v.data() + j.bearing.offset, q.data() + j.journal.offset, v.data() + j.journal.offset);
}

Energies System::energies(const VectorXd &q, const VectorXd &v, const VectorXd &z) const {
    Energies sum;
    sum.kinetic = 0.5 * v.dot(sparse_mass_ * v);
    for (const Body &b : bodies_)
        for (int e = 0; e < b.elements; ++e) {
            const ElasticEnergy u = element_energy(b.element, q.data() + b.offset + 4 * e);
            sum.axial += u.axial;
            sum.bending += u.bending;
        }
    for (int k : loose_) {
        const LooseForces<double> l = loose(k, q, v, z[k]);
        sum.contact += l.elastic_normal * l.delta / (law(k).exponent + 1.0);
    }
    return sum;
}

Powers System::powers(const std::vector<CrankAngle> &cranks, const VectorXd &q, const VectorXd &v, const VectorXd &z,
                      const VectorXd &lambda) const {
    Powers p;
    for (int i = 0; i < legs(); ++i) p.drive += torque(i, lambda) * cranks[i].rate;
    for (int k : loose_) {
        if (z[k] <= 0.0) continue;
        const LooseForces<double> l = loose(k, q, v, z[k]);
        const double lost = (l.normal - l.elastic_normal) * l.rate;
        p.contact_dissipated += lost;
        if (l.clamped) p.clamp += lost;
        p.friction_dissipated -= l.friction_power;
    }
    return p;
}

Vec<double> System::joint_force(int k, const VectorXd &q, const VectorXd &v, const VectorXd &z,
                                const VectorXd &lambda) const {
    const Joint &j = joints_[k];
    if (j.contact < 0) return {lambda[j.constraint], lambda[j.constraint + 1]};
    return loose(k, q, v, z[k]).on_journal;
}

// Forces, constraint rows and their derivatives, summed over the mechanism.
#include "damping.hpp"
#include "failure.hpp"
#include "system.hpp"

// Calls visit(bearing, journal, law) for everything that acts between two points.
template <class Visit>
void System::visit_pairs(const std::vector<Prescribed> &functions, const VectorXd &z, Visit visit) const {
    for (int k : loose_) {
        if (z[k] <= 0.0) continue;
        const Joint &j = joints_[k];
        const ContactLaw &contact = law(k);
        const double impact_velocity = z[k];
        visit(j.bearing, j.journal, [&](auto qi, auto vi, auto qj, auto vj) {
            return loose_forces(contact, impact_velocity, j.bearing, j.journal, qi, vi, qj, vj);
        });
    }
    for (const Spring &s : springs_)
        visit(s.from, s.to, [&s](auto qi, auto vi, auto qj, auto vj) { return spring_forces(s, qi, vi, qj, vj); });
    for (const TorsionSpring &s : torsion_springs_)
        visit(s.bearing, s.journal, [&s](auto qi, auto vi, auto qj, auto vj) { return spring_forces(s, qi, vi, qj, vj); });
    for (const Load &l : loads_) {
        const Vec<double> applied{functions[l.x].value, functions[l.y].value};
        visit(l.reaction, l.point, [&](auto qi, auto, auto qj, auto) { return load_forces(l, applied, qi, qj); });
    }
}

void System::force(const std::vector<Prescribed> &functions, const VectorXd &q, const VectorXd &v, const VectorXd &z,
                   VectorXd &f) const {
    f.setZero(n_);
    for (const Body &b : bodies_)
        for (int e = 0; e < b.elements; ++e) {
            const int o = b.offset + 4 * e;
            f.segment<8>(o) += element_force(b.element, q.data() + o);
            if (b.strain_damping > 0.0)
                f.segment<8>(o) += damping_force(b.element, b.strain_damping, q.data() + o, v.data() + o);
        }
    f.noalias() += mass_damping_ * v;
    f -= weight_;
    visit_pairs(functions, z, [&](const Attachment &bearing, const Attachment &journal, const auto &law) {
        subtract_forces(bearing, journal, law, q, v, f);
    });
}

void System::force_derivatives(const std::vector<Prescribed> &functions, const VectorXd &q, const VectorXd &v,
                               const VectorXd &z, MatrixXd &by_q, MatrixXd &by_v) const {
    by_q.setZero(n_, n_);
    by_v = mass_damping_;
    ElementMatrix damping_by_q, damping_by_v;
    for (const Body &b : bodies_)
        for (int e = 0; e < b.elements; ++e) {
            const int o = b.offset + 4 * e;
            by_q.block<8, 8>(o, o) += element_tangent(b.element, q.data() + o);
            if (b.strain_damping == 0.0) continue;
            damping_derivatives(b.element, b.strain_damping, q.data() + o, v.data() + o, damping_by_q, damping_by_v);
            by_q.block<8, 8>(o, o) += damping_by_q;
            by_v.block<8, 8>(o, o) += damping_by_v;
        }
    visit_pairs(functions, z, [&](const Attachment &bearing, const Attachment &journal, const auto &law) {
        subtract_derivatives(bearing, journal, law, q, v, by_q, by_v);
    });
}

Prescribed System::prescription(const Constraint &c, const Inputs &inputs) const {
    if (c.leg >= 0) return inputs.cranks[c.leg];
    return c.function >= 0 ? inputs.functions[c.function] : Prescribed{};
}

std::vector<Prescribed> System::functions(double t) const {
    std::vector<Prescribed> values;
    for (const TimeFunction &f : functions_) values.push_back(evaluate(f, t));
    return values;
}

void System::constraint_rows(const Inputs &inputs, const VectorXd &q, VectorXd &phi, MatrixXd &phi_q,
                             VectorXd &phi_t) const {
    const int m = constraints();
    phi.resize(m);
    phi_t.resize(m);
    phi_q.setZero(m, n_);
    for (int k = 0; k < m; ++k) {
        const Constraint &c = constraints_[k];
        const Prescribed given = prescription(c, inputs);
        const ConstraintRow r = evaluate(c, q, given.value);
        phi[k] = r.value;
        phi_t[k] = r.by_given * given.rate;
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
    for (const PrescribedCoordinate &p : prescribed_) s(p.row, p.row) = 1.0;
}

void System::convective(const Inputs &inputs, const VectorXd &q, const VectorXd &v,
                        VectorXd &gamma) const {
    gamma.resize(constraints());
    for (int k = 0; k < constraints(); ++k) {
        const Constraint &c = constraints_[k];
        gamma[k] = convective_acceleration(c, q, v, prescription(c, inputs));
    }
}

void System::constraint_derivatives(const Inputs &inputs, const VectorXd &q, const VectorXd &v,
                                    const VectorXd &lambda, MatrixXd &stiffness, MatrixXd &rate_by_q) const {
    rate_by_q.setZero(constraints(), n_);
    ConstraintHessian h;
    for (int k = 0; k < constraints(); ++k) {
        const Constraint &c = constraints_[k];
        if (c.linear) continue;
        const Prescribed given = prescription(c, inputs);
        hessian(c, q, given.value, h);
        for (int i = 0; i < c.size; ++i) {
            double rate = c.timed() ? h(i, c.size) * given.rate : 0.0;
            for (int j = 0; j < c.size; ++j) {
                stiffness(c.index[i], c.index[j]) += lambda[k] * h(i, j);
                rate += h(i, j) * v[c.index[j]];
            }
            rate_by_q(k, c.index[i]) = rate;
        }
    }
}

void System::check_angles(const Inputs &inputs, const VectorXd &q, double t) const {
    for (int k = 0; k < constraints(); ++k)
        if (!right_way_round(constraints_[k], q, given(constraints_[k], inputs)))
            throw Failure(LS_BAD_INPUT, row_names_[k] + ": the start is half a turn from the angle it must have", t);
}

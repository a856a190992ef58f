// Forces, rows and their derivatives, summed over the mechanism.
#include "damping.hpp"
#include "system.hpp"

namespace {

Vec<double> applied(const Load &load, const Inputs &inputs) {
    return {inputs.given[load.x].value, inputs.given[load.y].value};
}

void add_block(const ElementMatrix &block, int offset, Entries &entries) {
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 8; ++j) entries.emplace_back(offset + i, offset + j, block(i, j));
}

// A number in the scalar type of the variables.
template <class T>
T constant_like(const T *, double x) {
    return T(x);
}

} // namespace

// Calls visit(bearing, journal, law) for everything that acts between two points.
template <class Visit>
void System::visit_pairs(const Inputs &inputs, const Memory &memory, Visit visit) const {
    for (int k : loose_) {
        const double impact_velocity = memory.impact_velocity[k];
        if (impact_velocity <= 0.0) continue;
        const Joint &j = joints_[k];
        const double z = bristle(k, memory);
        visit(j.bearing, j.journal, [&j, impact_velocity, z](auto qi, auto vi, auto qj, auto vj) {
            return contact_forces(j, impact_velocity, constant_like(qi, z), qi, vi, qj, vj);
        });
    }
    for (const Spring &s : springs_)
        visit(s.from, s.to, [&s](auto qi, auto vi, auto qj, auto vj) { return spring_forces(s, qi, vi, qj, vj); });
    for (std::size_t i = 0; i < torsion_springs_.size(); ++i) {
        const TorsionSpring &s = torsion_springs_[i];
        const double near = memory.turn[static_cast<int>(i)];
        visit(s.bearing, s.journal,
              [&s, near](auto qi, auto vi, auto qj, auto vj) { return spring_forces(s, near, qi, vi, qj, vj); });
    }
    for (std::size_t i = 0; i < maxwells_.size(); ++i) {
        const Maxwell &m = maxwells_[i];
        const double z = memory.state[elongation(static_cast<int>(i))];
        visit(m.from, m.to,
              [&m, z](auto qi, auto, auto qj, auto) { return maxwell_forces(m, constant_like(qi, z), qi, qj); });
    }
    for (const Load &l : loads_)
        visit(l.reaction, l.point,
              [&](auto qi, auto, auto qj, auto) { return load_forces(l, applied(l, inputs), qi, qj); });
}

// Calls visit(number of the state, bearing, journal, law) for every internal state that is not constant.
template <class Visit>
void System::visit_states(const Memory &memory, Visit visit) const {
    for (int k : loose_) {
        const Joint &j = joints_[k];
        const double impact_velocity = memory.impact_velocity[k];
        if (j.bristle < 0 || impact_velocity <= 0.0) continue;
        visit(j.bristle, j.bearing, j.journal,
              [&j, impact_velocity](auto qi, auto vi, auto qj, auto vj, const auto &z) {
                  return contact_forces(j, impact_velocity, z, qi, vi, qj, vj);
              });
    }
    for (std::size_t i = 0; i < maxwells_.size(); ++i) {
        const Maxwell &m = maxwells_[i];
        visit(elongation(static_cast<int>(i)), m.from, m.to,
              [&m](auto qi, auto, auto qj, auto, const auto &z) { return maxwell_forces(m, z, qi, qj); });
    }
}

void System::force(const Inputs &inputs, const VectorXd &q, const VectorXd &v, const Memory &memory,
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
    f -= inputs.weight * weight_;
    visit_pairs(inputs, memory, [&](const Attachment &bearing, const Attachment &journal, const auto &law) {
        subtract_forces(bearing, journal, law, q, v, f);
    });
}

void System::force_derivatives(const Inputs &inputs, const VectorXd &q, const VectorXd &v, const Memory &memory,
                               Entries &by_q, Entries &by_v) const {
    ElementMatrix damping_by_q, damping_by_v;
    for (const Body &b : bodies_)
        for (int e = 0; e < b.elements; ++e) {
            const int o = b.offset + 4 * e;
            add_block(element_tangent(b.element, q.data() + o), o, by_q);
            if (b.strain_damping == 0.0) continue;
            damping_derivatives(b.element, b.strain_damping, q.data() + o, v.data() + o, damping_by_q, damping_by_v);
            add_block(damping_by_q, o, by_q);
            add_block(damping_by_v, o, by_v);
        }
    for (int column = 0; column < n_; ++column)
        for (SparseMatrix::InnerIterator entry(mass_damping_, column); entry; ++entry)
            by_v.emplace_back(static_cast<int>(entry.row()), column, entry.value());
    visit_pairs(inputs, memory, [&](const Attachment &bearing, const Attachment &journal, const auto &law) {
        subtract_derivatives(bearing, journal, law, q, v, by_q, by_v);
    });
}

void System::load_rates(const Inputs &inputs, const VectorXd &q, VectorXd &rates) const {
    rates = -inputs.weight_rate * weight_;
    const VectorXd rest = VectorXd::Zero(n_);
    for (const Load &l : loads_) {
        const Vec<double> rate{inputs.given[l.x].rate, inputs.given[l.y].rate};
        subtract_forces(l.reaction, l.point,
                        [&](auto qi, auto, auto qj, auto) { return load_forces(l, rate, qi, qj); }, q, rest, rates);
    }
}

void System::state_rates(const VectorXd &q, const VectorXd &v, const Memory &memory, VectorXd &rates) const {
    rates.setZero(states());
    visit_states(memory, [&](int number, const Attachment &bearing, const Attachment &journal, const auto &law) {
        const double z = memory.state[number];
        const auto at_z = [&law, z](auto qi, auto vi, auto qj, auto vj) { return law(qi, vi, qj, vj, z); };
        rates[number] = forces_of(bearing, journal, at_z, q, v).state_rate;
    });
}

void System::state_derivatives(const VectorXd &q, const VectorXd &v, const Memory &memory, StateDerivatives &out) const {
    visit_states(memory, [&](int number, const Attachment &bearing, const Attachment &journal, const auto &law) {
        append_state_derivatives(bearing, journal, law, number, memory.state[number], q, v, out);
    });
}

Prescribed System::prescription(const Constraint &c, const Inputs &inputs) const {
    return c.timed() ? inputs.given[c.given] : Prescribed{};
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
            for (SparseMatrix::InnerIterator entry(inverse_mass_, c.index[i]); entry; ++entry)
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
                                    const VectorXd &lambda, Entries &stiffness, Entries &rate_by_q) const {
    ConstraintHessian h;
    for (int k = 0; k < constraints(); ++k) {
        const Constraint &c = constraints_[k];
        if (c.linear) continue;
        const Prescribed given = prescription(c, inputs);
        hessian(c, q, given.value, h);
        for (int i = 0; i < c.size; ++i) {
            double rate = c.timed() ? h(i, c.size) * given.rate : 0.0;
            for (int j = 0; j < c.size; ++j) {
                stiffness.emplace_back(c.index[i], c.index[j], lambda[k] * h(i, j));
                rate += h(i, j) * v[c.index[j]];
            }
            rate_by_q.emplace_back(k, c.index[i], rate);
        }
    }
}

void System::check_angles(const Inputs &inputs, const VectorXd &q) const {
    for (int k = 0; k < constraints(); ++k)
        if (!right_way_round(constraints_[k], q, prescription(constraints_[k], inputs).value))
            refuse(row_sources_[k], row_names_[k] + ": the start is half a turn from the angle it must have");
}

// Forces between two points of bodies, and their derivatives by automatic differentiation.
//
// A law is a callable (qi, vi, qj, vj) for pointers to any scalar T that returns something with the arrays `bearing` and
// `journal` of the generalised forces on the coordinates of either point. A law with an internal state is a callable
// (qi, vi, qj, vj, state), and `state_rate` is the rate of its state.
#pragma once

#include <Eigen/Dense>

#include "bodies.hpp"

template <class T>
struct PairForces {
    T bearing[attachment_size]{}, journal[attachment_size]{};
    T state_rate{};
};

// Their power.
template <class Forces>
double power(const Attachment &bearing, const Attachment &journal, const Forces &forces, const Eigen::VectorXd &v) {
    double sum = 0.0;
    for (int i = 0; i < bearing.size; ++i) sum += forces.bearing[i] * v[bearing.offset + i];
    for (int i = 0; i < journal.size; ++i) sum += forces.journal[i] * v[journal.offset + i];
    return sum;
}

template <class Law>
auto forces_of(const Attachment &bearing, const Attachment &journal, const Law &law, const Eigen::VectorXd &q,
               const Eigen::VectorXd &v) {
    return law(q.data() + bearing.offset, v.data() + bearing.offset, q.data() + journal.offset, v.data() + journal.offset);
}

// f stands on the left-hand side of the equations of motion: the forces are subtracted.
template <class Law>
void subtract_forces(const Attachment &bearing, const Attachment &journal, const Law &law, const Eigen::VectorXd &q,
                     const Eigen::VectorXd &v, Eigen::VectorXd &f) {
    const auto forces = forces_of(bearing, journal, law, q, v);
    for (int i = 0; i < bearing.size; ++i) f[bearing.offset + i] -= forces.bearing[i];
    for (int i = 0; i < journal.size; ++i) f[journal.offset + i] -= forces.journal[i];
}

// The coordinates of both points as independent variables: q of the bearing, q of the journal, then v likewise.
template <class D>
struct PairVariables {
    D q[2][attachment_size], v[2][attachment_size];

    PairVariables(const Attachment &bearing, const Attachment &journal, const Eigen::VectorXd &qs, const Eigen::VectorXd &vs) {
        const Attachment *side[2] = {&bearing, &journal};
        for (int s = 0; s < 2; ++s)
            for (int i = 0; i < side[s]->size; ++i) {
                const int variable = attachment_size * s + i;
                q[s][i].value = qs[side[s]->offset + i];
                q[s][i].slope[variable] = 1.0;
                v[s][i].value = vs[side[s]->offset + i];
                v[s][i].slope[2 * attachment_size + variable] = 1.0;
            }
    }
    const D *qi() const { return q[0]; }
    const D *vi() const { return v[0]; }
    const D *qj() const { return q[1]; }
    const D *vj() const { return v[1]; }
};

template <class Law>
void subtract_derivatives(const Attachment &bearing, const Attachment &journal, const Law &law, const Eigen::VectorXd &q,
                          const Eigen::VectorXd &v, Entries &by_q, Entries &by_v) {
    using D = Dual<double, 4 * attachment_size>;
    const PairVariables<D> x(bearing, journal, q, v);
    const auto l = law(x.qi(), x.vi(), x.qj(), x.vj());
    const Attachment *side[2] = {&bearing, &journal};
    const D *forces[2] = {l.bearing, l.journal};
    for (int r = 0; r < 2; ++r)
        for (int i = 0; i < side[r]->size; ++i)
            for (int c = 0; c < 2; ++c)
                for (int m = 0; m < side[c]->size; ++m) {
                    const int variable = attachment_size * c + m;
                    const int row = side[r]->offset + i, column = side[c]->offset + m;
                    by_q.emplace_back(row, column, -forces[r][i].slope[variable]);
                    by_v.emplace_back(row, column, -forces[r][i].slope[2 * attachment_size + variable]);
                }
}

// Derivatives that internal states x add to those by q and v, with x' = g(q, v, x).
struct StateDerivatives {
    Entries rate_by_q, rate_by_v, rate_by_state, force_by_state; // of g, states x ...; of f, n x states
};

// Of the law with the state `number`; f stands on the left-hand side.
template <class Law>
void append_state_derivatives(const Attachment &bearing, const Attachment &journal, const Law &law, int number, double state,
                              const Eigen::VectorXd &q, const Eigen::VectorXd &v, StateDerivatives &out) {
    constexpr int own = 4 * attachment_size; // the state comes after all coordinates
    using D = Dual<double, own + 1>;
    const PairVariables<D> x(bearing, journal, q, v);
    D z(state);
    z.slope[own] = 1.0;
    const auto l = law(x.qi(), x.vi(), x.qj(), x.vj(), z);
    const Attachment *side[2] = {&bearing, &journal};
    const D *forces[2] = {l.bearing, l.journal};
    for (int s = 0; s < 2; ++s)
        for (int i = 0; i < side[s]->size; ++i) {
            const int variable = attachment_size * s + i, coordinate = side[s]->offset + i;
            out.rate_by_q.emplace_back(number, coordinate, l.state_rate.slope[variable]);
            out.rate_by_v.emplace_back(number, coordinate, l.state_rate.slope[2 * attachment_size + variable]);
            out.force_by_state.emplace_back(coordinate, number, -forces[s][i].slope[own]);
        }
    out.rate_by_state.emplace_back(number, number, l.state_rate.slope[own]);
}

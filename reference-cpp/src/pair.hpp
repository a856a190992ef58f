// Forces between two points of bodies, and their derivatives by automatic differentiation.
//
// A law is a callable (qi, vi, qj, vj) for pointers to any scalar T that returns something with the arrays `bearing` and
// `journal` of the generalised forces on the coordinates of either point.
#pragma once

#include <Eigen/Dense>

#include "bodies.hpp"

template <class T>
struct PairForces {
    T bearing[attachment_size]{}, journal[attachment_size]{};
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

template <class Law>
void subtract_derivatives(const Attachment &bearing, const Attachment &journal, const Law &law, const Eigen::VectorXd &q,
                          const Eigen::VectorXd &v, Entries &by_q, Entries &by_v) {
    // independent variables: q of the bearing, q of the journal, then v likewise
    using D = Dual<double, 4 * attachment_size>;
    D qs[2][attachment_size], vs[2][attachment_size];
    const Attachment *side[2] = {&bearing, &journal};
    for (int s = 0; s < 2; ++s)
        for (int i = 0; i < side[s]->size; ++i) {
            const int variable = attachment_size * s + i;
            qs[s][i].value = q[side[s]->offset + i];
            qs[s][i].slope[variable] = 1.0;
            vs[s][i].value = v[side[s]->offset + i];
            vs[s][i].slope[2 * attachment_size + variable] = 1.0;
        }
    const D *qi = qs[0], *vi = vs[0], *qj = qs[1], *vj = vs[1];
    const auto l = law(qi, vi, qj, vj);
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

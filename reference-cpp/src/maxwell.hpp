// A spring and a damper in series between two points. The elongation z of the damper is an unknown of its own, with
// c dz/dt = N = k (L - L_0 - z).
#pragma once

#include "failure.hpp"
#include "pair.hpp"

struct Maxwell {
    std::string name;
    Attachment from, to;
    double stiffness, damping, rest_length;
};

// From one point to the other; its length must not vanish.
template <class T>
Vec<T> line_of(const Maxwell &m, const T *qi, const T *qj) {
    const Vec<T> e = position(m.to, qj) - position(m.from, qi);
    if (!(value_of(dot(e, e)) > 0.0))
        throw Failure(LS_NOT_FINITE, m.name + ": its ends meet, its force has no direction");
    return e;
}

template <class T>
T length_of(const Vec<T> &e) {
    using std::sqrt;
    return sqrt(dot(e, e));
}

template <class T>
PairForces<T> maxwell_forces(const Maxwell &m, double z, const T *qi, const T *qj) {
    const Vec<T> e = line_of(m, qi, qj);
    const T length = length_of(e);
    const Vec<T> force = (m.stiffness * (length - m.rest_length - z) / length) * e;
    PairForces<T> out;
    add_force(m.from, qi, force, out.bearing);
    add_force(m.to, qj, -force, out.journal);
    return out;
}

// N, tension positive
inline double pull(const Maxwell &m, double z, const Eigen::VectorXd &q) {
    return m.stiffness * (length_of(line_of(m, q.data() + m.from.offset, q.data() + m.to.offset)) - m.rest_length - z);
}

inline double energy(const Maxwell &m, double z, const Eigen::VectorXd &q) {
    const double force = pull(m, z, q);
    return 0.5 * force * force / m.stiffness;
}

// Power that the damper takes.
inline double loss(const Maxwell &m, double z, const Eigen::VectorXd &q) {
    const double force = pull(m, z, q);
    return force * force / m.damping;
}

// dL/dq, as entries of one row.
inline void append_length_derivatives(const Maxwell &m, int row, const Eigen::VectorXd &q, Entries &by_q) {
    using D = Dual<double, 2 * attachment_size>;
    D u[2][attachment_size];
    const Attachment *end[2] = {&m.from, &m.to};
    for (int s = 0; s < 2; ++s)
        for (int i = 0; i < end[s]->size; ++i) {
            u[s][i].value = q[end[s]->offset + i];
            u[s][i].slope[attachment_size * s + i] = 1.0;
        }
    const D *qi = u[0], *qj = u[1];
    const D length = length_of(line_of(m, qi, qj));
    for (int s = 0; s < 2; ++s)
        for (int i = 0; i < end[s]->size; ++i)
            by_q.emplace_back(row, end[s]->offset + i, length.slope[attachment_size * s + i]);
}

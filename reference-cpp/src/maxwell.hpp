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

// The forces and dz/dt.
template <class T>
PairForces<T> maxwell_forces(const Maxwell &m, const T &z, const T *qi, const T *qj) {
    const Vec<T> e = line_of(m, qi, qj);
    const T length = length_of(e);
    const T pull = m.stiffness * (length - m.rest_length - z);
    const Vec<T> force = (pull / length) * e;
    PairForces<T> out;
    add_force(m.from, qi, force, out.bearing);
    add_force(m.to, qj, -force, out.journal);
    out.state_rate = pull / m.damping;
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

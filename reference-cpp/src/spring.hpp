// Springs and dampers between two points, and on the angle of a revolute joint.
#pragma once

#include "failure.hpp"
#include "pair.hpp"

struct Spring {
    std::string name;
    Attachment from, to;
    double stiffness, damping, rest_length;

    // Without rest length and damping the force is linear in the vector between the points, which may then vanish.
    bool is_linear() const { return rest_length == 0.0 && damping == 0.0; }
};

struct TorsionSpring {
    std::string name;
    Attachment bearing, journal;
    double stiffness, damping, rest_angle;
    double start; // an angle phi - phi_0 within half a turn of that at t = 0
};

template <class T>
struct SpringState {
    Vec<T> e;      // from one point to the other
    Vec<T> n;      // its direction
    T length{}, rate{};
};

template <class T>
SpringState<T> state_of(const Spring &s, const T *qi, const T *vi, const T *qj, const T *vj) {
    using std::sqrt;
    SpringState<T> x;
    x.e = position(s.to, qj) - position(s.from, qi);
    if (s.is_linear()) return x;
    const T square = dot(x.e, x.e);
    if (!(value_of(square) > 0.0))
        throw Failure(LS_NOT_FINITE, s.name + ": its ends meet, its force has no direction");
    x.length = sqrt(square);
    x.n = (1.0 / x.length) * x.e;
    x.rate = dot(x.n, velocity(s.to, qj, vj) - velocity(s.from, qi, vi));
    return x;
}

template <class T>
PairForces<T> spring_forces(const Spring &s, const T *qi, const T *vi, const T *qj, const T *vj) {
    const SpringState<T> x = state_of(s, qi, vi, qj, vj);
    const Vec<T> pull =
        s.is_linear() ? T(s.stiffness) * x.e : T(s.stiffness * (x.length - s.rest_length) + s.damping * x.rate) * x.n;
    PairForces<T> out;
    add_force(s.from, qi, pull, out.bearing);
    add_force(s.to, qj, -pull, out.journal);
    return out;
}

inline double energy(const Spring &s, const Eigen::VectorXd &q) {
    const Vec<double> e = position(s.to, q.data() + s.to.offset) - position(s.from, q.data() + s.from.offset);
    const double stretch = std::sqrt(dot(e, e)) - s.rest_length;
    return 0.5 * s.stiffness * stretch * stretch;
}

// Power that the damper takes.
inline double loss(const Spring &s, const Eigen::VectorXd &q, const Eigen::VectorXd &v) {
    if (s.damping == 0.0) return 0.0;
    const SpringState<double> x = state_of(s, q.data() + s.from.offset, v.data() + s.from.offset,
                                           q.data() + s.to.offset, v.data() + s.to.offset);
    return s.damping * x.rate * x.rate;
}

// phi - phi_0 within half a turn of `near`: the angle from R(phi_0 + near) d_1 to d_2 tells what is missing.
template <class T>
T deviation(const TorsionSpring &s, double near, const T *qi, const T *qj) {
    using std::atan2;
    const Vec<T> there = rotated(direction(s.bearing, qi), T(s.rest_angle + near)), d = direction(s.journal, qj);
    return near + atan2(cross(there, d), dot(there, d));
}

template <class T>
T rate(const TorsionSpring &s, const T *qi, const T *vi, const T *qj, const T *vj) {
    return spin(s.journal, qj, vj) - spin(s.bearing, qi, vi);
}

template <class T>
PairForces<T> spring_forces(const TorsionSpring &s, double near, const T *qi, const T *vi, const T *qj, const T *vj) {
    const T torque = s.stiffness * deviation(s, near, qi, qj) + s.damping * rate(s, qi, vi, qj, vj);
    PairForces<T> out;
    add_couple(s.bearing, qi, torque, out.bearing);
    add_couple(s.journal, qj, -torque, out.journal);
    return out;
}

inline double deviation(const TorsionSpring &s, double near, const Eigen::VectorXd &q) {
    return deviation(s, near, q.data() + s.bearing.offset, q.data() + s.journal.offset);
}

inline double rate(const TorsionSpring &s, const Eigen::VectorXd &q, const Eigen::VectorXd &v) {
    return rate(s, q.data() + s.bearing.offset, v.data() + s.bearing.offset, q.data() + s.journal.offset,
                v.data() + s.journal.offset);
}

inline double energy(const TorsionSpring &s, double near, const Eigen::VectorXd &q) {
    const double angle = deviation(s, near, q);
    return 0.5 * s.stiffness * angle * angle;
}

inline double loss(const TorsionSpring &s, const Eigen::VectorXd &q, const Eigen::VectorXd &v) {
    const double speed = rate(s, q, v);
    return s.damping * speed * speed;
}

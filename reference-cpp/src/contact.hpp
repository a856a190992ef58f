// Force laws of a loose joint: eqs. 24-26.
#pragma once

#include <cmath>

#include "dual.hpp"

struct ContactLaw {
    double bearing_radius, clearance; // radius 0: not given, a loose guide does not need it
    double stiffness; // K
    double exponent;  // n
    double damping;   // chi
    double impact_velocity_floor;
    bool friction, material_slip;
    double friction_coefficient, friction_v0, friction_v1;

    bool has_radii() const { return bearing_radius > 0.0; }
    double journal_radius() const { return bearing_radius - clearance; }
};

// 1 + chi delta_rate / impact_velocity: the law would pull where it is negative
template <class T>
T bracket(const ContactLaw &law, const T &rate, double impact_velocity) {
    return 1.0 + law.damping / impact_velocity * rate;
}

// Eq. 24 for delta > 0, never below zero.
template <class T>
T normal_force(const ContactLaw &law, const T &delta, const T &rate, double impact_velocity) {
    using std::pow;
    const T factor = bracket(law, rate, impact_velocity);
    if (value_of(factor) < 0.0) return T(0.0);
    return law.stiffness * pow(delta, law.exponent) * factor;
}

// c_f c_d F_n sign(v_t) of eq. 26, made odd in v_t: the friction force is minus this along the direction of slip.
template <class T>
T friction_resistance(const ContactLaw &law, const T &slip, const T &normal) {
    const double speed = std::abs(value_of(slip));
    const double sign = value_of(slip) < 0.0 ? -1.0 : 1.0;
    if (speed <= law.friction_v0) return T(0.0);
    if (speed >= law.friction_v1) return sign * law.friction_coefficient * normal;
    return law.friction_coefficient / (law.friction_v1 - law.friction_v0) * (slip - sign * law.friction_v0) * normal;
}

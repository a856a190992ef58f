// The law of a loose joint: its normal force, eqs. 24 and 25, and its friction.
#pragma once

#include <cmath>

#include "friction.hpp"

struct ContactLaw {
    double bearing_radius, clearance; // radius 0: not given, a loose guide does not need it
    double stiffness; // K
    double exponent;  // n
    double damping;   // chi
    double impact_velocity_floor;
    FrictionLaw friction;

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

// Friction of a contact: eq. 26 and the other laws of EQUATIONS.md, "Friction".
//
// Every law gives T / F_n, which has the sign of the slip v: the tangential force opposes the slip, in proportion to the
// normal force F_n. Laws with bristles have an internal state beside it, their deflection z, and its rate z'.
#pragma once

#include <cmath>

#include "dual.hpp"

enum class FrictionKind { none, ambrosio, coulomb_stribeck, lugre, elasto_plastic };

struct FrictionLaw {
    FrictionKind kind = FrictionKind::none;
    bool material_slip = true;
    double coefficient = 0.0, v0 = 0.0, v1 = 0.0; // ambrosio
    double mu_c = 0.0, mu_s = 0.0, v_s = 0.0;     // all others
    double v_r = 0.0;                             // coulomb_stribeck
    double s0 = 0.0, s1 = 0.0;                    // bristles: stiffness and damping, divided by F_n
    double v_d = 0.0;                             // the slip over which s1 falls; 0: s1 is constant
    double s2 = 0.0;                              // all but ambrosio
    double breakaway = 0.0;                       // elasto_plastic

    bool acts() const { return kind != FrictionKind::none; }
    bool has_bristles() const { return kind == FrictionKind::lugre || kind == FrictionKind::elasto_plastic; }
    // of the bristles, divided by F_n
    double stored(double bristle) const { return 0.5 * s0 * bristle * bristle; }
};

template <class T>
struct Friction {
    T coefficient{};  // T / F_n
    T bristle_rate{}; // z'
};

// c_f c_d sign(v_t) of eq. 26, made odd in v_t.
template <class T>
T ambrosio(const FrictionLaw &law, const T &slip) {
    const double speed = std::abs(value_of(slip)), sign = value_of(slip) < 0.0 ? -1.0 : 1.0;
    if (speed <= law.v0) return T(0.0);
    if (speed >= law.v1) return T(sign * law.coefficient);
    return law.coefficient / (law.v1 - law.v0) * (slip - sign * law.v0);
}

// exp(-(v / scale)^2)
template <class T>
T bell(const T &slip, double scale) {
    using std::exp;
    const T ratio = slip / scale;
    return exp(-(ratio * ratio));
}

// g(v), which falls from the static to the kinetic coefficient
template <class T>
T stribeck(const FrictionLaw &law, const T &slip) {
    return law.mu_c + (law.mu_s - law.mu_c) * bell(slip, law.v_s);
}

template <class T>
T coulomb_stribeck(const FrictionLaw &law, const T &slip) {
    using std::tanh;
    return stribeck(law, slip) * tanh(slip / law.v_r) + law.s2 * slip;
}

// alpha, the part of the slip that slides over bristles at their steady deflection: 0 while they are springs
template <class T>
T sliding_part(const FrictionLaw &law, const T &slip, const T &bristle, const T &g) {
    using std::sin;
    constexpr double pi = 3.14159265358979323846;
    if (law.kind == FrictionKind::lugre) return T(1.0);
    const double elastic = law.breakaway * law.mu_c / law.s0;       // z_ba
    const T steady = g / law.s0;                                    // z_ss
    const T deflection = value_of(bristle) < 0.0 ? T(-bristle) : bristle;
    const bool returns = value_of(bristle) * value_of(slip) <= 0.0;
    if (returns || value_of(deflection) <= elastic) return T(0.0);
    if (value_of(deflection) >= value_of(steady)) return T(1.0);
    return 0.5 + 0.5 * sin(pi * (deflection - 0.5 * (steady + elastic)) / (steady - elastic));
}

template <class T>
Friction<T> with_bristles(const FrictionLaw &law, const T &slip, const T &bristle) {
    const T g = stribeck(law, slip);
    const T speed = value_of(slip) < 0.0 ? T(-slip) : slip;
    const T damping = law.v_d > 0.0 ? T(law.s1 * bell(slip, law.v_d)) : T(law.s1);
    Friction<T> out;
    out.bristle_rate = slip - law.s0 * sliding_part(law, slip, bristle, g) * speed * bristle / g;
    out.coefficient = law.s0 * bristle + damping * out.bristle_rate + law.s2 * slip;
    return out;
}

template <class T>
Friction<T> friction_at(const FrictionLaw &law, const T &slip, const T &bristle) {
    Friction<T> out;
    if (law.has_bristles()) return with_bristles(law, slip, bristle);
    if (law.kind == FrictionKind::ambrosio) out.coefficient = ambrosio(law, slip);
    if (law.kind == FrictionKind::coulomb_stribeck) out.coefficient = coulomb_stribeck(law, slip);
    return out;
}

// A revolute joint with clearance, eqs. 19-26.
#pragma once

#include "contact.hpp"
#include "pair.hpp"

// What the joint does at one instant; T is double or a Dual.
template <class T>
struct LooseForces : PairForces<T> {
    Vec<T> on_journal;            // resultant on the journal side
    T elastic_normal{}, normal{}; // K delta^n, F_n
    T delta{}, rate{};            // penetration and its rate
    T friction_power{};           // power of the tangential forces, <= 0 for a loss
    bool clamped = false;
};

// Forces of a closed contact (impact velocity z > 0); all zero when z = 0 or delta <= 0.
template <class T>
LooseForces<T> loose_forces(const ContactLaw &law, double z, const Attachment &bearing, const Attachment &journal,
                            const T *qi, const T *vi, const T *qj, const T *vj) {
    using std::pow;
    using std::sqrt;
    LooseForces<T> out;
    if (z <= 0.0) return out;
    const Vec<T> e = position(journal, qj) - position(bearing, qi); // eq. 19
    const T square = dot(e, e);
    if (value_of(square) <= law.clearance * law.clearance) return out;
    const T size = sqrt(square);
    const Vec<T> n = (1.0 / size) * e; // eq. 20
    const Vec<T> t = turned(n);
    const Vec<T> e_dot = velocity(journal, qj, vj) - velocity(bearing, qi, vi);
    out.delta = size - law.clearance; // eq. 21
    out.rate = dot(e_dot, n);
    if (value_of(out.delta) <= 0.0) return out;
    out.elastic_normal = law.stiffness * pow(out.delta, law.exponent);
    out.normal = normal_force(law, out.delta, out.rate, z);
    out.clamped = value_of(bracket(law, out.rate, z)) < 0.0;
    out.on_journal = -(out.normal * n);

    if (law.friction) {
        const T sliding = dot(e_dot, t);
        if (law.material_slip) {
            // slip of the surfaces; the couples are conjugate to the spins in it
            const T slip = sliding + law.journal_radius() * spin(journal, qj, vj) -
                           law.bearing_radius * spin(bearing, qi, vi);
            const T resistance = friction_resistance(law, slip, out.normal);
            out.on_journal = out.on_journal - resistance * t;
            add_couple(journal, qj, -law.journal_radius() * resistance, out.journal);
            add_couple(bearing, qi, law.bearing_radius * resistance, out.bearing);
            out.friction_power = -resistance * slip;
        } else {
            // eqs. 22, 23 as printed: the contact points move with R_k dn/dt
            const T slip = sliding * out.delta / size;
            const T resistance = friction_resistance(law, slip, out.normal);
            out.on_journal = out.on_journal - resistance * t;
            // the force acts on the centres, so its power is with their velocity, not with the slip
            out.friction_power = -resistance * sliding;
        }
    }
    add_force(journal, qj, out.on_journal, out.journal);
    add_force(bearing, qi, -out.on_journal, out.bearing);
    return out;
}

// A revolute joint with clearance, eqs. 19-26.
#pragma once

#include "contact.hpp"
#include "pair.hpp"

// What the joint does at one instant; T is double or a Dual. Its internal state is the deflection of bristles.
template <class T>
struct LooseForces : PairForces<T> {
    Vec<T> on_journal;            // resultant on the journal side
    T elastic_normal{}, normal{}; // K delta^n, F_n
    T delta{}, rate{};            // penetration and its rate
    T friction_power{};           // power of the tangential forces, <= 0 for a loss
    bool clamped = false;
};

// The normal force at out.delta > 0 and out.rate.
template <class T>
void set_normal_force(const ContactLaw &law, double impact_velocity, LooseForces<T> &out) {
    using std::pow;
    out.elastic_normal = law.stiffness * pow(out.delta, law.exponent);
    out.normal = normal_force(law, out.delta, out.rate, impact_velocity);
    out.clamped = value_of(bracket(law, out.rate, impact_velocity)) < 0.0;
}

// Forces of a closed contact (impact velocity > 0), and the rate of its bristles; all zero while it is open. Without
// penetration a contact that is still closed has no force, but its bristles move on: IDA looks beyond the loss of contact.
template <class T>
LooseForces<T> loose_forces(const ContactLaw &law, double impact_velocity, const T &bristle, const Attachment &bearing,
                            const Attachment &journal, const T *qi, const T *vi, const T *qj, const T *vj) {
    using std::sqrt;
    LooseForces<T> out;
    if (impact_velocity <= 0.0) return out;
    const Vec<T> e = position(journal, qj) - position(bearing, qi); // eq. 19
    const T square = dot(e, e);
    if (!(value_of(square) > 0.0)) return out;
    const T size = sqrt(square);
    const Vec<T> n = (1.0 / size) * e; // eq. 20
    const Vec<T> t = turned(n);
    const Vec<T> e_dot = velocity(journal, qj, vj) - velocity(bearing, qi, vi);
    out.delta = size - law.clearance; // eq. 21
    out.rate = dot(e_dot, n);
    const bool touches = value_of(out.delta) > 0.0;
    if (touches) {
        set_normal_force(law, impact_velocity, out);
        out.on_journal = -(out.normal * n);
    }
    if (law.friction.acts()) {
        const T sliding = dot(e_dot, t);
        const bool material = law.friction.material_slip;
        // slip of the surfaces, or eqs. 22, 23 as printed: the contact points move with R_k dn/dt
        const T slip = material ? T(sliding + law.journal_radius() * spin(journal, qj, vj) -
                                    law.bearing_radius * spin(bearing, qi, vi))
                                : T(sliding * out.delta / size);
        const Friction<T> friction = friction_at(law.friction, slip, bristle);
        out.state_rate = friction.bristle_rate;
        const T resistance = friction.coefficient * out.normal;
        out.on_journal = out.on_journal - resistance * t;
        if (material) { // the couples are conjugate to the spins in the slip
            add_couple(journal, qj, -law.journal_radius() * resistance, out.journal);
            add_couple(bearing, qi, law.bearing_radius * resistance, out.bearing);
        }
        // as printed the force acts on the centres, so its power is with their velocity, not with the slip
        out.friction_power = -resistance * (material ? slip : sliding);
    }
    add_force(journal, qj, out.on_journal, out.journal);
    add_force(bearing, qi, -out.on_journal, out.bearing);
    return out;
}

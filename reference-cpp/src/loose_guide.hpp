// A pin of one body between two parallel walls of another.
#pragma once

#include "loose_joint.hpp"

// The pin as seen from the guide.
template <class T>
struct GuideMotion {
    Vec<T> e;        // from the guide's point to the pin
    Vec<T> u, m;     // along the guide and across it
    T s{}, s_rate{}; // offset from the centre line, along m
    T slip{};        // velocity of the pin along u, relative to the guide's body
    T spin{};        // of the guide's body
};

template <class T>
GuideMotion<T> guide_motion(double angle, const Attachment &guide, const Attachment &slider, const T *qi, const T *vi,
                            const T *qj, const T *vj) {
    using std::sqrt;
    GuideMotion<T> x;
    const Vec<T> line = rotated(direction(guide, qi), T(angle));
    x.u = (1.0 / sqrt(dot(line, line))) * line; // a slope may be stretched
    x.m = turned(x.u);
    x.spin = spin(guide, qi, vi);
    x.e = position(slider, qj) - position(guide, qi);
    const Vec<T> relative = velocity(slider, qj, vj) - velocity(guide, qi, vi) - x.spin * turned(x.e);
    x.s = dot(x.m, x.e);
    x.s_rate = dot(x.m, relative);
    x.slip = dot(x.u, relative);
    return x;
}

// Forces of a closed contact (impact velocity > 0), and the rate of its bristles, as those of a loose joint. The journal is
// the slider.
template <class T>
LooseForces<T> guide_forces(const ContactLaw &law, double impact_velocity, const T &bristle, double angle,
                            const Attachment &guide, const Attachment &slider, const T *qi, const T *vi, const T *qj,
                            const T *vj) {
    LooseForces<T> out;
    if (impact_velocity <= 0.0) return out;
    const GuideMotion<T> x = guide_motion(angle, guide, slider, qi, vi, qj, vj);
    const double side = value_of(x.s) < 0.0 ? -1.0 : 1.0;
    out.delta = side * x.s - law.clearance;
    out.rate = side * x.s_rate;
    const Friction<T> friction = friction_at(law.friction, x.slip, bristle);
    out.state_rate = friction.bristle_rate;
    if (value_of(out.delta) <= 0.0) return out;
    set_normal_force(law, impact_velocity, out);
    const T resistance = friction.coefficient * out.normal;
    out.on_journal = -(side * out.normal * x.m) - resistance * x.u;
    out.friction_power = -resistance * x.slip;
    add_force(slider, qj, out.on_journal, out.journal);
    // the opposite force acts on the guide's body at the place of the pin
    add_force(guide, qi, -out.on_journal, out.bearing);
    add_couple(guide, qi, -cross(x.e, out.on_journal), out.bearing);
    return out;
}

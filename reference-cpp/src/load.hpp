// Applied forces and torques.
#pragma once

#include "pair.hpp"

struct Load {
    ls_load_kind kind;
    int x, y;                   // functions of time; y of forces only
    Attachment point, reaction; // reaction: of a torque, else the ground
};

// applied: the components of the force, or the torque in x. In the pair the reaction is the bearing.
template <class T>
PairForces<T> load_forces(const Load &load, Vec<double> applied, const T *reaction, const T *point) {
    using std::sqrt;
    PairForces<T> out;
    if (load.kind == LS_TORQUE) {
        add_couple(load.point, point, T(applied.x), out.journal);
        add_couple(load.reaction, reaction, T(-applied.x), out.bearing);
        return out;
    }
    Vec<T> force{T(applied.x), T(applied.y)};
    if (load.kind == LS_FOLLOWER_FORCE) {
        const Vec<T> d = direction(load.point, point);
        const T unstretched = 1.0 / sqrt(dot(d, d));
        force = unstretched * (force.x * d + force.y * turned(d));
    }
    add_force(load.point, point, force, out.journal);
    return out;
}

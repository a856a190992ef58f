// Applied forces and torques.
#pragma once

#include "pair.hpp"

struct Load {
    std::string name;
    LoadKind kind;
    int x, y;                   // indices in Inputs::given; y of forces only
    Attachment point, reaction; // reaction: of a torque, else the ground
};

// The force in the frame of the ground.
template <class T>
Vec<T> applied_force(const Load &load, Vec<double> applied, const T *point) {
    using std::sqrt;
    const Vec<T> force{T(applied.x), T(applied.y)};
    if (load.kind == LoadKind::dead_force) return force;
    const Vec<T> d = direction(load.point, point);
    const T unstretched = 1.0 / sqrt(dot(d, d));
    return unstretched * (force.x * d + force.y * turned(d));
}

// applied: the components of the force, or the torque in x. In the pair the reaction is the bearing.
template <class T>
PairForces<T> load_forces(const Load &load, Vec<double> applied, const T *reaction, const T *point) {
    PairForces<T> out;
    if (load.kind == LoadKind::torque) {
        add_couple(load.point, point, T(applied.x), out.journal);
        add_couple(load.reaction, reaction, T(-applied.x), out.bearing);
        return out;
    }
    add_force(load.point, point, applied_force(load, applied, point), out.journal);
    return out;
}

// Bodies, their coordinates, and the points of them that joints hold and forces act on.
#pragma once

#include <string>

#include "dual.hpp"
#include "element.hpp"
#include "plane.hpp"
#include "reference.h"

struct Body {
    ls_body_kind kind;
    int offset; // of its first coordinate in q
    int size;   // number of coordinates
    int elements;
    int function; // moving body: of x; those of y and theta follow
    double length;
    double mass;
    double inertia;       // rigid body, about the centre of mass
    double lever;         // length by which tolerances of angles and slopes are divided
    double strain_damping, mass_damping;
    CableElement element; // flexible link

    // coordinates that are not prescribed
    bool can_move() const { return size > 0 && kind != LS_MOVING_BODY; }
};

Body make_body(const ls_body &description, int offset, const std::string &name);

// Adds the constant mass matrix of the body to the diagonal block of M.
void add_mass(const Body &body, Eigen::MatrixXd &mass);

// Adds the field of a uniform translation by (x, y) to the body's part of `field`.
void add_translation(const Body &body, double x, double y, Eigen::VectorXd &field);

// A point of a body, with the few coordinates it depends on:
//   ground               none
//   rigid link           all four (the direction of the chord turns with the link)
//   flexible link        r, r' of the node
//   rigid, moving body   x, y, theta
//   point mass           x, y
struct Attachment {
    ls_body_kind kind;
    int offset; // of its first coordinate in q
    int size;
    int end;           // rigid link: 0 the start, 1 the end
    double length;     // of the direction where nothing is deformed
    Vec<double> point; // ground: global; rigid and moving body: in its own axes

    bool is_frame() const { return kind == LS_RIGID_BODY || kind == LS_MOVING_BODY; }
    bool has_direction() const { return kind != LS_POINT_MASS; }
};

constexpr int attachment_size = 4; // largest Attachment::size

Attachment make_attachment(const Body &body, const ls_point &point, const std::string &name);
// The origin of the ground.
Attachment ground_attachment();

template <class T>
Vec<T> arm(const Attachment &a, const T *q) {
    using std::cos;
    using std::sin;
    const T c = cos(q[2]), s = sin(q[2]);
    return {c * a.point.x - s * a.point.y, s * a.point.x + c * a.point.y};
}

// Here and below q, v are the coordinates of the attachment only.
template <class T>
Vec<T> position(const Attachment &a, const T *q) {
    switch (a.kind) {
    case LS_RIGID_LINK: return {q[2 * a.end], q[2 * a.end + 1]};
    case LS_FLEXIBLE_LINK:
    case LS_POINT_MASS: return {q[0], q[1]};
    case LS_RIGID_BODY:
    case LS_MOVING_BODY: return Vec<T>{q[0], q[1]} + arm(a, q);
    default: return {T(a.point.x), T(a.point.y)};
    }
}

template <class T>
Vec<T> velocity(const Attachment &a, const T *q, const T *v) {
    switch (a.kind) {
    case LS_RIGID_LINK: return {v[2 * a.end], v[2 * a.end + 1]};
    case LS_FLEXIBLE_LINK:
    case LS_POINT_MASS: return {v[0], v[1]};
    case LS_RIGID_BODY:
    case LS_MOVING_BODY: return Vec<T>{v[0], v[1]} + v[2] * turned(arm(a, q));
    default: return {T(0.0), T(0.0)};
    }
}

// The vector that turns with a link here, linear in its coordinates: its chord, or r' of a flexible one.
template <class T>
Vec<T> director(const Attachment &a, const T *u) {
    return a.kind == LS_RIGID_LINK ? Vec<T>{u[2] - u[0], u[3] - u[1]} : Vec<T>{u[2], u[3]};
}

// d / l of the body; of length 1 where nothing is deformed. A point mass has none.
template <class T>
Vec<T> direction(const Attachment &a, const T *q) {
    using std::cos;
    using std::sin;
    if (a.kind == LS_GROUND) return {T(1.0), T(0.0)};
    if (a.is_frame()) return {cos(q[2]), sin(q[2])};
    return T(1.0 / a.length) * director(a, q);
}

// Angular velocity; of links (d x d') / (d . d) with the director d.
template <class T>
T spin(const Attachment &a, const T *q, const T *v) {
    if (a.kind == LS_GROUND) return T(0.0);
    if (a.is_frame()) return v[2];
    const Vec<T> d = director(a, q);
    return cross(d, director(a, v)) / dot(d, d);
}

// Adds force . d(velocity)/dv to the generalised forces Q.
template <class T>
void add_force(const Attachment &a, const T *q, const Vec<T> &force, T *Q) {
    if (a.kind == LS_GROUND) return;
    const int i = a.kind == LS_RIGID_LINK ? 2 * a.end : 0;
    Q[i] += force.x;
    Q[i + 1] += force.y;
    if (a.is_frame()) Q[2] += cross(arm(a, q), force);
}

// Adds couple . d(spin)/dv to the generalised forces Q.
template <class T>
void add_couple(const Attachment &a, const T *q, const T &couple, T *Q) {
    if (a.kind == LS_GROUND) return;
    if (a.is_frame()) {
        Q[2] += couple;
        return;
    }
    const Vec<T> d = director(a, q);
    const Vec<T> pair = couple / dot(d, d) * turned(d);
    Q[2] += pair.x;
    Q[3] += pair.y;
    if (a.kind == LS_RIGID_LINK) {
        Q[0] -= pair.x;
        Q[1] -= pair.y;
    }
}

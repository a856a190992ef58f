// Bodies, their coordinates, and the points of them that joints hold and forces act on.
#pragma once

#include <Eigen/Sparse>
#include <string>
#include <vector>

#include "dual.hpp"
#include "element.hpp"
#include "plane.hpp"
#include "scene.hpp"

struct Body {
    BodyKind kind;
    std::string name;
    int offset; // of its first coordinate in q
    int size;   // number of coordinates
    int elements;
    double length;
    double mass;
    double inertia; // rigid body, about the centre of mass
    double lever;   // length by which tolerances of angles and slopes are divided
    double strain_damping, mass_damping;
    CableElement element; // flexible link

    // coordinates that have a mass
    bool can_move() const { return size > 0 && kind != BodyKind::moving; }
    bool is_link() const { return kind == BodyKind::rigid_link || kind == BodyKind::flexible_link; }
};

Body make_body(const BodyDescription &description, int offset);

// Names of its coordinates, in their order: "BODY.start.x", "BODY.node0.slope_x", "BODY.theta", ...
std::vector<std::string> coordinate_names(const Body &body);

// Adds the constant mass matrix of the body to M.
using Entries = std::vector<Eigen::Triplet<double>>;
void add_mass(const Body &body, Entries &mass);

// Adds the field of a uniform translation by (x, y) to the body's part of `field`.
void add_translation(const Body &body, double x, double y, Eigen::VectorXd &field);

// A straight body in the given place, and its rigid motion; of a flexible link also stretch and bending.
void put_body(const Body &body, const Frame &pose, const Frame &velocity, const Deformation &deformation,
              Eigen::VectorXd &q, Eigen::VectorXd &v);

// A point of a body, with the few coordinates it depends on:
//   ground               none
//   rigid link           all four (the direction of the chord turns with the link)
//   flexible link        r, r' of the node
//   rigid, moving body   x, y, theta
//   point mass           x, y
struct Attachment {
    BodyKind kind;
    int offset; // of its first coordinate in q
    int size;
    double share;      // rigid link: how much of the point its end counts, between 0 at the start and 1
    double length;     // of the direction where nothing is deformed
    Vec<double> point; // ground: global; rigid and moving body: in its own axes

    bool is_frame() const { return kind == BodyKind::rigid_body || kind == BodyKind::moving; }
};

constexpr int attachment_size = 4; // largest Attachment::size

Attachment make_attachment(const Body &body, Vec<double> at); // at: as NamedPoint::at
// The origin of the ground.
Attachment ground_attachment();

template <class T>
Vec<T> arm(const Attachment &a, const T *q) {
    using std::cos;
    using std::sin;
    const T c = cos(q[2]), s = sin(q[2]);
    return {c * a.point.x - s * a.point.y, s * a.point.x + c * a.point.y};
}

// The point between the ends of a rigid link.
template <class T>
Vec<T> along(const Attachment &a, const T *q) {
    const double rest = 1.0 - a.share;
    return {rest * q[0] + a.share * q[2], rest * q[1] + a.share * q[3]};
}

// Here and below q, v are the coordinates of the attachment only.
template <class T>
Vec<T> position(const Attachment &a, const T *q) {
    switch (a.kind) {
    case BodyKind::rigid_link: return along(a, q);
    case BodyKind::flexible_link:
    case BodyKind::point_mass: return {q[0], q[1]};
    case BodyKind::rigid_body:
    case BodyKind::moving: return Vec<T>{q[0], q[1]} + arm(a, q);
    default: return {T(a.point.x), T(a.point.y)};
    }
}

template <class T>
Vec<T> velocity(const Attachment &a, const T *q, const T *v) {
    switch (a.kind) {
    case BodyKind::rigid_link: return along(a, v);
    case BodyKind::flexible_link:
    case BodyKind::point_mass: return {v[0], v[1]};
    case BodyKind::rigid_body:
    case BodyKind::moving: return Vec<T>{v[0], v[1]} + v[2] * turned(arm(a, q));
    default: return {T(0.0), T(0.0)};
    }
}

// The vector that turns with a link here, linear in its coordinates: its chord, or r' of a flexible one.
template <class T>
Vec<T> director(const Attachment &a, const T *u) {
    return a.kind == BodyKind::rigid_link ? Vec<T>{u[2] - u[0], u[3] - u[1]} : Vec<T>{u[2], u[3]};
}

// d / l of the body; of length 1 where nothing is deformed. A point mass has none.
template <class T>
Vec<T> direction(const Attachment &a, const T *q) {
    using std::cos;
    using std::sin;
    if (a.kind == BodyKind::ground) return {T(1.0), T(0.0)};
    if (a.is_frame()) return {cos(q[2]), sin(q[2])};
    return T(1.0 / a.length) * director(a, q);
}

// Angular velocity; of links (d x d') / (d . d) with the director d. A point mass does not turn.
template <class T>
T spin(const Attachment &a, const T *q, const T *v) {
    if (a.kind == BodyKind::ground || a.kind == BodyKind::point_mass) return T(0.0);
    if (a.is_frame()) return v[2];
    const Vec<T> d = director(a, q);
    return cross(d, director(a, v)) / dot(d, d);
}

// Adds force . d(velocity)/dv to the generalised forces Q.
template <class T>
void add_force(const Attachment &a, const T *q, const Vec<T> &force, T *Q) {
    if (a.kind == BodyKind::ground) return;
    if (a.kind == BodyKind::rigid_link) {
        const double rest = 1.0 - a.share;
        Q[0] += rest * force.x;
        Q[1] += rest * force.y;
        Q[2] += a.share * force.x;
        Q[3] += a.share * force.y;
        return;
    }
    Q[0] += force.x;
    Q[1] += force.y;
    if (a.is_frame()) Q[2] += cross(arm(a, q), force);
}

// Adds couple . d(spin)/dv to the generalised forces Q.
template <class T>
void add_couple(const Attachment &a, const T *q, const T &couple, T *Q) {
    if (a.kind == BodyKind::ground || a.kind == BodyKind::point_mass) return;
    if (a.is_frame()) {
        Q[2] += couple;
        return;
    }
    const Vec<T> d = director(a, q);
    const Vec<T> pair = couple / dot(d, d) * turned(d);
    Q[2] += pair.x;
    Q[3] += pair.y;
    if (a.kind == BodyKind::rigid_link) {
        Q[0] -= pair.x;
        Q[1] -= pair.y;
    }
}

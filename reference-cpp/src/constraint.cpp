#include "constraint.hpp"

namespace {

template <class T>
Vec<T> chord(const T *u) {
    return {u[2] - u[0], u[3] - u[1]};
}

// eq. 2 divided by 2 l
template <class T>
T lengthening(const Vec<T> &d, double length) {
    return (dot(d, d) - length * length) * (0.5 / length);
}

// R d_1 / l_1 of an align or slope row.
template <class T>
Vec<T> held_direction(const Constraint &c, const T *u, const T &given) {
    return rotated(direction(c.bearing, u), c.timed() ? given : T(c.angle));
}

template <class T>
T row(const Constraint &c, const T *u, const T &given) {
    const T *w = u + c.bearing.size; // coordinates of the journal
    switch (c.kind) {
    case Constraint::length: return lengthening(chord(u), c.link_length);
    case Constraint::distance: return lengthening(position(c.journal, w) - position(c.bearing, u), c.link_length);
    case Constraint::coordinate: return u[0] - given;
    case Constraint::coincide: {
        const Vec<T> gap = position(c.bearing, u) - position(c.journal, w);
        return c.axis == 0 ? gap.x : gap.y;
    }
    case Constraint::slide:
        return cross(rotated(direction(c.bearing, u), T(c.angle)), position(c.journal, w) - position(c.bearing, u));
    case Constraint::align: return cross(held_direction(c, u, given), direction(c.journal, w));
    case Constraint::slope: {
        const Vec<T> gap = direction(c.journal, w) - held_direction(c, u, given);
        return c.axis == 0 ? gap.x : gap.y;
    }
    default: {
        const Vec<T> r = position(c.journal, w);
        return (c.axis == 0 ? r.x : r.y) - given;
    }
    }
}

// Independent variables for first derivatives.
template <int N>
using First = Dual<double, N>;
template <int N>
using Second = Dual<First<N>, N>;

template <int N>
ConstraintRow first_derivatives(const Constraint &c, const Eigen::VectorXd &q, double given) {
    First<N> u[N], x(given);
    for (int i = 0; i < c.size; ++i) {
        u[i].value = q[c.index[i]];
        u[i].slope[i] = 1.0;
    }
    if (c.timed()) x.slope[c.size] = 1.0;
    const First<N> r = row(c, u, x);
    ConstraintRow out;
    out.value = r.value;
    for (int i = 0; i < c.size; ++i) out.by_q[i] = r.slope[i];
    if (c.timed()) out.by_given = r.slope[c.size];
    return out;
}

template <int N>
void second_derivatives(const Constraint &c, const Eigen::VectorXd &q, double given, ConstraintHessian &h) {
    const int count = c.size + (c.timed() ? 1 : 0);
    Second<N> u[N], x(given);
    auto seed = [](Second<N> &variable, int i) {
        variable.value.slope[i] = 1.0;
        variable.slope[i] = 1.0;
    };
    for (int i = 0; i < c.size; ++i) {
        u[i].value.value = q[c.index[i]];
        seed(u[i], i);
    }
    if (c.timed()) seed(x, c.size);
    const Second<N> r = row(c, u, x);
    for (int i = 0; i < count; ++i)
        for (int j = 0; j < count; ++j) h(i, j) = r.slope[i].slope[j];
}

Constraint of_kind(Constraint::Kind kind) {
    Constraint c{};
    c.kind = kind;
    c.bearing = c.journal = ground_attachment();
    c.given = -1;
    return c;
}

Constraint of_points(const Attachment &bearing, const Attachment &journal, Constraint::Kind kind) {
    Constraint c = of_kind(kind);
    c.bearing = bearing;
    c.journal = journal;
    for (int i = 0; i < bearing.size; ++i) c.index[c.size++] = bearing.offset + i;
    for (int i = 0; i < journal.size; ++i) c.index[c.size++] = journal.offset + i;
    return c;
}

// Coordinates of one of the bodies in play and the prescribed quantity.
constexpr int one_side = attachment_size + 1;
constexpr int two_sides = constraint_size + 1;

bool depends_on_one_side(const Constraint &c) { return c.size <= attachment_size; }

// The coordinates of the row, in its order.
std::array<double, constraint_size> gathered(const Constraint &c, const Eigen::VectorXd &q) {
    std::array<double, constraint_size> u{};
    for (int i = 0; i < c.size; ++i) u[i] = q[c.index[i]];
    return u;
}

} // namespace

Constraint length_constraint(const Body &link) {
    Constraint c = of_kind(Constraint::length);
    c.size = 4;
    c.link_length = link.length;
    for (int i = 0; i < 4; ++i) c.index[i] = link.offset + i;
    return c;
}

Constraint distance_constraint(const Attachment &bearing, const Attachment &journal, double length) {
    Constraint c = of_points(bearing, journal, Constraint::distance);
    c.link_length = length;
    return c;
}

Constraint coordinate_constraint(const Body &body, int coordinate, int given) {
    Constraint c = of_kind(Constraint::coordinate);
    c.size = 1;
    c.index[0] = body.offset + coordinate;
    c.given = given;
    c.linear = true;
    return c;
}

Constraint coincide_constraint(const Attachment &bearing, const Attachment &journal, int axis) {
    Constraint c = of_points(bearing, journal, Constraint::coincide);
    c.axis = axis;
    c.linear = !bearing.is_frame() && !journal.is_frame();
    return c;
}

Constraint slide_constraint(const Attachment &bearing, const Attachment &journal, double direction) {
    Constraint c = of_points(bearing, journal, Constraint::slide);
    c.angle = direction;
    c.linear = bearing.kind == BodyKind::ground && !journal.is_frame();
    return c;
}

Constraint align_constraint(const Attachment &bearing, const Attachment &journal, double angle) {
    Constraint c = of_points(bearing, journal, Constraint::align);
    c.angle = angle;
    return c;
}

Constraint turn_constraint(const Attachment &bearing, const Attachment &journal, int given) {
    Constraint c = of_points(bearing, journal, Constraint::align);
    c.given = given;
    return c;
}

Constraint slope_constraint(const Attachment &bearing, const Attachment &journal, double angle, int axis) {
    Constraint c = of_points(bearing, journal, Constraint::slope);
    c.angle = angle;
    c.axis = axis;
    c.linear = !bearing.is_frame() && !journal.is_frame();
    return c;
}

Constraint place_constraint(const Attachment &point, int axis, int given) {
    Constraint c = of_points(ground_attachment(), point, Constraint::place);
    c.axis = axis;
    c.given = given;
    c.linear = !point.is_frame();
    return c;
}

ConstraintRow evaluate(const Constraint &c, const Eigen::VectorXd &q, double given) {
    return depends_on_one_side(c) ? first_derivatives<one_side>(c, q, given) : first_derivatives<two_sides>(c, q, given);
}

double convective_acceleration(const Constraint &c, const Eigen::VectorXd &q, const Eigen::VectorXd &v,
                               const Prescribed &given) {
    if (c.linear && !c.timed()) return 0.0;
    Jet u[constraint_size];
    for (int i = 0; i < c.size; ++i) u[i] = jet(q[c.index[i]], v[c.index[i]], 0.0);
    return acceleration_of(row(c, u, jet(given.value, given.rate, given.acceleration)));
}

void hessian(const Constraint &c, const Eigen::VectorXd &q, double given, ConstraintHessian &h) {
    if (depends_on_one_side(c))
        second_derivatives<one_side>(c, q, given, h);
    else
        second_derivatives<two_sides>(c, q, given, h);
}

Vec<double> by_journal(const Constraint &c, const Eigen::VectorXd &q) {
    const auto u = gathered(c, q);
    if (c.kind == Constraint::distance)
        return (1.0 / c.link_length) * (position(c.journal, u.data() + c.bearing.size) - position(c.bearing, u.data()));
    return turned(rotated(direction(c.bearing, u.data()), c.angle));
}

double by_rotation(const Constraint &c, const Eigen::VectorXd &q, double given) {
    const auto u = gathered(c, q);
    const Vec<double> d = direction(c.journal, u.data() + c.bearing.size);
    if (c.kind == Constraint::slope) return c.axis == 0 ? turned(d).x : turned(d).y;
    return dot(held_direction(c, u.data(), given), d);
}

bool right_way_round(const Constraint &c, const Eigen::VectorXd &q, double given) {
    return c.kind != Constraint::align || by_rotation(c, q, given) > 0.0;
}

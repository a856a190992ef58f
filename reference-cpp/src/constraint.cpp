#include "constraint.hpp"

#include <algorithm>

namespace {

template <class T>
T row(const Constraint &c, const T *u, const T &angle) {
    using std::cos;
    using std::sin;
    switch (c.kind) {
    case Constraint::length: { // eq. 2 divided by 2 l
        const Vec<T> d{u[2] - u[0], u[3] - u[1]};
        return (dot(d, d) - c.link_length * c.link_length) * (0.5 / c.link_length);
    }
    case Constraint::coincide: {
        const Vec<T> gap = position(c.bearing, u) - position(c.journal, u + c.bearing.size);
        return c.axis == 0 ? gap.x : gap.y;
    }
    default: { // sin(theta - phi), theta the angle of B - A
        const Vec<T> d{u[2] - u[0], u[3] - u[1]};
        return cross(Vec<T>{cos(angle), sin(angle)}, d) * (c.sense / c.link_length);
    }
    }
}

// Independent variables for first derivatives.
template <int N>
using First = Dual<double, N>;
template <int N>
using Second = Dual<First<N>, N>;

template <int N>
ConstraintRow first_derivatives(const Constraint &c, const Eigen::VectorXd &q, double angle) {
    First<N> u[N], phi(angle);
    for (int i = 0; i < c.size; ++i) {
        u[i].value = q[c.index[i]];
        u[i].slope[i] = 1.0;
    }
    if (c.size < N) phi.slope[c.size] = 1.0;
    const First<N> r = row(c, u, phi);
    ConstraintRow out;
    out.value = r.value;
    for (int i = 0; i < c.size; ++i) out.by_q[i] = r.slope[i];
    if (c.size < N) out.by_angle = r.slope[c.size];
    return out;
}

template <int N>
void second_derivatives(const Constraint &c, const Eigen::VectorXd &q, double angle, ConstraintHessian &h) {
    const int count = std::min(c.size + 1, N);
    Second<N> u[N], phi(angle);
    auto seed = [](Second<N> &x, int i) {
        x.value.slope[i] = 1.0;
        x.slope[i] = 1.0;
    };
    for (int i = 0; i < c.size; ++i) {
        u[i].value.value = q[c.index[i]];
        seed(u[i], i);
    }
    if (c.size < N) seed(phi, c.size);
    const Second<N> r = row(c, u, phi);
    for (int i = 0; i < count; ++i)
        for (int j = 0; j < count; ++j) h(i, j) = r.slope[i].slope[j];
}

Constraint of_link(const Body &link, Constraint::Kind kind) {
    Constraint c{};
    c.kind = kind;
    c.size = 4;
    c.link_length = link.length;
    for (int i = 0; i < 4; ++i) c.index[i] = link.offset + i;
    return c;
}

constexpr int link_variables = 5; // two ends and the angle

} // namespace

Constraint length_constraint(const Body &link) { return of_link(link, Constraint::length); }

Constraint coincide_constraint(const Attachment &bearing, const Attachment &journal, int axis) {
    Constraint c{};
    c.kind = Constraint::coincide;
    c.bearing = bearing;
    c.journal = journal;
    c.axis = axis;
    c.linear = bearing.kind != LS_RIGID_BODY && journal.kind != LS_RIGID_BODY;
    for (int i = 0; i < bearing.size; ++i) c.index[c.size++] = bearing.offset + i;
    for (int i = 0; i < journal.size; ++i) c.index[c.size++] = journal.offset + i;
    return c;
}

Constraint drive_constraint(const Body &crank, bool from_start, int leg) {
    Constraint c = of_link(crank, Constraint::drive);
    c.leg = leg;
    c.sense = from_start ? 1.0 : -1.0;
    return c;
}

ConstraintRow evaluate(const Constraint &c, const Eigen::VectorXd &q, double angle) {
    if (c.kind != Constraint::coincide) return first_derivatives<link_variables>(c, q, angle);
    return c.size <= attachment_size ? first_derivatives<attachment_size>(c, q, angle)
                                     : first_derivatives<constraint_size>(c, q, angle);
}

double convective_acceleration(const Constraint &c, const Eigen::VectorXd &q, const Eigen::VectorXd &v,
                               const CrankAngle &a) {
    if (c.linear) return 0.0;
    Jet u[constraint_size];
    for (int i = 0; i < c.size; ++i) u[i] = jet(q[c.index[i]], v[c.index[i]], 0.0);
    return acceleration_of(row(c, u, jet(a.angle, a.rate, a.acceleration)));
}

void hessian(const Constraint &c, const Eigen::VectorXd &q, double angle, ConstraintHessian &h) {
    if (c.kind == Constraint::coincide) {
        h.setZero();
        second_derivatives<constraint_size>(c, q, angle, h);
    } else {
        second_derivatives<link_variables>(c, q, angle, h);
    }
}

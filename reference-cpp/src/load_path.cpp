#include "load_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

LoadPath::LoadPath(Statics &statics, const VectorXd &q, double duration)
    : statics_(statics), time_weight_(1.0 / (duration * duration)) {
    const VectorXd levers = statics.equations().system().levers() / statics.equations().extent(q);
    weight_ = levers.cwiseAbs2();
}

double LoadPath::product(const PathPoint &a, const VectorXd &dq, double dt) const {
    return a.dq.cwiseProduct(weight_).dot(dq) + time_weight_ * a.dt * dt;
}

// The row that measures the arc length along the tangent.
VectorXd LoadPath::weighted(const PathPoint &a) const {
    VectorXd row = VectorXd::Zero(a.dq.size() + a.dlambda.size() + 1);
    row.head(a.dq.size()) = a.dq.cwiseProduct(weight_);
    row[row.size() - 1] = time_weight_ * a.dt;
    return row;
}

namespace {

// The derivatives of the equations of rest by (q, lambda, t), and one more row.
MatrixXd bordered(const StaticEquations &equations, const VectorXd &last_row) {
    const Eigen::Index size = last_row.size() - 1;
    MatrixXd a(size + 1, size + 1);
    a.topLeftCorner(size, size) = equations.tangent();
    a.topRightCorner(size, 1) = equations.by_time();
    a.bottomRows(1) = last_row.transpose();
    return a;
}

} // namespace

PathPoint LoadPath::with_tangent(const Equilibrium &x, const VectorXd &last_row) {
    StaticEquations &equations = statics_.equations();
    equations.assemble(x);
    const Eigen::Index n = x.q.size(), m = x.lambda.size();
    const VectorXd z = bordered(equations, last_row).partialPivLu().solve(VectorXd::Unit(n + m + 1, n + m));
    if (!z.allFinite()) throw Failure(LS_NOT_FINITE, "the path of equilibria has no direction", x.t);
    PathPoint point{x, z.head(n), z.segment(n, m), z[n + m], equations.stability().negative()};
    normalise(point);
    return point;
}

void LoadPath::normalise(PathPoint &point) const {
    const double length = std::sqrt(product(point, point.dq, point.dt));
    point.dq /= length;
    point.dlambda /= length;
    point.dt /= length;
}

PathPoint LoadPath::start(const Equilibrium &x) {
    const Eigen::Index size = x.q.size() + x.lambda.size() + 1;
    return with_tangent(x, VectorXd::Unit(size, size - 1));
}

PathPoint LoadPath::go_on(const Equilibrium &x, const PathPoint &before) { return with_tangent(x, weighted(before)); }

bool LoadPath::step(const PathPoint &from, double length, PathPoint &to) {
    StaticEquations &equations = statics_.equations();
    const Eigen::Index n = from.x.q.size(), m = from.x.lambda.size();
    const VectorXd row = weighted(from);
    Equilibrium x = from.x;
    x.q += length * from.dq;
    x.lambda += length * from.dlambda;
    x.t += length * from.dt;
    const Equilibrium predicted = x;
    constexpr int most_passes = 15;
    constexpr double good = 1e-8, rounding = 1e-15, bend = 0.3, turn = 0.9;
    double last = std::numeric_limits<double>::infinity();
    for (int pass = 0; pass < most_passes; ++pass) {
        equations.assemble(x);
        VectorXd right(n + m + 1);
        right << -equations.residual(), 0.0;
        const VectorXd z = bordered(equations, row).partialPivLu().solve(right);
        if (!z.allFinite()) return false;
        const double size = z.head(n).cwiseAbs().maxCoeff(), scale = 1.0 + x.q.cwiseAbs().maxCoeff();
        x.q += z.head(n);
        x.lambda += z.segment(n, m);
        x.t += z[n + m];
        if (size <= rounding * scale || (size <= good * scale && size > 0.25 * last)) {
            const VectorXd off = x.q - predicted.q;
            const double late = x.t - predicted.t;
            if (off.cwiseProduct(weight_).dot(off) + time_weight_ * late * late > bend * bend * length * length) return false;
            equations.system().count_turns(x.q, x.memory);
            to = go_on(x, from);
            return product(from, to.dq, to.dt) > turn;
        }
        last = size;
    }
    return false;
}

PathPoint LoadPath::at(const PathPoint &from, double length) {
    PathPoint point = from;
    if (length > 0.0 && !step(from, length, point))
        throw Failure(LS_NOT_FINITE, "the path of equilibria cannot be followed", from.x.t);
    return point;
}

// At a critical point the equations at a given load are singular: there the path is straight between two points close by.
PathPoint LoadPath::at_load(const PathPoint &from, double length, const PathPoint &to, double t) {
    auto between = [t](const PathPoint &a, const PathPoint &b) {
        const double part = (t - a.x.t) / (b.x.t - a.x.t);
        Equilibrium x = b.x;
        x.q = (1.0 - part) * a.x.q + part * b.x.q;
        x.lambda = (1.0 - part) * a.x.lambda + part * b.x.lambda;
        x.t = t;
        return x;
    };
    Equilibrium x = between(from, to);
    const VectorXd guess = x.q, bend = to.x.q - from.x.q;
    const bool found = statics_.correct(x);
    if (found && (x.q - guess).cwiseAbs2().dot(weight_) <= bend.cwiseAbs2().dot(weight_)) return go_on(x, from);
    double a = 0.0, b = length;
    constexpr double close = 1e-6;
    while (b - a > close * length) {
        double middle = 0.5 * (a + b);
        PathPoint point;
        if (!step(from, middle, point)) { // a crossing of paths: next to it they are apart
            middle = 0.4 * a + 0.6 * b;
            point = at(from, middle);
        }
        (point.x.t < t ? a : b) = middle;
    }
    const PathPoint left = at(from, a), right = at(from, b);
    PathPoint point = right;
    point.x = between(left, right);
    point.dq = right.x.q - left.x.q;
    point.dlambda = right.x.lambda - left.x.lambda;
    point.dt = right.x.t - left.x.t;
    normalise(point);
    return point;
}

// g of [A b; b^T 0] (y; g) = (0; 1) vanishes where A is singular, and is smooth there.
double LoadPath::test_function(const Equilibrium &x, const VectorXd &border) {
    StaticEquations &equations = statics_.equations();
    equations.assemble(x);
    const Eigen::Index size = border.size();
    MatrixXd a = MatrixXd::Zero(size + 1, size + 1);
    a.topLeftCorner(size, size) = equations.tangent();
    a.topRightCorner(size, 1) = border;
    a.bottomLeftCorner(1, size) = border.transpose();
    return a.partialPivLu().solve(VectorXd::Unit(size + 1, size))[size];
}

// The zero of the test function between two signs, by the Illinois variant of the false position; the border is the motion that
// loses its resistance.
CriticalPoint LoadPath::locate(const PathPoint &from, double length, const PathPoint &to) {
    StaticEquations &equations = statics_.equations();
    const Stability end = statics_.stability(to.x);
    const VectorXd mode = end.mode(std::min(from.negative, to.negative));
    VectorXd border = VectorXd::Zero(from.x.q.size() + from.x.lambda.size());
    border.head(mode.size()) = equations.mass() * mode;
    double a = 0.0, b = length, ga = test_function(from.x, border), gb = test_function(to.x, border), s = 0.5 * length;
    constexpr double near = 1e-9, side = 1e-5;
    constexpr int most_passes = 100;
    const bool crosses = ga * gb < 0.0;
    for (int pass = 0; pass < most_passes; ++pass) {
        const double next = crosses ? (a * gb - b * ga) / (gb - ga) : 0.5 * (a + b);
        const bool close = std::abs(next - s) <= near * length && pass > 0;
        s = next;
        if (close) break;
        PathPoint point;
        if (!step(from, s, point)) break; // where paths cross they cannot be told apart: s is there
        const double g = test_function(point.x, border);
        // two eigenvalues at once leave no sign of g to follow: their number decides
        const bool before = crosses ? g * ga > 0.0 : point.negative == from.negative;
        if (g == 0.0) break;
        if (before) {
            if (a > 0.0) gb *= 0.5;
            a = s;
            ga = g;
        } else {
            if (b < length) ga *= 0.5;
            b = s;
            gb = g;
        }
    }
    const PathPoint left = at(from, std::max(0.0, s - side * length)), right = at(from, s + side * length);
    CriticalPoint critical;
    critical.t = 0.5 * (left.x.t + right.x.t);
    critical.limit = left.dt * right.dt < 0.0;
    critical.coordinate = equations.system().moves_most(mode);
    return critical;
}

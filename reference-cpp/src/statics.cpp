#include "statics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace {

constexpr double longest = 0.05; // of a step, in extents of the mechanism

} // namespace

// Newton's update of q and the new multipliers, with the mass matrix times `inertia` added to the stiffness. Along motions that
// nothing resists there is no update.
bool Statics::step(const Equilibrium &x, double inertia, VectorXd &dq, VectorXd &lambda) const {
    const Eigen::Index n = x.q.size(), size = n + x.lambda.size();
    MatrixXd neutral(n, 0);
    if (inertia == 0.0) neutral = equations_.mass() * equations_.stability().neutral();
    MatrixXd a = MatrixXd::Zero(size + neutral.cols(), size + neutral.cols());
    a.topLeftCorner(size, size) = equations_.tangent();
    if (inertia > 0.0) a.topLeftCorner(n, n) += inertia * equations_.mass();
    a.topRightCorner(n, neutral.cols()) = neutral;
    a.bottomLeftCorner(neutral.cols(), n) = neutral.transpose();
    VectorXd right = VectorXd::Zero(a.rows());
    right.head(size) = -equations_.residual();
    const VectorXd update = a.partialPivLu().solve(right);
    dq = update.head(n);
    lambda = x.lambda + update.segment(n, x.lambda.size());
    return update.allFinite();
}

// Whether the multipliers, on which the tangent depends, change by rounding or hardly.
bool Statics::settles(const Equilibrium &x, const VectorXd &lambda) const {
    constexpr double good = 1e-6, rounding = 1e-12;
    return (lambda - x.lambda).norm() <= good * lambda.norm() + rounding * equations_.largest_stiffness() * (1.0 + x.q.norm());
}

bool Statics::correct(Equilibrium &x) {
    const Equilibrium before = x;
    constexpr int most_passes = 60;
    constexpr double good = 1e-8, rounding = 1e-15;
    double last = std::numeric_limits<double>::infinity();
    for (int pass = 0; pass < most_passes; ++pass) {
        equations_.assemble(x);
        VectorXd dq, lambda;
        if (!step(x, 0.0, dq, lambda)) break;
        const double size = dq.cwiseAbs().maxCoeff(), scale = 1.0 + x.q.cwiseAbs().maxCoeff();
        const bool settled = settles(x, lambda);
        x.lambda = lambda;
        // the updates have come down to rounding when they cease to shrink
        if (settled && (size <= rounding * scale || (size <= good * scale && size > 0.25 * last))) {
            equations_.system().count_turns(x.q, x.memory);
            equations_.assemble(x);
            if (equations_.is_balanced()) return true;
            break;
        }
        x.q += dq;
        last = size;
    }
    x = before;
    return false;
}

// Implicit Euler steps of M q'' damped to the utmost, that is (K + s M) dq = -residual. s falls as long as the steps are short
// and the matrix is positive definite, so the way leads downhill.
void Statics::descend(Equilibrium &x) {
    const double extent = equations_.extent(x.q);
    constexpr double falling = 0.3, rising = 5.0, first = 1e6, nudge = 1e-3;
    // below the rounding of the eigenvalues inertia no longer tells what resists
    const double least = std::max(1e-9, 10.0 * stability(x).rounding());
    constexpr int most_steps = 5000, most_trials = 60;
    double inertia = first;
    for (int pass = 0; pass < most_steps; ++pass) {
        equations_.assemble(x);
        VectorXd dq, lambda;
        for (int trial = 0;; ++trial) {
            if (trial == most_trials) throw Failure(LS_NOT_FINITE, "no equilibrium is found", x.t);
            if (equations_.is_held(inertia) && step(x, inertia, dq, lambda) && dq.cwiseAbs().maxCoeff() <= longest * extent)
                break;
            inertia *= rising;
        }
        x.q += dq;
        x.lambda = lambda;
        equations_.system().count_turns(x.q, x.memory);
        inertia *= falling;
        if (inertia > least) continue;
        inertia = first;
        if (!correct(x)) continue;
        const Stability found = stability(x);
        if (!found.is_unstable()) return;
        // at rest on a summit: down on one side
        const VectorXd mode = found.softest();
        x.q += nudge * extent / mode.cwiseAbs().maxCoeff() * mode;
    }
    throw Failure(LS_NOT_FINITE, "no equilibrium is found: something falls without end", x.t);
}

void Statics::approach(Equilibrium &x) {
    const double extent = equations_.extent(x.q);
    constexpr int most_steps = 500;
    constexpr double near = 1e-3;
    for (int pass = 0; pass < most_steps; ++pass) {
        equations_.assemble(x);
        VectorXd dq, lambda;
        if (!step(x, 0.0, dq, lambda)) break;
        const double size = dq.cwiseAbs().maxCoeff();
        const bool settled = settles(x, lambda);
        x.lambda = lambda;
        if (settled && size <= near * extent && correct(x)) return;
        if (size > 0.0) x.q += std::min(1.0, longest * extent / size) * dq;
        equations_.system().count_turns(x.q, x.memory);
    }
    throw Failure(LS_NOT_FINITE, "no equilibrium is found near the start", x.t);
}

Stability Statics::stability(const Equilibrium &x) {
    equations_.assemble(x);
    return equations_.stability();
}

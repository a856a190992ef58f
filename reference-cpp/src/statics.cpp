#include "statics.hpp"

#include <cmath>

void Statics::assemble(const Inputs &inputs, const Memory &memory, const VectorXd &q) {
    const int n = system_.coordinates();
    const VectorXd rest = VectorXd::Zero(n);
    Entries by_q, ignored;
    system_.force(inputs, q, rest, memory, force_);
    system_.constraint_rows(inputs, q, phi_, phi_q_, phi_t_);
    system_.force_derivatives(inputs, q, rest, memory, by_q, ignored);
    system_.constraint_derivatives(inputs, q, rest, lambda_, by_q, ignored);
    stiffness_.setZero(n, n);
    for (const auto &entry : by_q) stiffness_(entry.row(), entry.col()) += entry.value();
}

// Newton's update of q, with the mass matrix times `inertia` added to the stiffness.
VectorXd Statics::solve(double inertia, VectorXd &next_lambda) const {
    const int n = system_.coordinates(), m = system_.constraints();
    MatrixXd kkt = MatrixXd::Zero(n + m, n + m);
    kkt.topLeftCorner(n, n) = stiffness_;
    if (inertia > 0.0) kkt.topLeftCorner(n, n) += inertia * MatrixXd(system_.mass());
    kkt.topRightCorner(n, m) = phi_q_.transpose();
    kkt.bottomLeftCorner(m, n) = phi_q_;
    VectorXd right(n + m);
    right << -force_, -phi_;
    const VectorXd x = kkt.partialPivLu().solve(right);
    next_lambda = x.tail(m);
    return x.head(n);
}

// Whether stiffness and inertia resist every motion that the constraints permit.
bool Statics::is_held(double inertia) const {
    const int n = system_.coordinates(), m = system_.constraints();
    MatrixXd total = 0.5 * (stiffness_ + stiffness_.transpose());
    if (inertia > 0.0) total += inertia * MatrixXd(system_.mass());
    if (m >= n) return true;
    MatrixXd basis = MatrixXd::Identity(n, n);
    if (m > 0) basis = Eigen::HouseholderQR<MatrixXd>(phi_q_.transpose()).householderQ() * basis;
    const MatrixXd free = basis.rightCols(n - m);
    const MatrixXd resistance = free.transpose() * total * free;
    const Eigen::LDLT<MatrixXd> factor(resistance);
    constexpr double rounding = 1e-14;
    const VectorXd pivots = factor.vectorD();
    return pivots.minCoeff() > rounding * pivots.cwiseAbs().maxCoeff();
}

bool Statics::follow(double t, const Memory &memory, VectorXd &q) {
    const Inputs inputs = system_.inputs(t);
    const VectorXd q_before = q, lambda_before = lambda_;
    constexpr int most_passes = 60;
    constexpr double good = 1e-8, rounding = 1e-15;
    double last = std::numeric_limits<double>::infinity();
    for (int pass = 0; pass < most_passes; ++pass) {
        assemble(inputs, memory, q);
        VectorXd next_lambda;
        const VectorXd update = solve(0.0, next_lambda);
        if (!update.allFinite()) break;
        const double size = update.cwiseAbs().maxCoeff(), scale = 1.0 + q.cwiseAbs().maxCoeff();
        // the updates have come down to rounding when they cease to shrink
        if (size <= rounding * scale || (size <= good * scale && size > 0.25 * last)) return true;
        q += update;
        lambda_ = next_lambda;
        last = size;
    }
    q = q_before;
    lambda_ = lambda_before;
    return false;
}

// Implicit Euler steps of M q'' damped to the utmost, that is (K + s M) dq = -residual. s falls as long as the steps are short
// and the matrix is positive definite, so the way leads downhill, past equilibria that are not stable.
void Statics::relax(Memory &memory, VectorXd &q) {
    const Inputs inputs = system_.inputs(0.0);
    const double extent = std::max(q.maxCoeff() - q.minCoeff(), system_.levers().maxCoeff());
    constexpr double longest = 0.05, falling = 0.3, rising = 5.0, first = 1e6, least = 1e-9;
    constexpr int most_steps = 2000;
    double inertia = first;
    for (int step = 0; step < most_steps; ++step) {
        assemble(inputs, memory, q);
        VectorXd update, next_lambda;
        for (int trial = 0;; ++trial) {
            if (trial == 60) throw Failure(LS_NOT_FINITE, "no equilibrium is found");
            update = is_held(inertia) ? solve(inertia, next_lambda) : VectorXd();
            if (update.size() > 0 && update.allFinite() && update.cwiseAbs().maxCoeff() <= longest * extent) break;
            inertia *= rising;
        }
        q += update;
        system_.count_turns(q, memory);
        lambda_ = next_lambda;
        inertia *= falling;
        if (inertia > least) continue;
        assemble(inputs, memory, q);
        if (!is_held(0.0)) throw Failure(LS_BAD_INPUT, "the mechanism can move freely: in equilibrium springs, elastic links or drives must hold every motion");
        if (follow(0.0, memory, q)) return;
        inertia = first;
    }
    throw Failure(LS_NOT_FINITE, "no equilibrium is found");
}

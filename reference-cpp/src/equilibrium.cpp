#include "equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

StaticEquations::StaticEquations(const System &system) : system_(system), mass_(system.mass()) {}

void StaticEquations::assemble(const Equilibrium &x) {
    const int n = system_.coordinates();
    const Inputs inputs = system_.inputs(x.t);
    const VectorXd rest = VectorXd::Zero(n);
    system_.constraint_rows(inputs, x.q, phi_, phi_q_, phi_t_);
    system_.force(inputs, x.q, rest, x.memory, applied_);
    force_ = applied_ + phi_q_.transpose() * x.lambda;
    Entries by_q, ignored, rate_by_q;
    system_.force_derivatives(inputs, x.q, rest, x.memory, by_q, ignored);
    system_.constraint_derivatives(inputs, x.q, rest, x.lambda, by_q, rate_by_q);
    stiffness_.setZero(n, n);
    magnitude_.setZero(n, n);
    for (const auto &entry : by_q) {
        stiffness_(entry.row(), entry.col()) += entry.value();
        magnitude_(entry.row(), entry.col()) += std::abs(entry.value());
    }
    place_ = x.q.cwiseAbs();
    system_.load_rates(inputs, x.q, force_by_time_);
    // at rest the rate of a row is Phi_t, so its derivatives by q are those of Phi_q by t
    for (const auto &entry : rate_by_q) force_by_time_[entry.col()] += entry.value() * x.lambda[entry.row()];
}

VectorXd StaticEquations::residual() const {
    VectorXd r(force_.size() + phi_.size());
    r << force_, phi_;
    return r;
}

VectorXd StaticEquations::by_time() const {
    VectorXd r(force_.size() + phi_.size());
    r << force_by_time_, phi_t_;
    return r;
}

MatrixXd StaticEquations::tangent() const {
    const Eigen::Index n = force_.size(), m = phi_.size();
    MatrixXd a = MatrixXd::Zero(n + m, n + m);
    a.topLeftCorner(n, n) = stiffness_;
    a.topRightCorner(n, m) = phi_q_.transpose();
    a.bottomLeftCorner(m, n) = phi_q_;
    return a;
}

bool StaticEquations::is_held(double inertia) const {
    const MatrixXd free = permitted_motions(phi_q_);
    if (free.cols() == 0) return true;
    const MatrixXd total = 0.5 * (stiffness_ + stiffness_.transpose()) + inertia * mass_;
    const MatrixXd resistance = free.transpose() * total * free;
    const Eigen::LDLT<MatrixXd> factor(resistance);
    constexpr double rounding = 1e-14;
    const VectorXd pivots = factor.vectorD();
    return pivots.minCoeff() > rounding * pivots.cwiseAbs().maxCoeff();
}

bool StaticEquations::is_balanced() const {
    const MatrixXd motions = stability().neutral();
    // a part of the forces, and what the rounding of the coordinates may make of the stiffness
    constexpr double part = 1e-9, rounding = 1e3 * std::numeric_limits<double>::epsilon();
    const VectorXd limit = part * applied_.cwiseAbs() + rounding * (magnitude_ * place_);
    for (Eigen::Index i = 0; i < motions.cols(); ++i)
        if (std::abs(motions.col(i).dot(force_)) > motions.col(i).cwiseAbs().dot(limit)) return false;
    return true;
}

double StaticEquations::extent(const VectorXd &q) const {
    return std::max(q.maxCoeff() - q.minCoeff(), system_.levers().maxCoeff());
}

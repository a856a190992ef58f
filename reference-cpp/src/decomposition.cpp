#include "decomposition.hpp"

namespace {

constexpr double rank_rounding = 1e-10;

} // namespace

Decomposition::Decomposition(const Eigen::MatrixXd &a) {
    factors_.setThreshold(rank_rounding);
    factors_.compute(a);
}

Eigen::VectorXd Decomposition::solve(const Eigen::VectorXd &b) const { return factors_.solve(b); }

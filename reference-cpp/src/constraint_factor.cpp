#include "constraint_factor.hpp"

#include <cmath>

namespace {

// Pivots of a unit diagonal below this are rounding.
constexpr double rounding = 1e-13;

Eigen::VectorXd unit_scale(const Eigen::MatrixXd &s) {
    return s.diagonal().unaryExpr([](double x) { return x > 0.0 ? 1.0 / std::sqrt(x) : 1.0; });
}

} // namespace

void ConstraintFactor::compute(const Eigen::MatrixXd &s) {
    scale_ = unit_scale(s);
    factor_.compute(scale_.asDiagonal() * s * scale_.asDiagonal());
    const Eigen::VectorXd pivots = factor_.vectorD();
    independent_ = pivots.minCoeff() > rounding * pivots.maxCoeff();
}

// Cholesky's method without pivoting.
std::vector<int> ConstraintFactor::dependent_rows(const Eigen::MatrixXd &s) {
    const Eigen::VectorXd scale = unit_scale(s);
    Eigen::MatrixXd rest = scale.asDiagonal() * s * scale.asDiagonal();
    constexpr double generous = 1e3 * rounding; // this order of elimination is less accurate
    std::vector<int> rows;
    for (int k = 0; k < rest.rows(); ++k) {
        const double pivot = rest(k, k);
        if (!(pivot > generous)) {
            rows.push_back(k);
            rest.row(k).setZero();
            rest.col(k).setZero();
            continue;
        }
        const Eigen::VectorXd column = rest.col(k);
        rest.noalias() -= column * column.transpose() / pivot;
    }
    return rows;
}

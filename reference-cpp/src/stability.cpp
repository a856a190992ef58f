#include "stability.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd permitted_motions(const MatrixXd &phi_q) {
    const Eigen::Index n = phi_q.cols(), m = phi_q.rows();
    if (m == 0) return MatrixXd::Identity(n, n);
    if (m >= n) return MatrixXd(n, 0);
    const MatrixXd basis = Eigen::HouseholderQR<MatrixXd>(phi_q.transpose()).householderQ() * MatrixXd::Identity(n, n);
    return basis.rightCols(n - m);
}

Stability::Stability(const MatrixXd &stiffness, const MatrixXd &magnitude, const MatrixXd &mass, const MatrixXd &phi_q) {
    const MatrixXd basis = permitted_motions(phi_q);
    modes_.resize(basis.rows(), 0);
    if (basis.cols() == 0) return;
    const MatrixXd k = basis.transpose() * stiffness * basis, m = basis.transpose() * mass * basis;
    constexpr double asymmetry = 1e-10; // beyond rounding
    if ((k - k.transpose()).norm() <= asymmetry * k.norm()) {
        const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(0.5 * (k + k.transpose()), m);
        values_ = solver.eigenvalues();
        modes_ = basis * solver.eigenvectors();
    } else {
        const Eigen::EigenSolver<MatrixXd> solver(m.llt().solve(k));
        const VectorXd parts = solver.eigenvalues().real();
        std::vector<Eigen::Index> order(static_cast<std::size_t>(parts.size()));
        std::iota(order.begin(), order.end(), Eigen::Index{0});
        std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) { return parts[a] < parts[b]; });
        values_.resize(parts.size());
        modes_.resize(basis.rows(), parts.size());
        for (Eigen::Index i = 0; i < parts.size(); ++i) {
            const Eigen::Index from = order[static_cast<std::size_t>(i)];
            values_[i] = parts[from];
            const VectorXd x = basis * solver.eigenvectors().col(from).real();
            modes_.col(i) = x / std::sqrt(x.dot(mass * x));
        }
    }
    // Rayleigh's quotient has the error of the stiffness alone, not that of the highest eigenvalue
    const VectorXd x = modes_.col(0), size = x.cwiseAbs();
    values_[0] = x.dot(stiffness * x) / x.dot(mass * x);
    constexpr double few = 16.0; // operations that follow each other
    const double largest = std::max(size.dot(magnitude * size), values_.cwiseAbs().maxCoeff());
    rounding_ = few * std::numeric_limits<double>::epsilon() * largest;
}

int Stability::negative() const {
    return static_cast<int>(std::count_if(values_.begin(), values_.end(), [&](double mu) { return mu < -rounding_; }));
}

MatrixXd Stability::neutral() const {
    std::vector<Eigen::Index> chosen;
    for (Eigen::Index i = 0; i < values_.size(); ++i)
        if (std::abs(values_[i]) <= rounding_) chosen.push_back(i);
    MatrixXd motions(modes_.rows(), static_cast<Eigen::Index>(chosen.size()));
    for (std::size_t i = 0; i < chosen.size(); ++i) motions.col(static_cast<Eigen::Index>(i)) = modes_.col(chosen[i]);
    return motions;
}

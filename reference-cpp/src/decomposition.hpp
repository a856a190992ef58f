// Solutions of least norm and ranks of matrices whose rows may depend on each other.
#pragma once

#include <Eigen/Dense>

// A complete orthogonal decomposition; what is rounding does not count for the rank.
class Decomposition {
public:
    explicit Decomposition(const Eigen::MatrixXd &a);

    // the solution of a x = b of least norm; of least squares, where there is none
    Eigen::VectorXd solve(const Eigen::VectorXd &b) const;
    Eigen::Index rank() const { return factors_.rank(); }

private:
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors_;
};

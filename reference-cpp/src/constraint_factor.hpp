// Factors of Phi_q M^-1 Phi_q^T. Rows of Phi are metres, radians or pure numbers, so it is scaled to a unit diagonal.
#pragma once

#include <Eigen/Dense>
#include <vector>

class ConstraintFactor {
public:
    void compute(const Eigen::MatrixXd &s);
    bool independent() const { return independent_; }
    // The rows that follow from those before them.
    static std::vector<int> dependent_rows(const Eigen::MatrixXd &s);

    Eigen::VectorXd solve(const Eigen::VectorXd &b) const {
        return scale_.cwiseProduct(factor_.solve(scale_.cwiseProduct(b)));
    }

private:
    Eigen::VectorXd scale_;
    Eigen::LDLT<Eigen::MatrixXd> factor_;
    bool independent_ = false;
};

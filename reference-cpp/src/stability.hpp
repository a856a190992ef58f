// Whether an equilibrium is stable: the eigenvalues mu of K x + Phi_q^T nu = mu M x, Phi_q x = 0.
#pragma once

#include <Eigen/Dense>

// An orthonormal basis of the motions x with Phi_q x = 0. The rows of Phi_q must be independent.
Eigen::MatrixXd permitted_motions(const Eigen::MatrixXd &phi_q);

class Stability {
public:
    // magnitude: the sums of the magnitudes of what the entries of the stiffness are the sums of; they tell its rounding
    Stability(const Eigen::MatrixXd &stiffness, const Eigen::MatrixXd &magnitude, const Eigen::MatrixXd &mass,
              const Eigen::MatrixXd &phi_q);

    bool can_move() const { return modes_.cols() > 0; }
    // The smallest mu, 1/s^2; with follower loads, whose K is not symmetric, the least real part.
    double least() const { return can_move() ? values_[0] : 0.0; }
    Eigen::VectorXd softest() const { return mode(0); } // its motion x, with x.M x = 1
    Eigen::VectorXd mode(int i) const { return modes_.col(i); } // in the order of the eigenvalues
    int negative() const;
    double rounding() const { return rounding_; } // what an eigenvalue may have by rounding
    bool is_stable() const { return !can_move() || values_[0] > rounding_; }
    bool is_unstable() const { return can_move() && values_[0] < -rounding_; }
    // Motions that nothing resists or drives, one a column.
    Eigen::MatrixXd neutral() const;

private:
    Eigen::VectorXd values_; // in ascending order
    Eigen::MatrixXd modes_;
    double rounding_ = 0.0;
};

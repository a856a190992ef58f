// The linear systems of the stabilised index-2 equations (Gear, Gupta, Leimkuhler)
//
//     r1 = M (q' - v) + Phi_q^T mu          r3 = Phi(t, q)
//     r2 = M v' + f + Phi_q^T lambda        r4 = Phi_q v + Phi_t
//
// and of the elongations of Maxwell elements, d z' - k (L - L_0 - z) = r5 with the damping d, for the implicit step q' ~ c q,
// v' ~ c v, z' ~ c z.
#pragma once

#include "constraint_factor.hpp"
#include "system.hpp"

// The matrix of all unknowns in the order (q, v, lambda, mu, z), without d(Phi_q^T mu)/dq.
SparseMatrix newton_matrix(const System &system, double c, const Inputs &inputs, const VectorXd &q, const VectorXd &v,
                           const Memory &memory, const VectorXd &lambda);

// The same system by elimination, see newton.cpp.
class DenseNewton {
public:
    explicit DenseNewton(const System &system);

    void assemble(double c, const Inputs &inputs, const VectorXd &q, const VectorXd &v,
                  const Memory &memory, const VectorXd &lambda);
    // x = J^-1 b, both ordered (q, v, lambda, mu, z)
    void solve(const Eigen::Ref<const VectorXd> &b, Eigen::Ref<VectorXd> x) const;

private:
    const System &system_;
    double c_ = 0.0;
    bool damped_ = false; // df/dv is not zero
    VectorXd phi_, phi_t_;
    MatrixXd by_v_, phi_q_, rate_by_q_, kkt_, w_, s_;
    MatrixXd pull_by_q_;       // k dL/dq of the Maxwell elements
    VectorXd elongation_pivot_; // c d + k
    Eigen::PartialPivLU<MatrixXd> lu_;
    ConstraintFactor projection_;
};

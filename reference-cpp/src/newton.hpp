// The linear systems of the stabilised index-2 equations (Gear, Gupta, Leimkuhler)
//
//     r1 = M (q' - v) + Phi_q^T mu          r3 = Phi(t, q)
//     r2 = M v' + f + Phi_q^T lambda        r4 = Phi_q v + Phi_t
//
// and of the internal states, r5 = x' - g(q, v, x), for the implicit step q' ~ c q, v' ~ c v, x' ~ c x.
#pragma once

#include "constraint_factor.hpp"
#include "system.hpp"

// The matrix of all unknowns in the order (q, v, lambda, mu, x), without d(Phi_q^T mu)/dq.
SparseMatrix newton_matrix(const System &system, double c, const Inputs &inputs, const VectorXd &q, const VectorXd &v,
                           const Memory &memory, const VectorXd &lambda);

// The same system by elimination, see newton.cpp.
class DenseNewton {
public:
    explicit DenseNewton(const System &system);

    void assemble(double c, const Inputs &inputs, const VectorXd &q, const VectorXd &v,
                  const Memory &memory, const VectorXd &lambda);
    // x = J^-1 b, both ordered (q, v, lambda, mu, x)
    void solve(const Eigen::Ref<const VectorXd> &b, Eigen::Ref<VectorXd> x) const;

private:
    void eliminate_states(const VectorXd &q, const VectorXd &v, const Memory &memory);
    // all unknowns but the internal states
    void solve_motion(const Eigen::Ref<const VectorXd> &b, Eigen::Ref<VectorXd> x) const;

    const System &system_;
    double c_ = 0.0;
    bool damped_ = false; // df/dv is not zero
    VectorXd phi_, phi_t_;
    MatrixXd by_v_, phi_q_, rate_by_q_, kkt_, w_, s_;
    MatrixXd force_by_state_, state_by_q_, state_by_v_; // df/dx; dx by dq and dv in the rows of r5
    VectorXd state_pivot_; // c - dg/dx: no state changes the rate of another
    Eigen::PartialPivLU<MatrixXd> lu_;
    ConstraintFactor projection_;
};

// The acceleration-level equations M a + f + Phi_q^T lambda = 0, Phi_q a + gamma = 0 at given (t, q, v).
//
// Coordinates of moving bodies have no mass, but their accelerations are known: those are set first, the rest of a is
// eliminated, (Phi_q M^-1 Phi_q^T) lambda = gamma - Phi_q M^-1 f, and the rows of the known coordinates give their
// multipliers. Also the projections on the constraints, which have the same matrix.
#pragma once

#include "constraint_factor.hpp"
#include "system.hpp"

// Keeps its work arrays.
class Acceleration {
public:
    explicit Acceleration(const System &system);

    // refine: one step of iterative refinement
    void solve(double t, const VectorXd &q, const VectorXd &v, const Memory &memory, bool refine);
    // Moves q to Phi = 0 and v to Phi_q v + Phi_t = 0 along M^-1 Phi_q^T; refuses larger violations than `limit`.
    void project(double t, VectorXd &q, VectorXd &v, double limit);
    // Moves v to Phi_q v + Phi_t = 0 in the same way, at any q.
    void project_velocities(double t, const VectorXd &q, VectorXd &v);
    // Power of the constraints that prescribe a motion, after `solve`.
    double prescribed_power() const { return lambda.dot(phi_t_); }

    VectorXd a, lambda;
    Inputs inputs;

private:
    void project_velocities(VectorXd &v) const;
    void linearise(double t, const VectorXd &q);
    void require_small(const VectorXd &violation, double limit, const char *what, double t) const;

    const System &system_;
    VectorXd f_, phi_, phi_t_, gamma_;
    MatrixXd phi_q_, w_, s_; // Phi_q, M^-1 Phi_q^T, Phi_q M^-1 Phi_q^T
    ConstraintFactor factor_;
};

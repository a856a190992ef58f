// Equilibrium f + Phi_q^T lambda = 0, Phi = 0 at rest, by Newton's method.
#pragma once

#include "system.hpp"

class Statics {
public:
    explicit Statics(const System &system) : system_(system), lambda_(VectorXd::Zero(system.constraints())) {}

    // From q near by, under the loads at t. False if Newton's method does not converge; q is then as it was.
    bool follow(double t, const Memory &memory, VectorXd &q);
    // From q anywhere, down to the equilibrium that a heavily damped mechanism comes to, under the loads at t = 0. Throws
    // where there is none, or where some motion is not held.
    void relax(Memory &memory, VectorXd &q);
    const VectorXd &lambda() const { return lambda_; }

private:
    void assemble(const Inputs &inputs, const Memory &memory, const VectorXd &q);
    bool is_held(double inertia) const;
    VectorXd solve(double inertia, VectorXd &next_lambda) const;

    const System &system_;
    VectorXd lambda_, force_, phi_, phi_t_;
    MatrixXd phi_q_, stiffness_;
};

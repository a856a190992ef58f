// The equations of rest, f + Phi_q^T lambda = 0 and Phi = 0, and their derivatives.
#pragma once

#include "stability.hpp"
#include "system.hpp"

struct Equilibrium {
    double t = 0.0;
    VectorXd q, lambda;
    Memory memory;
};

class StaticEquations {
public:
    explicit StaticEquations(const System &system);

    void assemble(const Equilibrium &x);
    // The rows of both equations, and their derivatives by (q, lambda) and by t.
    VectorXd residual() const;
    MatrixXd tangent() const;
    VectorXd by_time() const;
    Stability stability() const { return Stability(stiffness_, magnitude_, mass_, phi_q_); }
    // Whether stiffness and `inertia` times mass resist every motion that the constraints permit.
    bool is_held(double inertia) const;
    double largest_stiffness() const { return stiffness_.size() > 0 ? stiffness_.cwiseAbs().maxCoeff() : 0.0; }
    // Whether no force drives the motions that nothing resists.
    bool is_balanced() const;
    // The largest extent of the mechanism: the measure of what is near.
    double extent(const VectorXd &q) const;

    const System &system() const { return system_; }
    const MatrixXd &mass() const { return mass_; }

private:
    const System &system_;
    MatrixXd mass_, stiffness_, magnitude_, phi_q_;
    VectorXd applied_, force_; // f; with the forces of the constraints
    VectorXd place_;           // magnitudes of q
    VectorXd phi_, phi_t_, force_by_time_;
};

#include "failure.hpp"
#include "system.hpp"

Acceleration::Acceleration(const System &system) : system_(system) {}

void Acceleration::linearise(double t, const VectorXd &q) {
    cranks = system_.crank_angles(t);
    system_.constraint_rows(cranks, q, phi_, phi_q_, phi_t_);
    system_.reduce_mass(phi_q_, w_, s_);
    if (system_.constraints() == 0) return;
    factor_.compute(s_);
    const VectorXd pivots = factor_.vectorD();
    if (!(pivots.minCoeff() > 1e-14 * pivots.maxCoeff()))
        throw Failure(LS_BAD_INPUT, "the constraints are not independent", t);
}

void Acceleration::solve(double t, const VectorXd &q, const VectorXd &v, const VectorXd &z, bool refine) {
    linearise(t, q);
    system_.force(q, v, z, f_);
    a = -(system_.inverse_mass() * f_);
    lambda.setZero(system_.constraints());
    if (system_.constraints() == 0) return;
    system_.convective(cranks, q, v, gamma_);
    for (int pass = 0; pass < (refine ? 2 : 1); ++pass) {
        const VectorXd correction = factor_.solve(gamma_ + phi_q_ * a);
        lambda += correction;
        a.noalias() -= w_ * correction;
    }
}

void Acceleration::project(double t, VectorXd &q, VectorXd &v, double limit) {
    if (system_.constraints() == 0) return;
    constexpr double rounding = 1e-15;
    linearise(t, q);
    for (int pass = 0; pass < 3; ++pass) {
        const double drift = phi_.cwiseAbs().maxCoeff();
        if (!(drift <= limit)) throw Failure(LS_BAD_INPUT, "the positions violate the constraints", t);
        if (drift <= rounding) break;
        q.noalias() -= w_ * factor_.solve(phi_);
        linearise(t, q);
    }
    const VectorXd rate = phi_q_ * v + phi_t_;
    if (!(rate.cwiseAbs().maxCoeff() <= limit)) throw Failure(LS_BAD_INPUT, "the velocities violate the constraints", t);
    v.noalias() -= w_ * factor_.solve(rate);
}

#include "closing.hpp"

#include "decomposition.hpp"

void close_rows(const System &system, const VectorXd &target, const VectorXd &scale, VectorXd &q) {
    constexpr double closure = 1e-12; // allowed gap of a joint, m
    constexpr int most_passes = 100;
    const Inputs inputs = system.inputs(0.0);
    VectorXd phi, phi_t;
    MatrixXd phi_q;
    system.constraint_rows(inputs, q, phi, phi_q, phi_t);
    if (phi.size() == 0) return;
    phi -= target;
    double best = phi.cwiseAbs().maxCoeff();
    for (int pass = 0; pass < most_passes; ++pass) {
        const VectorXd next = q - scale.cwiseProduct(Decomposition(phi_q * scale.asDiagonal()).solve(phi));
        VectorXd rest;
        system.constraint_rows(inputs, next, rest, phi_q, phi_t);
        rest -= target;
        const double size = rest.cwiseAbs().maxCoeff();
        if (best <= closure && !(size < best)) break;
        best = size;
        q = next;
        phi = rest;
    }
    Eigen::Index worst = 0;
    if (!(phi.cwiseAbs().maxCoeff(&worst) <= closure))
        refuse(system.row_source(static_cast<int>(worst)), "the mechanism cannot be closed from this start: " +
                                                               system.row_name(static_cast<int>(worst)) +
                                                               " stays open by " + text_of(phi[worst]));
    system.check_angles(inputs, q);
}

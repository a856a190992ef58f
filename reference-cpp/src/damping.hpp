// Strain-rate damping of a cable element with the retardation time tau (Kelvin-Voigt):
// EA tau int(eps' d eps/dq) + EI tau int(kappa' d kappa/dq), eps = (r'.r' - 1)/2, kappa = r' x r''.
// Both strains are invariant under rigid motion, so a rotating bent element is not damped.
#pragma once

#include "element.hpp"

ElementVector damping_force(const CableElement &element, double tau, const double *q, const double *v);
double damping_power(const CableElement &element, double tau, const double *q, const double *v); // dissipated
// Derivatives of the force.
void damping_derivatives(const CableElement &element, double tau, const double *q, const double *v,
                         ElementMatrix &by_q, ElementMatrix &by_v);

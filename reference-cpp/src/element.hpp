// One cubic cable element of the absolute nodal coordinate formulation, eqs. 6-11.
// Coordinates: r_i, r'_i, r_j, r'_j, two components each.
#pragma once

#include <Eigen/Dense>

struct CableElement {
    double axial_stiffness;   // EA
    double bending_stiffness; // EI
    double length;
};

struct ElasticEnergy {
    double axial = 0.0, bending = 0.0;
};

using ElementVector = Eigen::Matrix<double, 8, 1>;
using ElementMatrix = Eigen::Matrix<double, 8, 8>;

ElementMatrix element_mass(double mass, double length);                                      // eq. 10
ElasticEnergy element_energy(const CableElement &element, const double *q);                  // energy of eq. 11
ElementVector element_force(const CableElement &element, const double *q);                   // dU/dq
ElementMatrix element_tangent(const CableElement &element, const double *q);                 // d2U/dq2

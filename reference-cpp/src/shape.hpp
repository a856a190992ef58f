// Shape functions of the cubic cable element, eqs. 7, 8.
#pragma once

#include <array>

#include "plane.hpp"

using Shape = std::array<double, 4>;

// s of eq. 8 at xi = x / l
inline Shape shape(double xi, double l) {
    const double xi2 = xi * xi, xi3 = xi2 * xi;
    return {1.0 - 3.0 * xi2 + 2.0 * xi3, l * (xi - 2.0 * xi2 + xi3), 3.0 * xi2 - 2.0 * xi3, l * (xi3 - xi2)};
}

// ds/dx; the first is minus the third
inline Shape slope_shape(double xi, double l) {
    const double s3 = 6.0 * (xi - xi * xi) / l;
    return {-s3, 1.0 - 4.0 * xi + 3.0 * xi * xi, s3, 3.0 * xi * xi - 2.0 * xi};
}

// d2s/dx2; the first is minus the third
inline Shape curvature_shape(double xi, double l) {
    const double s3 = (6.0 - 12.0 * xi) / (l * l);
    return {-s3, (6.0 * xi - 4.0) / l, s3, (6.0 * xi - 2.0) / l};
}

// Sum of s_a q_a for a derivative of the shape functions. Rigid translations are taken out first: only the chord
// r_j - r_i enters, so that no digits are lost to the distance of the element from the origin.
inline Vec<double> combine(const Shape &s, const double *q) {
    const double chord_x = q[4] - q[0], chord_y = q[5] - q[1];
    return {s[2] * chord_x + s[1] * q[2] + s[3] * q[6], s[2] * chord_y + s[1] * q[3] + s[3] * q[7]};
}

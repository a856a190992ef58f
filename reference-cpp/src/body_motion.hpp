// Centre of mass and chord of a body. Both are linear in its coordinates, so q, v or a may be given for x.
#pragma once

#include "bodies.hpp"

Vec<double> center(const Body &body, const Eigen::VectorXd &x);
Vec<double> chord(const Body &link, const Eigen::VectorXd &x);

// Green's strain (r'.r' - 1)/2 of largest magnitude, at eleven points of every element of a flexible link.
double largest_strain(const Body &link, const Eigen::VectorXd &q);

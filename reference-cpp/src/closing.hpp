// Newton's method of least norm for the places of an ideal mechanism.
#pragma once

#include "system.hpp"

// Moves q at t = 0 until every row has its target. scale: by coordinate, how far it moves beside others; 0 for what stays.
void close_rows(const System &system, const VectorXd &target, const VectorXd &scale, VectorXd &q);

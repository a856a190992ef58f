// Constraint rows that repeat others.
#pragma once

#include "system.hpp"

// The rows that follow from those before them throughout the motion, at t = 0. Throws at a singular pose, where rows depend on
// each other in this pose alone.
std::vector<int> redundant_rows(const System &system, const VectorXd &q);

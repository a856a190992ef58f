// Tables over time that never leave the range of two neighbouring rows: quintic pieces with a continuous second derivative.
#pragma once

#include <array>
#include <vector>

#include "dual.hpp"

// Every piece by its six control points in Bernstein's form, which rise or fall in order.
struct MonotoneTable {
    std::vector<double> t;
    std::vector<std::array<double, 6>> pieces;
};
MonotoneTable monotone_table(const std::vector<double> &t, const std::vector<double> &y);

// Beyond the ends the outer pieces go on.
Jet interpolate(const MonotoneTable &table, const Jet &t);

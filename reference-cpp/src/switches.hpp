// Where results of a formula change their sign: there `abs`, `min` and `max` switch.
#pragma once

#include "expression.hpp"

struct Watched {
    int result, rate; // and its derivative by time
};
// Two times, apart by rounding, between which signs change.
struct Switch {
    double before, after;
};

// From 0 to the end, in order. Between two of 10,001 times a result may also change its sign there and back, if it has one
// extreme in between.
std::vector<Switch> find_switches(const Expression &expression, const std::vector<Watched> &watched, double end);

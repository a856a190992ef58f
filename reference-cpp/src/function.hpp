// Functions of time: what is prescribed and what is applied.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "reference.h"

// A quantity given at one instant, with its derivatives by time.
struct Prescribed {
    double value = 0.0, rate = 0.0, acceleration = 0.0;
};

struct TimeFunction {
    ls_function_kind kind;
    std::array<double, 6> c;
};

// Checks the description; name: how to call it in an error.
TimeFunction make_function(const ls_function &function, const std::string &name);

Prescribed evaluate(const TimeFunction &function, double t);

// Adds the instants at which some derivative jumps: an integrator of high order should not step across them.
void add_breaks(const TimeFunction &function, std::vector<double> &times);

// Functions of time: what is prescribed and what is applied.
#pragma once

#include <array>
#include <variant>
#include <vector>

#include "dual.hpp"
#include "monotone.hpp"
#include "switches.hpp"

// A quantity given at one instant, with its derivatives by time.
struct Prescribed {
    double value = 0.0, rate = 0.0, acceleration = 0.0;
};

struct Constant {
    double value;
};
struct Polynomial {
    std::vector<double> coefficients; // of 1, t, t^2, ...
};
struct Harmonic {
    double mean, amplitude, frequency, phase; // mean + amplitude sin(2 pi frequency t + phase)
};
struct Ramp {
    double from, to, start, duration;
};
struct SmoothStep {
    double from, to, start, duration; // 10 u^3 - 15 u^4 + 6 u^5 of the way
};
struct PiecewiseLinear { // straight lines between the rows
    std::vector<double> t, y;
};
struct SpinUp {
    double start, speed, duration; // the rate rises from 0 to the speed as u - sin(2 pi u) / 2 pi
};
struct Spline { // natural cubic
    std::vector<double> t, y, curvature;
};
Spline natural_spline(std::vector<double> t, std::vector<double> y);

struct Formula { // an expression of the scene
    Expression expression;
    int value = 0, rate = 0, acceleration = 0; // places in it; the last two of a load are zero
    std::vector<Switch> switches; // in order
    double end = 0.0; // of the run; the expression need not have a value beyond

    Prescribed at(double t) const;
};

using TimeFunction = std::variant<Constant, Polynomial, Harmonic, Ramp, SmoothStep, PiecewiseLinear, SpinUp, Spline,
                                  MonotoneTable, Formula>;

Jet at(const TimeFunction &function, const Jet &t);
Prescribed evaluate(const TimeFunction &function, double t);

// Adds the instants at which some derivative jumps: an integrator of high order should not step across them.
void add_breaks(const TimeFunction &function, std::vector<double> &times);

// x, y and theta of a path.
using Path = std::array<TimeFunction, 3>;

#include "function.hpp"

#include <cmath>

#include "dual.hpp"
#include "failure.hpp"

namespace {

constexpr double pi = 3.14159265358979323846;

// c0 before `start`, c1 after `start + duration`, `shape` of the part of the duration that has passed between.
template <class Shape>
Jet transition(const TimeFunction &f, const Jet &t, Shape shape) {
    const double c0 = f.c[0], c1 = f.c[1], start = f.c[2], duration = f.c[3];
    if (value_of(t) <= start) return Jet(c0);
    if (value_of(t) >= start + duration) return Jet(c1);
    return c0 + (c1 - c0) * shape((t - start) / duration);
}

Jet at(const TimeFunction &f, const Jet &t) {
    const std::array<double, 6> &c = f.c;
    switch (f.kind) {
    case LS_POLYNOMIAL: {
        Jet sum(c[5]);
        for (int i = 4; i >= 0; --i) sum = sum * t + c[i];
        return sum;
    }
    case LS_HARMONIC: return c[0] + c[1] * sin(2.0 * pi * c[2] * t + c[3]);
    case LS_RAMP: return transition(f, t, [](const Jet &u) { return u; });
    case LS_SMOOTH_STEP:
        return transition(f, t, [](const Jet &u) { return u * u * u * (10.0 + u * (6.0 * u - 15.0)); });
    default: { // spin-up: the rate rises as c1 (u - sin(2 pi u) / 2 pi), u = t / T
        const double period = c[2];
        if (value_of(t) >= period) return c[0] + c[1] * (t - 0.5 * period);
        const double k = 2.0 * pi / period;
        return c[0] + c[1] / period * (0.5 * t * t + (cos(k * t) - 1.0) * (1.0 / (k * k)));
    }
    }
}

} // namespace

TimeFunction make_function(const ls_function &d, const std::string &name) {
    TimeFunction f{};
    switch (d.kind) {
    case LS_POLYNOMIAL:
    case LS_HARMONIC: break;
    case LS_RAMP:
    case LS_SMOOTH_STEP: require(d.c[3] > 0.0, name + ": the duration c3 must be positive"); break;
    case LS_SPIN_UP: require(d.c[2] > 0.0, name + ": the duration c2 must be positive"); break;
    default: throw Failure(LS_BAD_INPUT, name + ": unknown kind");
    }
    f.kind = static_cast<ls_function_kind>(d.kind);
    for (int i = 0; i < 6; ++i) {
        require(std::isfinite(d.c[i]), name + ": c" + std::to_string(i) + " is not finite");
        f.c[i] = d.c[i];
    }
    return f;
}

Prescribed evaluate(const TimeFunction &f, double t) {
    const Jet x = at(f, jet(t, 1.0, 0.0));
    return {value_of(x), rate_of(x), acceleration_of(x)};
}

void add_breaks(const TimeFunction &f, std::vector<double> &times) {
    if (f.kind == LS_RAMP || f.kind == LS_SMOOTH_STEP) {
        times.push_back(f.c[2]);
        times.push_back(f.c[2] + f.c[3]);
    }
    if (f.kind == LS_SPIN_UP) times.push_back(f.c[2]);
}

#include "function.hpp"

#include <algorithm>
#include <cmath>

namespace {

constexpr double pi = 3.14159265358979323846;

template <class... Cases>
struct Overloaded : Cases... {
    using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

// `from` before the start, `to` from the end on, `shape` of the part of the duration that has passed between.
template <class Step, class Shape>
Jet transition(const Step &f, const Jet &t, Shape shape) {
    if (value_of(t) < f.start) return Jet(f.from);
    if (value_of(t) >= f.start + f.duration) return Jet(f.to);
    return f.from + (f.to - f.from) * shape((t - f.start) / f.duration);
}

// Constant beyond the ends.
Jet interpolate(const PiecewiseLinear &p, const Jet &t) {
    if (value_of(t) < p.t.front()) return Jet(p.y.front());
    if (value_of(t) >= p.t.back()) return Jet(p.y.back());
    const auto next = std::upper_bound(p.t.begin(), p.t.end(), value_of(t));
    const std::size_t j = static_cast<std::size_t>(next - p.t.begin()), i = j - 1;
    const double h = p.t[j] - p.t[i];
    return (p.t[j] - t) / h * p.y[i] + (t - p.t[i]) / h * p.y[j];
}

// Beyond the ends the outer cubics go on: IDA steps past the time asked for.
Jet interpolate(const Spline &s, const Jet &t) {
    const auto next = std::upper_bound(s.t.begin() + 1, s.t.end() - 1, value_of(t));
    const std::size_t j = static_cast<std::size_t>(next - s.t.begin()), i = j - 1;
    const double h = s.t[j] - s.t[i];
    const Jet a = (s.t[j] - t) / h, b = (t - s.t[i]) / h;
    return a * s.y[i] + b * s.y[j] +
           ((a * a * a - a) * s.curvature[i] + (b * b * b - b) * s.curvature[j]) * (h * h / 6.0);
}

} // namespace

// The curvatures c of the knots solve a tridiagonal system, by elimination and substitution. At the ends they vanish.
Spline natural_spline(std::vector<double> t, std::vector<double> y) {
    const std::size_t n = t.size();
    std::vector<double> c(n, 0.0), diagonal(n, 1.0), upper(n, 0.0);
    for (std::size_t i = 1; i + 1 < n; ++i) {
        const double before = t[i] - t[i - 1], after = t[i + 1] - t[i];
        const double bend = 6.0 * ((y[i + 1] - y[i]) / after - (y[i] - y[i - 1]) / before);
        const double factor = i > 1 ? before / diagonal[i - 1] : 0.0;
        diagonal[i] = 2.0 * (before + after) - factor * upper[i - 1];
        upper[i] = after;
        c[i] = bend - factor * c[i - 1];
    }
    for (std::size_t i = n - 1; i-- > 1;) c[i] = (c[i] - upper[i] * c[i + 1]) / diagonal[i];
    return {std::move(t), std::move(y), std::move(c)};
}

// Beyond the end a parabola goes on. Within a switch the branches need not fit together; what follows it holds there.
Prescribed Formula::at(double t) const {
    double inside = std::min(t, end);
    const double h = t - inside;
    const auto next = std::lower_bound(switches.begin(), switches.end(), inside,
                                       [](const Switch &s, double time) { return s.after < time; });
    if (next != switches.end() && inside > next->before) inside = next->after;
    const std::vector<double> results = expression.at(inside);
    auto of = [&](int i) { return results[static_cast<std::size_t>(i)]; };
    const double r = of(rate), a = of(acceleration);
    return {of(value) + h * (r + 0.5 * h * a), r + h * a, a};
}

Jet at(const TimeFunction &function, const Jet &t) {
    return std::visit(
        Overloaded{
            [](const Constant &f) { return Jet(f.value); },
            [&](const Polynomial &f) {
                Jet sum(0.0);
                for (auto c = f.coefficients.rbegin(); c != f.coefficients.rend(); ++c) sum = sum * t + *c;
                return sum;
            },
            [&](const Harmonic &f) { return f.mean + f.amplitude * sin(2.0 * pi * f.frequency * t + f.phase); },
            [&](const Ramp &f) { return transition(f, t, [](const Jet &u) { return u; }); },
            [&](const SmoothStep &f) {
                return transition(f, t, [](const Jet &u) { return u * u * u * (10.0 + u * (6.0 * u - 15.0)); });
            },
            [&](const PiecewiseLinear &f) { return interpolate(f, t); },
            [&](const SpinUp &f) {
                if (value_of(t) >= f.duration) return f.start + f.speed * (t - 0.5 * f.duration);
                const double k = 2.0 * pi / f.duration;
                return f.start + f.speed / f.duration * (0.5 * t * t + (cos(k * t) - 1.0) * (1.0 / (k * k)));
            },
            [&](const Spline &f) { return interpolate(f, t); },
            [&](const MonotoneTable &f) { return interpolate(f, t); },
            [&](const Formula &f) { // t is the time itself, of rate 1
                const Prescribed p = f.at(value_of(t));
                return jet(p.value, p.rate, p.acceleration);
            },
        },
        function);
}

Prescribed evaluate(const TimeFunction &function, double t) {
    const Jet x = at(function, jet(t, 1.0, 0.0));
    return {value_of(x), rate_of(x), acceleration_of(x)};
}

void add_breaks(const TimeFunction &function, std::vector<double> &times) {
    auto insert = [&](const std::vector<double> &knots) { times.insert(times.end(), knots.begin(), knots.end()); };
    auto transition_ends = [&](const auto &f) {
        times.push_back(f.start);
        times.push_back(f.start + f.duration);
    };
    std::visit(Overloaded{
                   [](const auto &) {},
                   [&](const Ramp &f) { transition_ends(f); },
                   [&](const SmoothStep &f) { transition_ends(f); },
                   [&](const SpinUp &f) { times.push_back(f.duration); },
                   [&](const PiecewiseLinear &f) { insert(f.t); },
                   [&](const Spline &f) { insert(f.t); },
                   [&](const MonotoneTable &f) { insert(f.t); },
                   [&](const Formula &f) {
                       for (const Switch &s : f.switches) times.push_back(s.after);
                       times.push_back(f.end);
                   },
               },
               function);
}

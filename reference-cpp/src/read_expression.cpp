// Expressions as functions of time.
#include <array>
#include <cmath>

#include "differentiate.hpp"
#include "parse_expression.hpp"
#include "reader.hpp"
#include "switches.hpp"

namespace {

constexpr std::size_t most_characters = 1000;
constexpr int intervals = 1000; // between the times at which an expression is tried

std::string value_text(double x) { return std::isnan(x) ? "not a number" : text_of(x); }

double trial_time(int i, double duration) { return duration * (static_cast<double>(i) / intervals); }

void check_values(const ParsedExpression &parsed, const Formula &formula, const Source &source) {
    for (int i = 0; i <= intervals; ++i) {
        const double t = trial_time(i, formula.end);
        const std::vector<double> results = parsed.expression.at(t);
        auto require_finite = [&](const char *what, int result) {
            const double x = results[static_cast<std::size_t>(result)];
            require(std::isfinite(x), source,
                    std::string(what) + " must be finite; at t = " + text_of(t) + " it is " + value_text(x));
        };
        for (int base : parsed.bases) {
            const double x = results[static_cast<std::size_t>(base)];
            require(x > 0.0, source, "the base of a power whose exponent contains t must be positive; at t = " + text_of(t) +
                                         " it is " + value_text(x));
        }
        require_finite("the expression", formula.value);
        require_finite("the first derivative of a prescribed motion", formula.rate);
        require_finite("the second derivative of a prescribed motion", formula.acceleration);
    }
}

// A motion must not jump where abs, min or max switch.
class Smoothness {
public:
    Smoothness(const Formula &motion, const Expression &expression, const Source &source)
        : motion_(motion), expression_(expression), source_(source) {
        for (int i = 0; i <= intervals; ++i) look_at(trial_time(i, motion.end));
        for (std::size_t i = 1; i < motion.switches.size(); ++i)
            look_at(0.5 * (motion.switches[i - 1].after + motion.switches[i].before));
    }

    // A jump is rounding if it is small beside the largest value of its kind, or if what it adds to the velocity or the value
    // until the end is.
    void check(const Switch &s) const {
        constexpr double rounding = 1e-8;
        const char *names[3] = {"value", "velocity", "acceleration"};
        const std::array<double, 3> before = at(s.before), after = at(s.after);
        for (std::size_t k = 0; k < 3; ++k) {
            double effect = std::abs(after[k] - before[k]);
            bool small = false;
            for (std::size_t i = k + 1; i-- > 0; effect *= motion_.end) small = small || effect <= rounding * largest_[i];
            require(small, source_,
                    std::string("the ") + names[k] + " of a prescribed motion must not jump; where abs, min or max switches at t = " +
                        text_of(s.after) + " it goes from " + value_text(before[k]) + " to " + value_text(after[k]));
        }
    }

private:
    void look_at(double t) {
        const std::array<double, 3> x = at(t);
        for (std::size_t k = 0; k < 3; ++k) largest_[k] = std::max(largest_[k], std::abs(x[k]));
    }

    std::array<double, 3> at(double t) const {
        const std::vector<double> results = expression_.at(t);
        auto of = [&](int i) { return results[static_cast<std::size_t>(i)]; };
        return {of(motion_.value), of(motion_.rate), of(motion_.acceleration)};
    }

    const Formula &motion_;
    const Expression &expression_;
    const Source &source_;
    std::array<double, 3> largest_{};
};

} // namespace

// Only motions are differentiated: nothing depends on the rate of a load.
TimeFunction read_expression(const Value &value, double duration, Use use) {
    const std::string &text = as_text(value);
    require(text.find_first_not_of(" \t\r\n") != std::string::npos, value.source, "an expression must not be empty");
    require(text.size() <= most_characters, value.source,
            "an expression has at most " + std::to_string(most_characters) + " characters, not " + std::to_string(text.size()));
    ParsedExpression parsed = parse_expression(text, value.source);
    Expression &expression = parsed.expression;
    Formula formula;
    formula.value = parsed.value;
    formula.end = duration;
    std::vector<Watched> watched;
    Differentiation derivative(expression);
    for (int result : parsed.switches) watched.push_back({result, derivative.of(result)});
    formula.rate = use == Use::motion ? derivative.of(formula.value) : expression.number(0.0);
    formula.acceleration = use == Use::motion ? derivative.of(formula.rate) : formula.rate;
    check_values(parsed, formula, value.source);
    formula.switches = find_switches(expression, watched, duration);
    if (use == Use::motion) {
        const Smoothness smoothness(formula, expression, value.source);
        for (const Switch &s : formula.switches) smoothness.check(s);
    }
    formula.expression = std::move(expression);
    return formula;
}

// Expressions as functions of time.
#include <cmath>

#include "differentiate.hpp"
#include "parse_expression.hpp"
#include "reader.hpp"

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

// Instants at which a result changes its sign, one a trial interval at most, by bisection to the last bit.
void add_sign_changes(const Expression &expression, int result, double duration, std::vector<double> &times) {
    auto sign = [&](double t) {
        const double x = expression.at(t)[static_cast<std::size_t>(result)];
        return (x > 0.0) - (x < 0.0);
    };
    for (int i = 0; i < intervals; ++i) {
        double before = trial_time(i, duration), after = trial_time(i + 1, duration);
        const int start = sign(before);
        if (sign(after) == start) continue;
        for (double middle = 0.5 * (before + after); middle > before && middle < after; middle = 0.5 * (before + after))
            (sign(middle) == start ? before : after) = middle;
        times.push_back(after);
    }
}

} // namespace

// Only motions are differentiated: nothing depends on the rate of a load.
TimeFunction read_expression(const Value &value, double duration, Use use) {
    const std::string &text = as_text(value);
    require(text.find_first_not_of(" \t\r\n") != std::string::npos, value.source, "an expression must not be empty");
    require(text.size() <= most_characters, value.source,
            "an expression has at most " + std::to_string(most_characters) + " characters, not " + std::to_string(text.size()));
    ParsedExpression parsed = parse_expression(text, value.source);
    Formula formula;
    formula.value = parsed.value;
    formula.end = duration;
    if (use == Use::motion) {
        require(parsed.kinks.empty(), value.source, "abs, min and max cannot prescribe a motion, because its rate jumps");
        Differentiation derivative(parsed.expression);
        formula.rate = derivative.of(formula.value);
        formula.acceleration = derivative.of(formula.rate);
    } else {
        formula.rate = formula.acceleration = parsed.expression.number(0.0);
    }
    check_values(parsed, formula, value.source);
    for (int result : parsed.kinks) add_sign_changes(parsed.expression, result, duration, formula.kinks);
    formula.expression = std::move(parsed.expression);
    return formula;
}

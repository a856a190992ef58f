#include "expression.hpp"

#include <cmath>

namespace {

// The derivative of 10 u^3 - 15 u^4 + 6 u^5 of the given order, with u between 0 and 1; constant beyond.
double smooth_step(double u, int order) {
    if (std::isnan(u)) return u;
    if (u <= 0.0 || u >= 1.0) return order == 0 && u > 0.0 ? 1.0 : 0.0;
    if (order == 0) return u * u * u * (10.0 + u * (6.0 * u - 15.0));
    if (order == 1) return 30.0 * u * u * (1.0 - u) * (1.0 - u);
    return 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u);
}

double result(Operator op, double a, double b) {
    switch (op) {
    case Operator::negative: return -a;
    case Operator::sum: return a + b;
    case Operator::difference: return a - b;
    case Operator::product: return a * b;
    case Operator::quotient: return a / b;
    case Operator::power: return std::pow(a, b);
    case Operator::sin: return std::sin(a);
    case Operator::cos: return std::cos(a);
    case Operator::tan: return std::tan(a);
    case Operator::asin: return std::asin(a);
    case Operator::acos: return std::acos(a);
    case Operator::atan: return std::atan(a);
    case Operator::sinh: return std::sinh(a);
    case Operator::cosh: return std::cosh(a);
    case Operator::tanh: return std::tanh(a);
    case Operator::exp: return std::exp(a);
    case Operator::log: return std::log(a);
    case Operator::sqrt: return std::sqrt(a);
    case Operator::abs: return std::abs(a);
    case Operator::smooth_step: return smooth_step(a, 0);
    case Operator::smooth_step_rate: return smooth_step(a, 1);
    case Operator::smooth_step_bend: return smooth_step(a, 2);
    case Operator::atan2: return std::atan2(a, b);
    // what is not a number stays so, on either side
    case Operator::min: return std::isnan(b) || b < a ? b : a;
    case Operator::max: return std::isnan(b) || b > a ? b : a;
    default: return std::nan("");
    }
}

} // namespace

int Expression::add(const Operation &operation) {
    operations_.push_back(operation);
    return static_cast<int>(operations_.size()) - 1;
}

int Expression::number(double value) { return add({Operator::number, 0, 0, value}); }

int Expression::time() { return add({Operator::time}); }

int Expression::apply(Operator op, int a, int b) {
    if (is_number(a) && is_number(b)) return number(result(op, operation(a).value, operation(b).value));
    return add({op, a, b});
}

int Expression::choice(int a, int b, int c) { return add({Operator::choice, a, b, 0.0, c}); }

std::vector<double> Expression::at(double t) const {
    std::vector<double> results;
    results.reserve(operations_.size());
    auto of = [&](int i) { return results[static_cast<std::size_t>(i)]; };
    for (const Operation &o : operations_)
        switch (o.op) {
        case Operator::number: results.push_back(o.value); break;
        case Operator::time: results.push_back(t); break;
        case Operator::choice: results.push_back(of(of(o.c) >= 0.0 ? o.a : o.b)); break;
        default: results.push_back(result(o.op, of(o.a), of(o.b)));
        }
    return results;
}

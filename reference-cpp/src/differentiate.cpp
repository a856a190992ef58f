#include "differentiate.hpp"

#include "failure.hpp"

int Differentiation::of(int result) {
    for (int i = static_cast<int>(known_.size()); i <= result; ++i) known_.push_back(rule(i));
    return known_[static_cast<std::size_t>(result)];
}

int Differentiation::rule(int i) {
    const Operation o = e_.operation(i);
    if (o.op == Operator::number || o.op == Operator::time) return o.op == Operator::time ? one_ : zero_;
    const int a = o.a, b = o.b, da = known_[static_cast<std::size_t>(a)], db = known_[static_cast<std::size_t>(b)];
    auto under_root = [&] { return product(difference(one_, a), sum(one_, a)); }; // 1 - a^2
    switch (o.op) {
    case Operator::negative: return negative(da);
    case Operator::sum: return sum(da, db);
    case Operator::difference: return difference(da, db);
    case Operator::product: return sum(product(da, b), product(a, db));
    case Operator::quotient: return quotient(difference(da, product(i, db)), b);
    case Operator::power: return product(product(b, power(a, e_.operation(b).value - 1.0)), da);
    case Operator::sin: return product(e_.apply(Operator::cos, a), da);
    case Operator::cos: return negative(product(e_.apply(Operator::sin, a), da));
    case Operator::tan: return product(sum(one_, product(i, i)), da);
    case Operator::asin: return quotient(da, e_.apply(Operator::sqrt, under_root()));
    case Operator::acos: return negative(quotient(da, e_.apply(Operator::sqrt, under_root())));
    case Operator::atan: return quotient(da, sum(one_, product(a, a)));
    case Operator::sinh: return product(e_.apply(Operator::cosh, a), da);
    case Operator::cosh: return product(e_.apply(Operator::sinh, a), da);
    case Operator::tanh: return product(difference(one_, product(i, i)), da);
    case Operator::exp: return product(i, da);
    case Operator::log: return quotient(da, a);
    case Operator::sqrt: return quotient(da, product(e_.number(2.0), i));
    case Operator::atan2:
        return quotient(difference(product(b, da), product(a, db)), sum(product(a, a), product(b, b)));
    case Operator::smooth_step: return product(e_.apply(Operator::smooth_step_rate, a), da);
    case Operator::smooth_step_rate: return product(e_.apply(Operator::smooth_step_bend, a), da);
    case Operator::abs: return choice(da, negative(da), a);
    case Operator::max: return choice(da, db, difference(a, b));
    case Operator::min: return choice(db, da, difference(a, b));
    case Operator::choice: return choice(da, db, o.c);
    default: throw Failure(LS_INTERNAL, "a formula is differentiated more often than it can be");
    }
}

int Differentiation::sum(int a, int b) {
    if (e_.is(a, 0.0)) return b;
    return e_.is(b, 0.0) ? a : e_.apply(Operator::sum, a, b);
}

int Differentiation::difference(int a, int b) {
    if (e_.is(b, 0.0)) return a;
    return e_.is(a, 0.0) ? negative(b) : e_.apply(Operator::difference, a, b);
}

int Differentiation::product(int a, int b) {
    if (e_.is(a, 0.0) || e_.is(b, 1.0)) return a;
    return e_.is(b, 0.0) || e_.is(a, 1.0) ? b : e_.apply(Operator::product, a, b);
}

int Differentiation::quotient(int a, int b) {
    return e_.is(a, 0.0) || e_.is(b, 1.0) ? a : e_.apply(Operator::quotient, a, b);
}

int Differentiation::choice(int a, int b, int c) { return a == b ? a : e_.choice(a, b, c); }

int Differentiation::power(int a, double exponent) {
    if (exponent == 0.0) return one_;
    return exponent == 1.0 ? a : e_.apply(Operator::power, a, e_.number(exponent));
}

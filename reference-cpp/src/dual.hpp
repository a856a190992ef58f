// Forward automatic differentiation.
//
// Dual<S, N> carries a value and its derivatives by N independent variables. Nesting (S a Dual itself) gives second
// derivatives. Formulas of the mechanics are templates over the scalar: double evaluates them, Dual differentiates them.
#pragma once

#include <array>
#include <cmath>

template <class S, int N>
struct Dual {
    S value;
    std::array<S, N> slope;

    Dual(double constant = 0.0) : value(constant) { slope.fill(S(0.0)); }

    Dual &operator+=(const Dual &b) {
        value += b.value;
        for (int i = 0; i < N; ++i) slope[i] += b.slope[i];
        return *this;
    }
    Dual &operator-=(const Dual &b) {
        value -= b.value;
        for (int i = 0; i < N; ++i) slope[i] -= b.slope[i];
        return *this;
    }
};

inline double value_of(double x) { return x; }
template <class S, int N>
double value_of(const Dual<S, N> &x) { return value_of(x.value); }

// f(x) from f and f' at the value of x.
template <class S, int N>
Dual<S, N> chain(const Dual<S, N> &x, const S &f, const S &derivative) {
    Dual<S, N> r;
    r.value = f;
    for (int i = 0; i < N; ++i) r.slope[i] = derivative * x.slope[i];
    return r;
}

template <class S, int N>
Dual<S, N> operator+(Dual<S, N> a, const Dual<S, N> &b) { return a += b; }
template <class S, int N>
Dual<S, N> operator+(Dual<S, N> a, double b) { a.value += b; return a; }
template <class S, int N>
Dual<S, N> operator+(double a, Dual<S, N> b) { b.value += a; return b; }

template <class S, int N>
Dual<S, N> operator-(const Dual<S, N> &a) {
    Dual<S, N> r;
    r.value = -a.value;
    for (int i = 0; i < N; ++i) r.slope[i] = -a.slope[i];
    return r;
}
template <class S, int N>
Dual<S, N> operator-(Dual<S, N> a, const Dual<S, N> &b) { return a -= b; }
template <class S, int N>
Dual<S, N> operator-(Dual<S, N> a, double b) { a.value -= b; return a; }
template <class S, int N>
Dual<S, N> operator-(double a, const Dual<S, N> &b) { return a + -b; }

template <class S, int N>
Dual<S, N> operator*(const Dual<S, N> &a, const Dual<S, N> &b) {
    Dual<S, N> r;
    r.value = a.value * b.value;
    for (int i = 0; i < N; ++i) r.slope[i] = a.slope[i] * b.value + a.value * b.slope[i];
    return r;
}
template <class S, int N>
Dual<S, N> operator*(Dual<S, N> a, double b) {
    a.value = a.value * b;
    for (int i = 0; i < N; ++i) a.slope[i] = a.slope[i] * b;
    return a;
}
template <class S, int N>
Dual<S, N> operator*(double a, const Dual<S, N> &b) { return b * a; }

template <class S, int N>
Dual<S, N> operator/(const Dual<S, N> &a, const Dual<S, N> &b) {
    const S inverse = 1.0 / b.value;
    Dual<S, N> r;
    r.value = a.value * inverse;
    for (int i = 0; i < N; ++i) r.slope[i] = (a.slope[i] - r.value * b.slope[i]) * inverse;
    return r;
}
template <class S, int N>
Dual<S, N> operator/(const Dual<S, N> &a, double b) { return a * (1.0 / b); }
template <class S, int N>
Dual<S, N> operator/(double a, const Dual<S, N> &b) { return Dual<S, N>(a) / b; }

template <class S, int N>
Dual<S, N> sqrt(const Dual<S, N> &x) {
    using std::sqrt;
    const S root = sqrt(x.value);
    return chain(x, root, S(0.5 / root));
}
template <class S, int N>
Dual<S, N> sin(const Dual<S, N> &x) {
    using std::cos;
    using std::sin;
    return chain(x, S(sin(x.value)), S(cos(x.value)));
}
template <class S, int N>
Dual<S, N> cos(const Dual<S, N> &x) {
    using std::cos;
    using std::sin;
    return chain(x, S(cos(x.value)), S(-sin(x.value)));
}
template <class S, int N>
Dual<S, N> exp(const Dual<S, N> &x) {
    using std::exp;
    const S f = exp(x.value);
    return chain(x, f, f);
}
template <class S, int N>
Dual<S, N> tanh(const Dual<S, N> &x) {
    using std::tanh;
    const S f = tanh(x.value);
    return chain(x, f, S(1.0 - f * f));
}
template <class S, int N>
Dual<S, N> acos(const Dual<S, N> &x) {
    using std::acos;
    using std::sqrt;
    return chain(x, S(acos(x.value)), S(-1.0 / sqrt(1.0 - x.value * x.value)));
}
template <class S, int N>
Dual<S, N> pow(const Dual<S, N> &x, double exponent) {
    using std::pow;
    return chain(x, S(pow(x.value, exponent)), S(exponent * pow(x.value, exponent - 1.0)));
}
template <class S, int N>
Dual<S, N> atan2(const Dual<S, N> &y, const Dual<S, N> &x) {
    using std::atan2;
    const S inverse = 1.0 / (x.value * x.value + y.value * y.value);
    Dual<S, N> r;
    r.value = atan2(y.value, x.value);
    for (int i = 0; i < N; ++i) r.slope[i] = (x.value * y.slope[i] - y.value * x.slope[i]) * inverse;
    return r;
}

// A function of time with its first two derivatives.
using Jet = Dual<Dual<double, 1>, 1>;

inline Jet jet(double f, double rate, double acceleration) {
    Jet r;
    r.value.value = f;
    r.value.slope[0] = rate;
    r.slope[0].value = rate;
    r.slope[0].slope[0] = acceleration;
    return r;
}
inline double rate_of(const Jet &x) { return x.slope[0].value; }
inline double acceleration_of(const Jet &x) { return x.slope[0].slope[0]; }

// Derivatives of formulas by time, by the rules of calculus.
#pragma once

#include "expression.hpp"

class Differentiation {
public:
    explicit Differentiation(Expression &expression) : e_(expression), zero_(e_.number(0.0)), one_(e_.number(1.0)) {}
    // Adds the derivative of a result to the expression, and returns its place. At a kink it is that of one side.
    int of(int result);

private:
    int rule(int i);
    // Operators that leave out what a zero or a one makes trivial: 0 times an infinite factor is 0 in a derivative.
    int negative(int a) { return e_.apply(Operator::negative, a); }
    int sum(int a, int b);
    int difference(int a, int b);
    int product(int a, int b);
    int quotient(int a, int b);
    int power(int a, double exponent);
    int choice(int a, int b, int c);

    Expression &e_;
    const int zero_, one_;
    std::vector<int> known_; // derivatives of the first results
};

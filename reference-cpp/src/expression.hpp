// A formula in t as a list of operations on numbers, on t and on earlier results.
//
// It is an expression tree whose equal branches are shared: the derivatives of a branch use the branch itself, so those of a
// long formula stay short.
#pragma once

#include <vector>

enum class Operator {
    number, time, // without operands
    negative, sum, difference, product, quotient,
    power, // its exponent is a number
    sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, exp, log, sqrt, abs,
    smooth_step, smooth_step_rate, smooth_step_bend, // and its derivatives
    atan2, min, max,
    choice, // of three operands: a where the third is not negative, otherwise b
};

struct Operation {
    Operator op;
    int a = 0, b = 0;   // results it works on
    double value = 0.0; // of a number
    int c = 0;          // the third result of a choice
};

class Expression {
public:
    // These return the place of the result. Operations on numbers alone are carried out at once.
    int number(double value);
    int time();
    int apply(Operator op, int a) { return apply(op, a, a); } // operators of one operand do not look at the other
    int apply(Operator op, int a, int b);
    int choice(int a, int b, int c);

    const Operation &operation(int i) const { return operations_[static_cast<std::size_t>(i)]; }
    bool is_number(int i) const { return operation(i).op == Operator::number; }
    bool is(int i, double value) const { return is_number(i) && operation(i).value == value; }

    std::vector<double> at(double t) const; // all results

private:
    int add(const Operation &operation);

    std::vector<Operation> operations_;
};

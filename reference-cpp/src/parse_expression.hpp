// The grammar of expressions.
#pragma once

#include "expression.hpp"
#include "failure.hpp"

struct ParsedExpression {
    Expression expression;
    int value = 0;          // the result that the text stands for
    // results that vanish where a derivative may jump: arguments of abs, differences of those of min and max, ends of steps
    std::vector<int> switches;
    std::vector<int> bases;    // results that must be positive: of powers whose exponent contains t
};

ParsedExpression parse_expression(const std::string &text, const Source &source);

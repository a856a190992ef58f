// The grammar of expressions.
#pragma once

#include "expression.hpp"
#include "failure.hpp"

struct ParsedExpression {
    Expression expression;
    int value = 0;          // the result that the text stands for
    std::vector<int> kinks; // results that vanish at a kink: arguments of abs, differences of those of min and max
    std::vector<int> bases; // results that must be positive: of powers whose exponent contains t
};

ParsedExpression parse_expression(const std::string &text, const Source &source);

// Recursive descent:
//
//     sum      =  product { ("+" | "-") product }
//     product  =  factor { ("*" | "/") factor }
//     factor   =  ("+" | "-") factor  |  power
//     power    =  operand [ ("^" | "**") factor ]
//     operand  =  number  |  "t"  |  "pi"  |  function "(" sum { "," sum } ")"  |  "(" sum ")"
#include "parse_expression.hpp"

#include <cmath>
#include <cstdlib>

#include "tokens.hpp"

namespace {

constexpr double pi = 3.14159265358979323846;

struct Function {
    const char *name;
    Operator op;
    int arguments;
};
constexpr Function functions[] = {
    {"abs", Operator::abs, 1},   {"acos", Operator::acos, 1}, {"asin", Operator::asin, 1}, {"atan", Operator::atan, 1},
    {"atan2", Operator::atan2, 2}, {"cos", Operator::cos, 1}, {"cosh", Operator::cosh, 1}, {"exp", Operator::exp, 1},
    {"log", Operator::log, 1},   {"max", Operator::max, 2},   {"min", Operator::min, 2},   {"sin", Operator::sin, 1},
    {"sinh", Operator::sinh, 1}, {"smooth_step", Operator::smooth_step, 1},                {"sqrt", Operator::sqrt, 1},
    {"tan", Operator::tan, 1},   {"tanh", Operator::tanh, 1},
};

class Parser {
public:
    Parser(const std::string &text, const Source &source) : source_(source), tokens_(tokens_of(text, source)) {}

    ParsedExpression parse() {
        out_.value = sum();
        const Token &next = token();
        if (next.kind == Token::symbol && next.text != "(") fail(next, quoted(next) + " does not belong here");
        if (next.kind != Token::end) fail(next, "an operator is missing before " + quoted(next));
        return std::move(out_);
    }

private:
    const Token &token() const { return tokens_[next_]; }
    bool take(const char *symbol) {
        const bool found = token().kind == Token::symbol && token().text == symbol;
        if (found) ++next_;
        return found;
    }
    void need(const char *symbol) {
        if (!take(symbol)) fail(token(), "`" + std::string(symbol) + "` is expected, not " + quoted(token()));
    }
    static std::string quoted(const Token &token) { return token.kind == Token::end ? "the end" : "`" + token.text + "`"; }
    [[noreturn]] void fail(const Token &at, const std::string &message) const { refuse_at(at.place, source_, message); }

    int apply(Operator op, int a, int b) { return out_.expression.apply(op, a, b); }

    int sum() {
        int left = product();
        for (;;)
            if (take("+"))
                left = apply(Operator::sum, left, product());
            else if (take("-"))
                left = apply(Operator::difference, left, product());
            else
                return left;
    }

    int product() {
        int left = factor();
        for (;;)
            if (take("*"))
                left = apply(Operator::product, left, factor());
            else if (take("/"))
                left = apply(Operator::quotient, left, factor());
            else
                return left;
    }

    int factor() {
        if (take("-")) return out_.expression.apply(Operator::negative, factor());
        return take("+") ? factor() : power();
    }

    // With t in its exponent a power is exp(exponent log(base)).
    int power() {
        const int base = operand();
        if (!take("^") && !take("**")) return base;
        const int exponent = factor();
        if (out_.expression.is_number(exponent)) return apply(Operator::power, base, exponent);
        out_.bases.push_back(base);
        const int logarithm = out_.expression.apply(Operator::log, base);
        return out_.expression.apply(Operator::exp, apply(Operator::product, exponent, logarithm));
    }

    int operand() {
        if (take("(")) {
            const int inside = sum();
            need(")");
            return inside;
        }
        const Token first = token();
        if (first.kind == Token::number || first.kind == Token::name) ++next_;
        if (first.kind == Token::number) return number(first);
        if (first.kind == Token::name) return named(first);
        fail(first, "a number, a name or `(` is expected, not " + quoted(first));
    }

    int number(const Token &word) {
        const double value = std::strtod(word.text.c_str(), nullptr);
        if (!std::isfinite(value)) fail(word, quoted(word) + " is too large");
        return out_.expression.number(value);
    }

    int named(const Token &name) {
        if (name.text == "t") return out_.expression.time();
        if (name.text == "pi") return out_.expression.number(pi);
        for (const Function &function : functions)
            if (name.text == function.name) return call(name, function);
        std::string known = "t, pi";
        for (const Function &function : functions) known += ", " + std::string(function.name);
        fail(name, "there is no " + quoted(name) + "; known are " + known);
    }

    int call(const Token &name, const Function &function) {
        if (!take("(")) fail(token(), quoted(name) + " needs its arguments in parentheses");
        std::vector<int> arguments;
        do arguments.push_back(sum());
        while (take(","));
        need(")");
        const int count = static_cast<int>(arguments.size()), first = arguments.front(), last = arguments.back();
        if (count != function.arguments)
            fail(name, quoted(name) + " takes " + (function.arguments == 1 ? "one argument" : "two arguments") + ", not " +
                           std::to_string(count));
        if (function.op == Operator::abs) out_.switches.push_back(first);
        if (function.op == Operator::min || function.op == Operator::max)
            out_.switches.push_back(apply(Operator::difference, first, last));
        if (function.op == Operator::smooth_step) {
            out_.switches.push_back(first);
            out_.switches.push_back(apply(Operator::difference, first, out_.expression.number(1.0)));
        }
        return apply(function.op, first, last);
    }

    const Source &source_;
    std::vector<Token> tokens_;
    std::size_t next_ = 0;
    ParsedExpression out_;
};

} // namespace

ParsedExpression parse_expression(const std::string &text, const Source &source) { return Parser(text, source).parse(); }

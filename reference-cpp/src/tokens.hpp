// The words of an expression: numbers, names and symbols.
#pragma once

#include <string>
#include <vector>

#include "failure.hpp"

struct Token {
    enum Kind { number, name, symbol, end } kind;
    std::string text;
    std::size_t place; // of its first character, from 1 on
};

// The last one is an `end`.
std::vector<Token> tokens_of(const std::string &text, const Source &source);

[[noreturn]] void refuse_at(std::size_t place, const Source &source, const std::string &message);

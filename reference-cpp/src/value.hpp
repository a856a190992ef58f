// A TOML document as a tree of values that know where they stand. Nothing else of the library sees the TOML parser.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "failure.hpp"

struct Value {
    enum Kind { table, array, string, integer, real, boolean, other } kind = table;
    Source source;
    std::string text;                                   // string
    double number = 0.0;                                // integer, real
    bool flag = false;                                  // boolean
    std::vector<Value> items;                           // array
    std::vector<std::pair<std::string, Value>> entries; // table, in the order of the file

    bool is_number() const { return kind == integer || kind == real; }
    const Value *find(const std::string &key) const;
    Value *find(const std::string &key);
};

Value parse_toml(const std::string &text);

// Applies "path.of.a.key = value" in TOML syntax: replaces the value or adds it.
void override_value(Value &root, const std::string &assignment);

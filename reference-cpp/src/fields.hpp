// Reads the keys of a table, with their types and bounds, and refuses those that nobody asked for.
#pragma once

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "plane.hpp"
#include "value.hpp"

const Value &as_table(const Value &value);
const Value &as_array(const Value &value);
double as_number(const Value &value);
const std::string &as_text(const Value &value);
Vec<double> as_pair(const Value &value);
std::vector<double> as_numbers(const Value &value, std::size_t size);
std::vector<std::string> as_texts(const Value &value);

class Fields {
public:
    explicit Fields(const Value &table) : table_(as_table(table)) {}

    const Source &source() const { return table_.source; }
    const Source &source(const char *key) const;
    bool has(const char *key) { return find(key) != nullptr; }
    const Value *find(const char *key); // null where the key is missing
    const Value &get(const char *key);  // refuses a missing key

    double number(const char *key) { return as_number(get(key)); }
    double number(const char *key, double otherwise);
    double positive(const char *key);
    double positive(const char *key, double otherwise);
    double not_negative(const char *key);
    double not_negative(const char *key, double otherwise);
    int count(const char *key, int least, int most);
    bool flag(const char *key, bool otherwise);
    const std::string &text(const char *key) { return as_text(get(key)); }
    Vec<double> pair(const char *key) { return as_pair(get(key)); }

    // One of several words.
    template <class T>
    T choice(const char *key, std::initializer_list<std::pair<const char *, T>> words) {
        const std::string &word = text(key);
        std::string list;
        for (const auto &[name, value] : words) {
            if (word == name) return value;
            list += (list.empty() ? "\"" : ", \"") + std::string(name) + "\"";
        }
        refuse(get(key).source, "\"" + word + "\" is none of " + list);
    }

    // To be called when everything has been read: refuses keys that are left.
    void finish() const;

private:
    const Value &table_;
    std::vector<std::string> known_;
};

#include "fields.hpp"

#include <algorithm>
#include <cmath>

namespace {

const char *kind_name(const Value &value) {
    switch (value.kind) {
    case Value::table: return "a table";
    case Value::array: return "an array";
    case Value::string: return "a string";
    case Value::integer:
    case Value::real: return "a number";
    case Value::boolean: return "a boolean";
    default: return "a date or time";
    }
}

const Value &of_kind(const Value &value, bool fits, const char *expected) {
    require(fits, value.source, std::string("must be ") + expected + ", not " + kind_name(value));
    return value;
}

} // namespace

const Value &as_table(const Value &v) { return of_kind(v, v.kind == Value::table, "a table"); }
const Value &as_array(const Value &v) { return of_kind(v, v.kind == Value::array, "an array"); }
const std::string &as_text(const Value &v) { return of_kind(v, v.kind == Value::string, "a string").text; }

double as_number(const Value &v) {
    of_kind(v, v.is_number(), "a number");
    require(std::isfinite(v.number), v.source, "must be finite");
    return v.number;
}

std::vector<double> as_numbers(const Value &v, std::size_t size) {
    as_array(v);
    require(v.items.size() == size, v.source, "must have " + std::to_string(size) + " numbers");
    std::vector<double> numbers;
    for (const Value &item : v.items) numbers.push_back(as_number(item));
    return numbers;
}

Vec<double> as_pair(const Value &v) {
    const std::vector<double> numbers = as_numbers(v, 2);
    return {numbers[0], numbers[1]};
}

std::vector<std::string> as_texts(const Value &v) {
    std::vector<std::string> texts;
    for (const Value &item : as_array(v).items) texts.push_back(as_text(item));
    return texts;
}

const Source &Fields::source(const char *key) const {
    const Value *value = table_.find(key);
    return value ? value->source : table_.source;
}

const Value *Fields::find(const char *key) {
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
    return table_.find(key);
}

const Value &Fields::get(const char *key) {
    const Value *value = find(key);
    if (value) return *value;
    std::string present;
    for (const auto &[name, entry] : table_.entries) present += (present.empty() ? "" : ", ") + name;
    refuse(table_.source, "the key `" + std::string(key) + "` is missing; the table has: " + present);
}

double Fields::number(const char *key, double otherwise) {
    const Value *value = find(key);
    return value ? as_number(*value) : otherwise;
}

double Fields::positive(const char *key) {
    const double x = number(key);
    require(x > 0.0, source(key), "must be positive");
    return x;
}

double Fields::positive(const char *key, double otherwise) { return has(key) ? positive(key) : otherwise; }

double Fields::not_negative(const char *key) {
    const double x = number(key);
    require(x >= 0.0, source(key), "must not be negative");
    return x;
}

double Fields::not_negative(const char *key, double otherwise) { return has(key) ? not_negative(key) : otherwise; }

int Fields::count(const char *key, int least, int most) {
    const Value &value = get(key);
    const double x = as_number(value);
    require(x == std::floor(x) && x >= least && x <= most, value.source,
            "must be an integer from " + std::to_string(least) + " to " + std::to_string(most));
    return static_cast<int>(x);
}

bool Fields::flag(const char *key, bool otherwise) {
    const Value *value = find(key);
    if (!value) return otherwise;
    return of_kind(*value, value->kind == Value::boolean, "true or false").flag;
}

void Fields::finish() const {
    for (const auto &[name, value] : table_.entries) {
        if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
        std::string known;
        for (const std::string &key : known_) known += (known.empty() ? "" : ", ") + key;
        refuse(value.source, "the key `" + name + "` has no meaning here; known are: " + known);
    }
}

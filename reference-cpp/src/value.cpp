#include "value.hpp"

#include <algorithm>
#include <toml++/toml.h>

namespace {

Source place(const std::string &field, const toml::source_region &region) {
    return {field, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

Value convert(const toml::node &node, const Source &source);

Value convert_table(const toml::table &table, const Source &source) {
    std::vector<std::pair<const toml::key *, const toml::node *>> nodes;
    for (auto &&[key, node] : table) nodes.emplace_back(&key, &node);
    auto position = [](const toml::key *key) {
        const auto &begin = key->source().begin;
        return std::pair(begin.line, begin.column);
    };
    // toml++ sorts by name
    std::stable_sort(nodes.begin(), nodes.end(),
                     [&](const auto &a, const auto &b) { return position(a.first) < position(b.first); });
    Value value;
    value.source = source;
    for (const auto &[key, node] : nodes) {
        const std::string name(key->str());
        const std::string field = source.field.empty() ? name : source.field + "." + name;
        value.entries.emplace_back(name, convert(*node, place(field, key->source())));
    }
    return value;
}

Value convert(const toml::node &node, const Source &source) {
    if (const toml::table *table = node.as_table()) return convert_table(*table, source);
    Value value;
    value.source = source;
    if (const toml::array *array = node.as_array()) {
        value.kind = Value::array;
        for (const toml::node &item : *array)
            value.items.push_back(convert(item, place(source.field, item.source())));
    } else if (const auto *text = node.as_string()) {
        value.kind = Value::string;
        value.text = text->get();
    } else if (const auto *integer = node.as_integer()) {
        value.kind = Value::integer;
        value.number = static_cast<double>(integer->get());
    } else if (const auto *real = node.as_floating_point()) {
        value.kind = Value::real;
        value.number = real->get();
    } else if (const auto *flag = node.as_boolean()) {
        value.kind = Value::boolean;
        value.flag = flag->get();
    } else {
        value.kind = Value::other;
    }
    return value;
}

toml::table parsed(const std::string &text, const Source *source) {
    try {
        return toml::parse(text);
    } catch (const toml::parse_error &e) {
        refuse(source ? *source : place("", e.source()), std::string(e.description()));
    }
}

// Where the first `=` outside quotes stands.
std::size_t find_equals(const std::string &text) {
    char quote = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quote != 0)
            quote = c == quote ? 0 : quote;
        else if (c == '"' || c == '\'')
            quote = c;
        else if (c == '=')
            return i;
    }
    return std::string::npos;
}

// A value of an override stands nowhere in the file.
void mark(Value &value, const std::string &field) {
    value.source = {field, 0, 0};
    for (Value &item : value.items) mark(item, field);
    for (auto &[key, entry] : value.entries) mark(entry, field + "." + key);
}

} // namespace

const Value *Value::find(const std::string &key) const {
    for (const auto &[name, value] : entries)
        if (name == key) return &value;
    return nullptr;
}

Value *Value::find(const std::string &key) { return const_cast<Value *>(std::as_const(*this).find(key)); }

Value parse_toml(const std::string &text) { return convert_table(parsed(text, nullptr), {"", 1, 1}); }

void override_value(Value &root, const std::string &assignment) {
    const Source source{"override `" + assignment + "`", 0, 0};
    const std::size_t equals = find_equals(assignment);
    require(equals != std::string::npos, source, "an override is written path.of.a.key=value");
    const std::string path = assignment.substr(0, equals);
    const toml::table keys = parsed(path + " = 0", &source);
    const toml::table wrapped = parsed("value = " + assignment.substr(equals + 1), &source);
    require(wrapped.size() == 1, source, "an override has one value");
    Value replacement = convert(*wrapped.get("value"), {});

    Value *target = &root;
    const toml::table *level = &keys;
    std::string field;
    for (;;) {
        const std::string key(level->begin()->first.str());
        const toml::node &next = level->begin()->second;
        field += (field.empty() ? "" : ".") + key;
        require(target->kind == Value::table, source, target->source.field + " is not a table");
        Value *entry = target->find(key);
        if (!entry) {
            target->entries.emplace_back(key, Value{});
            entry = &target->entries.back().second;
            entry->source = {field, 0, 0};
        }
        target = entry;
        level = next.as_table();
        if (!level) break;
    }
    mark(replacement, field);
    *target = std::move(replacement);
}

#include "tokens.hpp"

#include <cstring>

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_in_name(char c) { return is_letter(c) || is_digit(c); }
bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool is_symbol(char c) { return c != 0 && std::strchr("+-*/^(),", c); }
bool is_inside_utf8(char c) { return (c & 0xC0) == 0x80; }

} // namespace

void refuse_at(std::size_t place, const Source &source, const std::string &message) {
    refuse(source, message + " (character " + std::to_string(place) + " of the expression)");
}

// Ends of words are looked up through at(), which is 0 beyond the text.
std::vector<Token> tokens_of(const std::string &text, const Source &source) {
    std::vector<Token> tokens;
    std::size_t i = 0;
    auto at = [&](std::size_t k) { return k < text.size() ? text[k] : '\0'; };
    auto skip = [&](bool (*belongs)(char)) {
        while (i < text.size() && belongs(text[i])) ++i;
    };
    for (skip(is_space); i < text.size(); skip(is_space)) {
        const std::size_t start = i;
        Token::Kind kind = Token::symbol;
        if (is_digit(text[i]) || (text[i] == '.' && is_digit(at(i + 1)))) {
            kind = Token::number;
            skip(is_digit);
            if (at(i) == '.') {
                ++i;
                skip(is_digit);
            }
            const std::size_t power = at(i + 1) == '+' || at(i + 1) == '-' ? i + 2 : i + 1;
            if ((at(i) == 'e' || at(i) == 'E') && is_digit(at(power))) {
                i = power;
                skip(is_digit);
            }
        } else if (is_letter(text[i])) {
            kind = Token::name;
            skip(is_in_name);
        } else if (is_symbol(text[i])) {
            i += text[i] == '*' && at(i + 1) == '*' ? 2 : 1;
        } else {
            ++i;
            skip(is_inside_utf8);
            refuse_at(start + 1, source, "`" + text.substr(start, i - start) + "` has no meaning in an expression");
        }
        tokens.push_back({kind, text.substr(start, i - start), start + 1});
    }
    tokens.push_back({Token::end, "", text.size() + 1});
    return tokens;
}

#include "switches.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace {

constexpr int intervals = 10000;

int sign(double x) { return (x > 0.0) - (x < 0.0); }

class Search {
public:
    Search(const Expression &expression, std::vector<Switch> &found) : expression_(expression), found_(found) {}

    // at_from, at_to: all results at the ends
    void between(const Watched &watched, double from, const std::vector<double> &at_from, double to,
                 const std::vector<double> &at_to) {
        auto signs = [&](int result) {
            return std::pair(sign(at_from[static_cast<std::size_t>(result)]), sign(at_to[static_cast<std::size_t>(result)]));
        };
        const auto [start, end] = signs(watched.result);
        if (start != end) return changes(watched.result, from, start, to, end);
        const auto [first, last] = signs(watched.rate);
        if (start == 0 || first != -start || last != start) return;
        const double extreme = change(watched.rate, from, first, to).after;
        const int there = sign_at(watched.result, extreme);
        if (there == start) return;
        changes(watched.result, from, start, extreme, there);
        changes(watched.result, extreme, there, to, end);
    }

private:
    int sign_at(int result, double t) const { return sign(expression_.at(t)[static_cast<std::size_t>(result)]); }

    // By bisection to the last bit; the sign at `to` differs from `start`.
    Switch change(int result, double from, int start, double to) const {
        for (double middle = 0.5 * (from + to); middle > from && middle < to; middle = 0.5 * (from + to))
            (sign_at(result, middle) == start ? from : to) = middle;
        return {from, to};
    }

    // A result may stay zero between two signs.
    void changes(int result, double from, int start, double to, int end) {
        while (start != end) {
            found_.push_back(change(result, from, start, to));
            from = found_.back().after;
            start = from < to ? sign_at(result, from) : end;
        }
    }

    const Expression &expression_;
    std::vector<Switch> &found_;
};

// What switches together may do so some roundings apart.
std::vector<Switch> merged(std::vector<Switch> found, double end) {
    const double rounding = 16.0 * std::numeric_limits<double>::epsilon() * end;
    std::sort(found.begin(), found.end(), [](const Switch &a, const Switch &b) { return a.before < b.before; });
    std::vector<Switch> result;
    for (const Switch &s : found)
        if (!result.empty() && s.before <= result.back().after + rounding)
            result.back().after = std::max(result.back().after, s.after);
        else
            result.push_back(s);
    return result;
}

} // namespace

std::vector<Switch> find_switches(const Expression &expression, const std::vector<Watched> &watched, double end) {
    std::vector<Switch> found;
    if (watched.empty()) return found;
    Search search(expression, found);
    double before = 0.0;
    std::vector<double> at_before = expression.at(before);
    for (int i = 1; i <= intervals; ++i) {
        const double after = end * (static_cast<double>(i) / intervals);
        std::vector<double> at_after = expression.at(after);
        for (const Watched &w : watched) search.between(w, before, at_before, after, at_after);
        before = after;
        at_before = std::move(at_after);
    }
    return merged(std::move(found), end);
}

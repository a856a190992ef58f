#include "monotone.hpp"

#include <algorithm>
#include <cmath>

namespace {

// The rows and what lies between them; k counts rows, and the interval k begins at the row k.
class Rows {
public:
    Rows(const std::vector<double> &t, const std::vector<double> &y) : t_(t), y_(y) {}

    int last() const { return static_cast<int>(t_.size()) - 1; }
    double y(int k) const { return y_[static_cast<std::size_t>(k)]; }
    double width(int k) const { return t(k + 1) - t(k); }
    double slope(int k) const { return (y(k + 1) - y(k)) / width(k); }
    bool has_before(int k) const { return k > 0; }
    bool has_after(int k) const { return k < last(); }

    // First and second derivative at row k.
    std::array<double, 2> derivatives(int k) const {
        const double before = has_before(k) ? slope(k - 1) : slope(k), after = has_after(k) ? slope(k) : slope(k - 1);
        if (before * after > 0.0) return in_run(k, after > 0.0 ? 1.0 : -1.0);
        return {0.0, has_before(k) && has_after(k) ? turn(k, before, after) : 0.0};
    }

private:
    double t(int k) const { return t_[static_cast<std::size_t>(k)]; }

    // The second derivative where values turn, or where a flat begins or ends.
    double turn(int k, double before, double after) const {
        const double bound = 10.0 * std::min(std::abs(before) / width(k - 1), std::abs(after) / width(k));
        return std::clamp(2.0 * (after - before) / (width(k - 1) + width(k)), -bound, bound);
    }

    // Where values rise (sign 1) or fall (-1) through row k.
    std::array<double, 2> in_run(int k, double sign) const {
        int from = k, to = k;
        while (has_before(from) && sign * slope(from - 1) > 0.0) --from;
        while (has_after(to) && sign * slope(to) > 0.0) ++to;
        from = std::max(from, std::min(k - 2, to - 4));
        const Jet through = neville(from, std::min(to, from + 4), k);

        double steepest = has_after(k) ? 2.5 * sign * slope(k) : 2.5 * sign * slope(k - 1);
        if (has_before(k)) steepest = std::min(steepest, 2.5 * sign * slope(k - 1));
        if (has_before(k) && has_after(k))
            steepest = std::min(steepest, 1.25 * sign * (slope(k - 1) * width(k) + slope(k) * width(k - 1)) /
                                              (width(k - 1) + width(k)));
        const double d = std::clamp(sign * rate_of(through), 0.0, steepest);
        double s = sign * acceleration_of(through);
        if (has_before(k)) s = between(s, (8.0 * d - 10.0 * sign * slope(k - 1)) / width(k - 1), 4.0 * d / width(k - 1));
        if (has_after(k)) s = between(s, -4.0 * d / width(k), (10.0 * sign * slope(k) - 8.0 * d) / width(k));
        return {sign * d, sign * s};
    }

    // The bounds may be in the wrong order by rounding.
    static double between(double x, double low, double high) { return std::max(low, std::min(x, high)); }

    // The polynomial through rows `from` to `to`, at row k with its derivatives, by Neville's scheme.
    Jet neville(int from, int to, int k) const {
        const Jet at = jet(t(k), 1.0, 0.0);
        std::vector<Jet> p;
        for (int i = from; i <= to; ++i) p.emplace_back(y(i));
        for (int width = 1; width <= to - from; ++width)
            for (int i = from; i + width <= to; ++i) {
                const std::size_t place = static_cast<std::size_t>(i - from);
                p[place] = ((at - t(i)) * p[place + 1] - (at - t(i + width)) * p[place]) / (t(i + width) - t(i));
            }
        return p.front();
    }

    const std::vector<double> &t_, &y_;
};

} // namespace

MonotoneTable monotone_table(const std::vector<double> &t, const std::vector<double> &y) {
    const Rows rows(t, y);
    MonotoneTable table{t, {}};
    for (int k = 0; k < rows.last(); ++k) {
        const double h = rows.width(k);
        const auto [d0, s0] = rows.derivatives(k);
        const auto [d1, s1] = rows.derivatives(k + 1);
        const double y0 = rows.y(k), y1 = rows.y(k + 1);
        table.pieces.push_back({y0, y0 + h * d0 / 5.0, y0 + 2.0 * h * d0 / 5.0 + h * h * s0 / 20.0,
                                y1 - 2.0 * h * d1 / 5.0 + h * h * s1 / 20.0, y1 - h * d1 / 5.0, y1});
    }
    return table;
}

// De Casteljau's scheme.
Jet interpolate(const MonotoneTable &table, const Jet &t) {
    const auto next = std::upper_bound(table.t.begin() + 1, table.t.end() - 1, value_of(t));
    const std::size_t k = static_cast<std::size_t>(next - table.t.begin()) - 1;
    const Jet u = (t - table.t[k]) / (table.t[k + 1] - table.t[k]);
    std::array<Jet, 6> b;
    std::copy(table.pieces[k].begin(), table.pieces[k].end(), b.begin());
    for (std::size_t left = 5; left > 0; --left)
        for (std::size_t i = 0; i < left; ++i) b[i] += u * (b[i + 1] - b[i]);
    return b[0];
}

#include "body_motion.hpp"

#include <cmath>

#include "gauss.hpp"
#include "shape.hpp"

Vec<double> center(const Body &b, const Eigen::VectorXd &x) {
    const int o = b.offset;
    switch (b.kind) {
    case BodyKind::ground: return {0.0, 0.0};
    case BodyKind::rigid_link: return {0.5 * (x[o] + x[o + 2]), 0.5 * (x[o + 1] + x[o + 3])};
    case BodyKind::flexible_link: {
        Vec<double> sum{0.0, 0.0};
        for (int e = 0; e < b.elements; ++e)
            for (const GaussPoint &g : gauss2) { // exact for cubic shape functions
                const Shape s = shape(g.x, b.element.length);
                const double weight = g.weight / b.elements;
                for (int i = 0; i < 4; ++i)
                    sum = sum + (weight * s[i]) * Vec<double>{x[o + 4 * e + 2 * i], x[o + 4 * e + 2 * i + 1]};
            }
        return sum;
    }
    default: return {x[o], x[o + 1]};
    }
}

Vec<double> chord(const Body &link, const Eigen::VectorXd &x) {
    const int start = link.offset, end = link.offset + (link.kind == BodyKind::rigid_link ? 2 : 4 * link.elements);
    return {x[end] - x[start], x[end + 1] - x[start + 1]};
}

double largest_strain(const Body &link, const Eigen::VectorXd &q) {
    constexpr int intervals = 10;
    double largest = 0.0;
    for (int e = 0; e < link.elements; ++e)
        for (int k = 0; k <= intervals; ++k) {
            const Shape s = slope_shape(static_cast<double>(k) / intervals, link.element.length);
            const Vec<double> slope = combine(s, q.data() + link.offset + 4 * e);
            const double strain = 0.5 * (dot(slope, slope) - 1.0);
            if (std::abs(strain) > std::abs(largest)) largest = strain;
        }
    return largest;
}

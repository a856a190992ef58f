#include "element.hpp"

#include "dual.hpp"
#include "gauss.hpp"
#include "plane.hpp"
#include "shape.hpp"

namespace {

// Strain energy a unit of length, eq. 11, of r' and r''.
template <class T>
T axial_density(const CableElement &e, const Vec<T> &slope) {
    const T strain = 0.5 * (dot(slope, slope) - 1.0);
    return 0.5 * e.axial_stiffness * strain * strain;
}
template <class T>
T bending_density(const CableElement &e, const Vec<T> &curvature) {
    return 0.5 * e.bending_stiffness * dot(curvature, curvature);
}
template <class T>
T density(const CableElement &e, const std::array<T, 4> &gradient) {
    return axial_density(e, Vec<T>{gradient[0], gradient[1]}) + bending_density(e, Vec<T>{gradient[2], gradient[3]});
}

// r', r'' at a Gauss point and the shape functions that lead from them back to the coordinates.
struct GradientPoint {
    Shape slope, curvature;
    std::array<double, 4> gradient;
    double weight;

    GradientPoint(const CableElement &e, const GaussPoint &g, const double *q)
        : slope(slope_shape(g.x, e.length)), curvature(curvature_shape(g.x, e.length)), weight(g.weight * e.length) {
        const Vec<double> r1 = combine(slope, q), r2 = combine(curvature, q);
        gradient = {r1.x, r1.y, r2.x, r2.y};
    }
};

template <class S>
using Dual4 = Dual<S, 4>;

} // namespace

ElementMatrix element_mass(double mass, double length) {
    ElementMatrix m = ElementMatrix::Zero();
    for (const GaussPoint &g : gauss5) {
        const Shape s = shape(g.x, length);
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < 4; ++b)
                for (int k = 0; k < 2; ++k) m(2 * a + k, 2 * b + k) += mass * g.weight * s[a] * s[b];
    }
    return m;
}

ElasticEnergy element_energy(const CableElement &e, const double *q) {
    ElasticEnergy sum;
    for (const GaussPoint &g : gauss5) {
        const GradientPoint p(e, g, q);
        sum.axial += p.weight * axial_density(e, Vec<double>{p.gradient[0], p.gradient[1]});
        sum.bending += p.weight * bending_density(e, Vec<double>{p.gradient[2], p.gradient[3]});
    }
    return sum;
}

ElementVector element_force(const CableElement &e, const double *q) {
    ElementVector f = ElementVector::Zero();
    for (const GaussPoint &g : gauss5) {
        const GradientPoint p(e, g, q);
        std::array<Dual4<double>, 4> u;
        for (int i = 0; i < 4; ++i) {
            u[i].value = p.gradient[i];
            u[i].slope[i] = 1.0;
        }
        const Dual4<double> w = density(e, u);
        for (int a = 0; a < 4; ++a)
            for (int k = 0; k < 2; ++k)
                f[2 * a + k] += p.weight * (p.slope[a] * w.slope[k] + p.curvature[a] * w.slope[2 + k]);
    }
    return f;
}

ElementMatrix element_tangent(const CableElement &e, const double *q) {
    ElementMatrix tangent = ElementMatrix::Zero();
    for (const GaussPoint &g : gauss5) {
        const GradientPoint p(e, g, q);
        std::array<Dual4<Dual4<double>>, 4> u;
        for (int i = 0; i < 4; ++i) {
            u[i].value.value = p.gradient[i];
            u[i].value.slope[i] = 1.0;
            u[i].slope[i] = 1.0;
        }
        const auto w = density(e, u);
        // r' and r'' do not mix in the energy density, so the mixed blocks of its Hessian vanish
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < 4; ++b)
                for (int k = 0; k < 2; ++k)
                    for (int l = 0; l < 2; ++l)
                        tangent(2 * a + k, 2 * b + l) +=
                            p.weight * (p.slope[a] * w.slope[k].slope[l] * p.slope[b] +
                                        p.curvature[a] * w.slope[2 + k].slope[2 + l] * p.curvature[b]);
    }
    return tangent;
}

#include "damping.hpp"

#include "dual.hpp"
#include "gauss.hpp"
#include "plane.hpp"
#include "shape.hpp"

// The force is the derivative by v of Rayleigh's function, the integral of tau (EA eps'^2 + EI kappa'^2) / 2, because
// d eps'/dv = d eps/dq. Its degree in x is 8, so that five Gauss points are exact.

namespace {

// Rayleigh's function a unit of length: of r', r'' (u) and their rates (w).
template <class T>
T density(const CableElement &e, double tau, const T *u, const T *w) {
    const Vec<T> slope{u[0], u[1]}, curvature{u[2], u[3]}, slope_rate{w[0], w[1]}, curvature_rate{w[2], w[3]};
    const T strain_rate = dot(slope, slope_rate);
    const T bending_rate = cross(slope_rate, curvature) + cross(slope, curvature_rate);
    return 0.5 * tau * (e.axial_stiffness * strain_rate * strain_rate + e.bending_stiffness * bending_rate * bending_rate);
}

// r', r'', their rates, and the shape functions of each of the four numbers of r', r''.
struct RatePoint {
    Shape slope, curvature;
    double u[4], w[4];
    double weight;

    RatePoint(const CableElement &e, const GaussPoint &g, const double *q, const double *v)
        : slope(slope_shape(g.x, e.length)), curvature(curvature_shape(g.x, e.length)), weight(g.weight * e.length) {
        split(q, u);
        split(v, w);
    }

    // d(number i of r', r'') / d(component i % 2 of the vector coordinate a)
    double shape(int i, int a) const { return i < 2 ? slope[a] : curvature[a]; }

private:
    void split(const double *x, double *gradient) const {
        const Vec<double> first = combine(slope, x), second = combine(curvature, x);
        gradient[0] = first.x;
        gradient[1] = first.y;
        gradient[2] = second.x;
        gradient[3] = second.y;
    }
};

} // namespace

ElementVector damping_force(const CableElement &e, double tau, const double *q, const double *v) {
    using D = Dual<double, 4>;
    ElementVector f = ElementVector::Zero();
    for (const GaussPoint &g : gauss5) {
        const RatePoint p(e, g, q, v);
        D u[4], w[4];
        for (int i = 0; i < 4; ++i) {
            u[i].value = p.u[i];
            w[i].value = p.w[i];
            w[i].slope[i] = 1.0;
        }
        const D rayleigh = density(e, tau, u, w);
        for (int a = 0; a < 4; ++a)
            for (int i = 0; i < 4; ++i) f[2 * a + i % 2] += p.weight * p.shape(i, a) * rayleigh.slope[i];
    }
    return f;
}

double damping_power(const CableElement &e, double tau, const double *q, const double *v) {
    double sum = 0.0;
    for (const GaussPoint &g : gauss5) {
        const RatePoint p(e, g, q, v);
        sum += 2.0 * p.weight * density(e, tau, p.u, p.w);
    }
    return sum;
}

void damping_derivatives(const CableElement &e, double tau, const double *q, const double *v, ElementMatrix &by_q,
                         ElementMatrix &by_v) {
    // inner variables: r', r'' and their rates; outer: the rates, which make the force
    using Inner = Dual<double, 8>;
    using Outer = Dual<Inner, 4>;
    by_q.setZero();
    by_v.setZero();
    for (const GaussPoint &g : gauss5) {
        const RatePoint p(e, g, q, v);
        Outer u[4], w[4];
        for (int i = 0; i < 4; ++i) {
            u[i].value.value = p.u[i];
            u[i].value.slope[i] = 1.0;
            w[i].value.value = p.w[i];
            w[i].value.slope[4 + i] = 1.0;
            w[i].slope[i] = 1.0;
        }
        const Outer rayleigh = density(e, tau, u, w);
        for (int a = 0; a < 4; ++a)
            for (int i = 0; i < 4; ++i)
                for (int b = 0; b < 4; ++b)
                    for (int j = 0; j < 4; ++j) {
                        const double shapes = p.weight * p.shape(i, a) * p.shape(j, b);
                        by_q(2 * a + i % 2, 2 * b + j % 2) += shapes * rayleigh.slope[i].slope[j];
                        by_v(2 * a + i % 2, 2 * b + j % 2) += shapes * rayleigh.slope[i].slope[4 + j];
                    }
    }
}

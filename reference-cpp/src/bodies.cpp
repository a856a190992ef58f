#include "bodies.hpp"

#include <cmath>

#include "failure.hpp"

namespace {

void require_not_negative(double x, const std::string &name, const char *field) {
    require(std::isfinite(x) && x >= 0.0, name + ": " + field + " must not be negative");
}

void require_positive(double x, const std::string &name, const char *field) {
    require(std::isfinite(x) && x > 0.0, name + ": " + field + " must be positive");
}

double link_mass(const ls_body &d, const std::string &name) {
    require_positive(d.length, name, "length");
    require_positive(d.width, name, "width");
    require_positive(d.height, name, "height");
    require_positive(d.density, name, "density");
    return d.density * d.length * d.width * d.height;
}

void complete_flexible_link(Body &b, const ls_body &d, const std::string &name) {
    require(d.elements > 0, name + ": elements must be positive");
    require_positive(d.youngs_modulus, name, "youngs_modulus");
    const double area = d.width * d.height;
    b.elements = d.elements;
    b.element.axial_stiffness = d.youngs_modulus * area;
    b.element.bending_stiffness = d.youngs_modulus * area * d.width * d.width / 12.0;
    b.element.length = d.length / d.elements;
    require_not_negative(d.strain_damping, name, "strain_damping");
    require_not_negative(d.mass_damping, name, "mass_damping");
    b.strain_damping = d.strain_damping;
    b.mass_damping = d.mass_damping;
}

// Equilateral triangular plate of circumradius R: area 3 sqrt(3)/4 R^2, side s = sqrt(3) R, inertia m s^2 / 12.
void complete_rigid_body(Body &b, const ls_body &d, const std::string &name) {
    if (d.plate_circumradius > 0.0) {
        require_positive(d.plate_circumradius, name, "plate_circumradius");
        require_positive(d.plate_thickness, name, "plate_thickness");
        require_positive(d.density, name, "density");
        const double r2 = d.plate_circumradius * d.plate_circumradius;
        b.mass = d.density * 0.75 * std::sqrt(3.0) * r2 * d.plate_thickness;
        b.inertia = b.mass * 3.0 * r2 / 12.0;
        b.lever = d.plate_circumradius;
    } else {
        require_positive(d.mass, name, "mass");
        require_positive(d.inertia, name, "inertia");
        b.mass = d.mass;
        b.inertia = d.inertia;
        b.lever = std::sqrt(d.inertia / d.mass);
    }
}

} // namespace

Body make_body(const ls_body &d, int offset, const std::string &name) {
    Body b{};
    b.kind = static_cast<ls_body_kind>(d.kind);
    b.offset = offset;
    b.lever = 1.0;
    require(d.kind == LS_FLEXIBLE_LINK || (d.strain_damping == 0.0 && d.mass_damping == 0.0),
            name + ": only a flexible link has damping");
    switch (d.kind) {
    case LS_GROUND: break;
    case LS_RIGID_LINK:
    case LS_FLEXIBLE_LINK:
        b.mass = link_mass(d, name);
        b.length = b.lever = d.length;
        b.size = 4;
        if (d.kind == LS_FLEXIBLE_LINK) {
            complete_flexible_link(b, d, name);
            b.size = 4 * (b.elements + 1);
        }
        break;
    case LS_RIGID_BODY:
        complete_rigid_body(b, d, name);
        b.size = 3;
        break;
    case LS_POINT_MASS:
        require_positive(d.mass, name, "mass");
        b.mass = d.mass;
        b.size = 2;
        break;
    case LS_MOVING_BODY:
        b.function = d.function;
        b.size = 3;
        break;
    default: throw Failure(LS_BAD_INPUT, name + ": unknown kind");
    }
    return b;
}

void add_mass(const Body &b, Eigen::MatrixXd &mass) {
    const int o = b.offset;
    switch (b.kind) {
    case LS_RIGID_LINK: // eq. 5 with eq. 4
        for (int k = 0; k < 2; ++k) {
            mass(o + k, o + k) = mass(o + 2 + k, o + 2 + k) = b.mass / 3.0;
            mass(o + k, o + 2 + k) = mass(o + 2 + k, o + k) = b.mass / 6.0;
        }
        break;
    case LS_FLEXIBLE_LINK:
        for (int e = 0; e < b.elements; ++e)
            mass.block<8, 8>(o + 4 * e, o + 4 * e) += element_mass(b.mass / b.elements, b.element.length);
        break;
    case LS_RIGID_BODY:
        mass(o, o) = mass(o + 1, o + 1) = b.mass;
        mass(o + 2, o + 2) = b.inertia;
        break;
    case LS_POINT_MASS: mass(o, o) = mass(o + 1, o + 1) = b.mass; break;
    default: break;
    }
}

void add_translation(const Body &b, double x, double y, Eigen::VectorXd &field) {
    const int points = b.kind == LS_GROUND         ? 0
                       : b.kind == LS_RIGID_LINK    ? 2
                       : b.kind == LS_FLEXIBLE_LINK ? b.elements + 1
                                                    : 1;
    const int stride = b.kind == LS_FLEXIBLE_LINK ? 4 : 2;
    for (int i = 0; i < points; ++i) {
        field[b.offset + stride * i] += x;
        field[b.offset + stride * i + 1] += y;
    }
}

Attachment ground_attachment() {
    Attachment a{};
    a.kind = LS_GROUND;
    a.length = 1.0;
    return a;
}

Attachment make_attachment(const Body &b, const ls_point &p, const std::string &name) {
    require(std::isfinite(p.x) && std::isfinite(p.y), name + ": the point is not finite");
    constexpr double rounding = 1e-12;
    Attachment a{};
    a.kind = b.kind;
    a.offset = b.offset;
    a.length = 1.0;
    a.point = {p.x, p.y};
    switch (b.kind) {
    case LS_RIGID_LINK: {
        const bool start = p.x == 0.0, end = std::abs(p.x - b.length) <= rounding * b.length;
        require((start || end) && p.y == 0.0,
                name + ": a point of a rigid link must be its start (0, 0) or its end (length, 0)");
        a.size = 4;
        a.end = end ? 1 : 0;
        a.length = b.length;
        break;
    }
    case LS_FLEXIBLE_LINK: {
        const double node = std::round(p.x / b.element.length);
        require(node >= 0.0 && node <= b.elements && p.y == 0.0 &&
                    std::abs(p.x - node * b.element.length) <= rounding * b.length,
                name + ": a point of a flexible link must be one of its nodes");
        a.size = 4;
        a.offset += 4 * static_cast<int>(node);
        break;
    }
    case LS_RIGID_BODY:
    case LS_MOVING_BODY: a.size = 3; break;
    case LS_POINT_MASS:
        require(p.x == 0.0 && p.y == 0.0, name + ": a point mass has no other point than (0, 0)");
        a.size = 2;
        break;
    default: break;
    }
    return a;
}

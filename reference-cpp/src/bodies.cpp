#include "bodies.hpp"

#include <cmath>

namespace {

void add_block(const Eigen::Ref<const Eigen::MatrixXd> &block, int offset, Entries &entries) {
    for (int i = 0; i < block.rows(); ++i)
        for (int j = 0; j < block.cols(); ++j)
            if (block(i, j) != 0.0) entries.emplace_back(offset + i, offset + j, block(i, j));
}

} // namespace

Body make_body(const BodyDescription &d, int offset) {
    Body b{};
    b.kind = d.kind;
    b.name = d.name;
    b.offset = offset;
    b.mass = d.mass;
    b.inertia = d.inertia;
    b.length = d.length;
    b.lever = 1.0;
    switch (d.kind) {
    case BodyKind::ground: break;
    case BodyKind::rigid_link:
        b.lever = d.length;
        b.size = 4;
        break;
    case BodyKind::flexible_link:
        b.lever = d.length;
        b.elements = d.elements;
        b.size = 4 * (d.elements + 1);
        b.element = {d.axial_stiffness, d.bending_stiffness, d.length / d.elements};
        b.strain_damping = d.strain_damping;
        b.mass_damping = d.mass_damping;
        break;
    case BodyKind::rigid_body:
        b.lever = std::sqrt(d.inertia / d.mass);
        b.size = 3;
        break;
    case BodyKind::point_mass: b.size = 2; break;
    case BodyKind::moving: b.size = 3; break;
    }
    return b;
}

std::vector<std::string> coordinate_names(const Body &b) {
    std::vector<std::string> names;
    auto add = [&](const std::string &point, const char *quantity) { names.push_back(b.name + point + quantity); };
    switch (b.kind) {
    case BodyKind::rigid_link:
        for (const char *point : {".start", ".end"})
            for (const char *quantity : {".x", ".y"}) add(point, quantity);
        break;
    case BodyKind::flexible_link:
        for (int i = 0; i <= b.elements; ++i)
            for (const char *quantity : {".x", ".y", ".slope_x", ".slope_y"})
                add(".node" + std::to_string(i), quantity);
        break;
    case BodyKind::rigid_body:
    case BodyKind::moving:
        for (const char *quantity : {".x", ".y", ".theta"}) add("", quantity);
        break;
    case BodyKind::point_mass:
        for (const char *quantity : {".x", ".y"}) add("", quantity);
        break;
    case BodyKind::ground: break;
    }
    return names;
}

void add_mass(const Body &b, Entries &mass) {
    const int o = b.offset;
    switch (b.kind) {
    case BodyKind::rigid_link: // eq. 5 with eq. 4
        for (int k = 0; k < 2; ++k)
            for (int i : {0, 2})
                for (int j : {0, 2}) mass.emplace_back(o + i + k, o + j + k, b.mass / (i == j ? 3.0 : 6.0));
        break;
    case BodyKind::flexible_link:
        for (int e = 0; e < b.elements; ++e)
            add_block(element_mass(b.mass / b.elements, b.element.length), o + 4 * e, mass);
        break;
    case BodyKind::rigid_body: mass.emplace_back(o + 2, o + 2, b.inertia); [[fallthrough]];
    case BodyKind::point_mass:
        for (int k = 0; k < 2; ++k) mass.emplace_back(o + k, o + k, b.mass);
        break;
    default: break;
    }
}

void add_translation(const Body &b, double x, double y, Eigen::VectorXd &field) {
    const int points = b.kind == BodyKind::ground          ? 0
                       : b.kind == BodyKind::rigid_link    ? 2
                       : b.kind == BodyKind::flexible_link ? b.elements + 1
                                                           : 1;
    const int stride = b.kind == BodyKind::flexible_link ? 4 : 2;
    for (int i = 0; i < points; ++i) {
        field[b.offset + stride * i] += x;
        field[b.offset + stride * i + 1] += y;
    }
}

void put_body(const Body &b, const Frame &pose, const Frame &velocity, const Deformation &deformation,
              Eigen::VectorXd &q, Eigen::VectorXd &v) {
    const double c = std::cos(pose.theta), s = std::sin(pose.theta);
    // the point at the distance x from the middle
    auto put_point = [&](int i, double x) {
        q.segment<2>(i) << pose.x + x * c, pose.y + x * s;
        v.segment<2>(i) << velocity.x - velocity.theta * x * s, velocity.y + velocity.theta * x * c;
    };
    switch (b.kind) {
    case BodyKind::rigid_link:
        put_point(b.offset, -0.5 * b.length);
        put_point(b.offset + 2, 0.5 * b.length);
        break;
    case BodyKind::flexible_link:
        for (int i = 0; i <= b.elements; ++i) {
            const int o = b.offset + 4 * i;
            const double x = (static_cast<double>(i) / b.elements - 0.5) * b.length, stretch = deformation.stretch();
            const Eigen::Vector2d along(c, s), across(-s, c);
            put_point(o, stretch * x);
            v.segment<2>(o) += deformation.velocity(x, b.length) * across;
            q.segment<2>(o + 2) = stretch * along;
            v.segment<2>(o + 2) = (velocity.theta * stretch + deformation.slope_rate(x)) * across;
        }
        break;
    case BodyKind::rigid_body:
    case BodyKind::moving:
        q[b.offset + 2] = pose.theta;
        v[b.offset + 2] = velocity.theta;
        [[fallthrough]];
    case BodyKind::point_mass: put_point(b.offset, 0.0); break;
    case BodyKind::ground: break;
    }
}

Attachment ground_attachment() {
    Attachment a{};
    a.kind = BodyKind::ground;
    a.length = 1.0;
    return a;
}

Attachment make_attachment(const Body &b, Vec<double> at) {
    Attachment a{};
    a.kind = b.kind;
    a.offset = b.offset;
    a.size = b.size;
    a.length = 1.0;
    a.point = at;
    if (b.kind == BodyKind::rigid_link) {
        a.share = at.x / b.length;
        a.length = b.length;
    }
    if (b.kind == BodyKind::flexible_link) {
        a.size = 4;
        a.offset += 4 * static_cast<int>(std::lround(at.x / b.element.length));
    }
    return a;
}

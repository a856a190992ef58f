// Bodies and their points.
#include <algorithm>

#include "reader.hpp"

namespace {

constexpr double pi = 3.14159265358979323846;

Vec<double> read_place(const Value &value) {
    if (value.kind != Value::table) return as_pair(value);
    Fields f(value);
    const double radius = f.not_negative("radius"), angle = f.number("degrees") * (pi / 180.0);
    f.finish();
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

void read_points(Fields &f, BodyDescription &body) {
    each_entry(f.find("points"), [&](const std::string &name, const Value &value) {
        body.points.push_back({name, read_place(value)});
    });
}

struct Plate {
    double mass, inertia;
};

Plate read_plate(const Value &value, const Library &library) {
    enum class Shape { triangle, disc, rectangle };
    Fields f(value);
    const Shape shape = f.choice<Shape>(
        "shape", {{"equilateral_triangle", Shape::triangle}, {"disc", Shape::disc}, {"rectangle", Shape::rectangle}});
    double area = 0.0, gyration = 0.0; // square of the radius of gyration
    if (shape == Shape::triangle) { // side s = sqrt(3) R, inertia m s^2 / 12
        const double r = f.positive("circumradius");
        area = 0.75 * std::sqrt(3.0) * r * r;
        gyration = 3.0 * r * r / 12.0;
    } else if (shape == Shape::disc) {
        const double r = f.positive("radius");
        area = pi * r * r;
        gyration = 0.5 * r * r;
    } else {
        const double a = f.positive("width"), b = f.positive("height");
        area = a * b;
        gyration = (a * a + b * b) / 12.0;
    }
    const double thickness = f.positive("thickness");
    const double mass = named(library.materials, f.get("material"), "material").density * area * thickness;
    f.finish();
    return {mass, mass * gyration};
}

// A choice of unknowns, which changes no result; here every body but a link has x, y of its centre of mass and its angle.
void read_coordinates(Fields &f) {
    if (f.has("coordinates")) f.choice<bool>("coordinates", {{"center", true}});
}

void read_rigid_body(Fields &f, const Library &library, BodyDescription &body) {
    if (const Value *value = f.find("plate")) {
        const Plate plate = read_plate(*value, library);
        body.mass = f.has("mass") ? f.positive("mass") : plate.mass;
        body.inertia = plate.inertia * (body.mass / plate.mass);
        require(!f.has("inertia"), f.source("inertia"), "give either a plate or the inertia, not both");
    } else {
        body.mass = f.positive("mass");
        body.inertia = f.positive("inertia");
    }
    read_coordinates(f);
    const Vec<double> center = f.has("center_of_mass") ? f.pair("center_of_mass") : Vec<double>{0.0, 0.0};
    read_points(f, body);
    for (NamedPoint &point : body.points) point.at = point.at - center;
}

void read_disc(Fields &f, const Library &library, BodyDescription &body) {
    const double radius = f.positive("radius");
    if (f.has("material")) {
        require(!f.has("mass"), f.source("mass"), "give either the mass or a material, not both");
        const double density = named(library.materials, f.get("material"), "material").density;
        body.mass = density * pi * radius * radius * f.positive("thickness");
    } else {
        body.mass = f.positive("mass");
        require(!f.has("thickness"), f.source("thickness"), "only a disc with a material has a thickness");
    }
    body.inertia = 0.5 * body.mass * radius * radius;
    read_coordinates(f);
    const double rim = f.number("rim", 0.0);
    body.points = {{"center", {0.0, 0.0}}, {"rim", {radius * std::cos(rim), radius * std::sin(rim)}}};
    each_entry(f.find("points"), [&](const std::string &name, const Value &value) {
        require(name != body.points[0].name && name != body.points[1].name, value.source,
                "every disc has this point already");
        body.points.push_back({name, read_place(value)});
    });
}

void read_link_points(Fields &f, BodyDescription &body) {
    body.points = {{"start", {0.0, 0.0}}, {"end", {body.length, 0.0}}};
    each_entry(f.find("points"), [&](const std::string &name, const Value &value) {
        require(name != "start" && name != "end", value.source, "every link has this point already");
        const double x = as_number(value);
        require(x >= 0.0 && x <= body.length, value.source, "must be between the ends of the link");
        if (body.kind == BodyKind::flexible_link) {
            const double element = body.length / body.elements;
            constexpr double rounding = 1e-9;
            require(std::abs(x - std::round(x / element) * element) <= rounding * body.length, value.source,
                    "is not at a node between elements, which are " + text_of(element) + " m long");
        }
        body.points.push_back({name, {x, 0.0}});
    });
}

void read_link(Fields &f, const Library &library, BodyDescription &body) {
    body.kind = f.choice<BodyKind>("model", {{"rigid", BodyKind::rigid_link}, {"flexible", BodyKind::flexible_link}});
    body.length = f.positive("length");
    const Section &section = named(library.sections, f.get("section"), "section");
    const Material &material = named(library.materials, f.get("material"), "material");
    const double area = section.width * section.height;
    body.mass = material.density * area * body.length;
    body.inertia = body.mass * body.length * body.length / 12.0;
    // a choice of unknowns, which changes no result; here every rigid link has the positions of its ends
    if (f.has("coordinates")) f.choice<bool>("coordinates", {{"natural", true}, {"center", false}});
    const bool flexible = body.kind == BodyKind::flexible_link;
    constexpr int most_elements = 10000;
    const int elements = flexible || f.has("elements") ? f.count("elements", 1, most_elements) : 0;
    double mass_damping = 0.0, strain_damping = f.not_negative("kelvin_voigt", 0.0);
    if (const Value *value = f.find("rayleigh")) {
        Fields rayleigh(*value);
        mass_damping = rayleigh.not_negative("mass");
        strain_damping += rayleigh.not_negative("stiffness");
        rayleigh.finish();
    }
    if (flexible) { // a rigid link ignores these
        require(material.youngs_modulus.has_value(), f.source("material"), "a flexible link needs its youngs_modulus");
        body.elements = elements;
        body.axial_stiffness = *material.youngs_modulus * area;
        body.bending_stiffness = body.axial_stiffness * section.width * section.width / 12.0;
        body.strain_damping = strain_damping;
        body.mass_damping = mass_damping;
    }
    read_link_points(f, body);
}

} // namespace

BodyDescription read_body(const std::string &name, const Value &value, const Library &library, double duration) {
    enum class Type { ground, moving, rigid_body, disc, point_mass, link };
    Fields f(value);
    BodyDescription body;
    body.name = name;
    body.source = value.source;
    switch (f.choice<Type>("type", {{"ground", Type::ground},
                                    {"moving", Type::moving},
                                    {"rigid_body", Type::rigid_body},
                                    {"disc", Type::disc},
                                    {"point_mass", Type::point_mass},
                                    {"link", Type::link}})) {
    case Type::ground: read_points(f, body); break;
    case Type::moving:
        body.kind = BodyKind::moving;
        body.path = read_path(f.get("path"), duration);
        read_points(f, body);
        break;
    case Type::rigid_body:
        body.kind = BodyKind::rigid_body;
        read_rigid_body(f, library, body);
        break;
    case Type::disc:
        body.kind = BodyKind::rigid_body;
        read_disc(f, library, body);
        break;
    case Type::point_mass:
        body.kind = BodyKind::point_mass;
        body.mass = f.positive("mass");
        body.points = {{"center", {0.0, 0.0}}};
        break;
    case Type::link: read_link(f, library, body); break;
    }
    f.finish();
    return body;
}

Vec<double> named_point(const BodyDescription &body, const std::string &name, const Source &source) {
    const auto point =
        std::find_if(body.points.begin(), body.points.end(), [&](const NamedPoint &p) { return p.name == name; });
    require(point != body.points.end(), source, "the body `" + body.name + "` has no point `" + name + "`");
    return point->at;
}

PointReference read_point(const Value &value, const Scene &scene, const Library &library) {
    const std::string &text = as_text(value);
    const std::size_t dot = text.find('.');
    require(dot != std::string::npos, value.source, "a point is written \"body.point\"");
    const auto body = library.bodies.find(text.substr(0, dot));
    require(body != library.bodies.end(), value.source, "there is no body `" + text.substr(0, dot) + "`");
    return {body->second, named_point(scene.bodies[body->second], text.substr(dot + 1), value.source)};
}

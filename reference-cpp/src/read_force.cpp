// Springs, forces and torques.
#include "reader.hpp"

namespace {

void require_direction(Fields &f, const char *key, const PointReference &point, const Scene &scene) {
    require(scene.bodies[point.body].has_direction(), f.source(key), "a point mass has no direction");
}

int ground(const Scene &scene) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
        if (scene.bodies[i].kind == BodyKind::ground) return static_cast<int>(i);
    throw Failure(LS_INTERNAL, "a scene without ground was accepted");
}

} // namespace

void read_force(const std::string &name, const Value &value, const Library &library, Scene &scene) {
    enum class Type { spring_damper, torsion_spring, maxwell, force, torque };
    Fields f(value);
    auto point = [&](const char *key) { return read_point(f.get(key), scene, library); };
    auto function = [&](const char *key) { return read_function(f.get(key), scene.duration); };
    switch (f.choice<Type>("type", {{"spring_damper", Type::spring_damper},
                                    {"torsion_spring", Type::torsion_spring},
                                    {"maxwell", Type::maxwell},
                                    {"force", Type::force},
                                    {"torque", Type::torque}})) {
    case Type::spring_damper:
        scene.springs.push_back({name, value.source, point("from"), point("to"), f.not_negative("stiffness"),
                                 f.not_negative("damping"), f.not_negative("rest_length")});
        break;
    case Type::torsion_spring:
        scene.torsion_springs.push_back({name, value.source, read_turning_joint(f.get("joint"), scene, library),
                                         f.not_negative("stiffness"), f.not_negative("damping"),
                                         f.number("rest_angle")});
        break;
    case Type::maxwell:
        scene.maxwells.push_back({name, value.source, point("from"), point("to"), f.positive("stiffness"),
                                  f.positive("damping"), f.not_negative("rest_length"), f.number("elongation", 0.0)});
        break;
    case Type::force: {
        LoadDescription load{name, value.source, LoadKind::dead_force, point("point"), {}, function("x"), function("y")};
        load.kind =
            f.choice<LoadKind>("frame", {{"ground", LoadKind::dead_force}, {"body", LoadKind::follower_force}});
        if (load.kind == LoadKind::follower_force) require_direction(f, "point", load.point, scene);
        scene.loads.push_back(std::move(load));
        break;
    }
    case Type::torque: {
        LoadDescription load{name, value.source, LoadKind::torque, point("point"), {}, function("value"), Constant{0.0}};
        load.reaction = f.has("reaction") ? point("reaction") : PointReference{ground(scene), {0.0, 0.0}};
        require_direction(f, "point", load.point, scene);
        require_direction(f, "reaction", load.reaction, scene);
        scene.loads.push_back(std::move(load));
        break;
    }
    }
    f.finish();
}

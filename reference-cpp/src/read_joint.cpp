// Joints.
#include "reader.hpp"

namespace {

void read_sides(Fields &f, const char *first, const char *second, const Scene &scene, const Library &library,
                JointDescription &joint) {
    joint.first = read_point(f.get(first), scene, library);
    joint.second = read_point(f.get(second), scene, library);
    require(joint.first.body != joint.second.body, f.source(second), "both sides are on the same body");
}

void require_direction(Fields &f, const char *key, const PointReference &point, const Scene &scene) {
    require(scene.bodies[point.body].has_direction(), f.source(key), "a point mass has no direction");
}

// Guide, line and slider of a prismatic joint and of a loose guide.
void read_guide(Fields &f, const Scene &scene, const Library &library, JointDescription &joint) {
    joint.kind = JointKind::prismatic;
    read_sides(f, "guide", "slider", scene, library, joint);
    const Vec<double> direction = f.pair("direction");
    require(direction.x != 0.0 || direction.y != 0.0, f.source("direction"), "must not be zero");
    joint.direction = std::atan2(direction.y, direction.x);
    require_direction(f, "guide", joint.first, scene);
}

} // namespace

JointDescription read_joint(const std::string &name, const Value &value, const Scene &scene, const Library &library) {
    Fields f(value);
    JointDescription joint;
    joint.name = name;
    joint.source = value.source;
    enum class Type { revolute, prismatic, weld, rod, loose_guide };
    switch (f.choice<Type>("type", {{"revolute", Type::revolute},
                                    {"prismatic", Type::prismatic},
                                    {"weld", Type::weld},
                                    {"rod", Type::rod},
                                    {"loose_guide", Type::loose_guide}})) {
    case Type::revolute: {
        joint.kind = JointKind::revolute;
        read_sides(f, "bearing", "journal", scene, library, joint);
        const bool loose = f.choice<bool>("model", {{"ideal", false}, {"clearance", true}});
        if (loose || f.has("contact")) {
            const ContactLaw &law = named(library.contacts, f.get("contact"), "contact");
            require(!loose || law.has_radii(), f.source("contact"),
                    "a revolute joint with clearance needs a contact with a bearing_radius");
            if (loose) joint.law = law;
        }
        break;
    }
    case Type::prismatic:
        read_guide(f, scene, library, joint);
        joint.locked = f.choice<bool>("rotation", {{"free", false}, {"locked", true}});
        joint.angle = f.number("angle", 0.0);
        require(joint.locked || !f.has("angle"), f.source("angle"), "only a locked guide has an angle");
        if (joint.locked) require_direction(f, "slider", joint.second, scene);
        break;
    case Type::loose_guide:
        read_guide(f, scene, library, joint);
        joint.law = named(library.contacts, f.get("contact"), "contact");
        require(joint.law->friction.material_slip, f.source("contact"), "slip \"paper\" is refused in a loose guide");
        break;
    case Type::rod:
        joint.kind = JointKind::rod;
        read_sides(f, "first", "second", scene, library, joint);
        joint.length = f.positive("length");
        break;
    case Type::weld:
        joint.kind = JointKind::weld;
        read_sides(f, "first", "second", scene, library, joint);
        joint.angle = f.number("angle", 0.0);
        joint.slope_vector = f.has("slope") && f.choice<bool>("slope", {{"direction", false}, {"vector", true}});
        require_direction(f, "first", joint.first, scene);
        require_direction(f, "second", joint.second, scene);
        break;
    }
    f.finish();
    return joint;
}

int read_turning_joint(const Value &value, const Scene &scene, const Library &library) {
    const int number = named(library.joints, value, "joint");
    const JointDescription &joint = scene.joints[number];
    require(joint.kind == JointKind::revolute, value.source, "`" + joint.name + "` is not a revolute joint");
    for (int body : {joint.first.body, joint.second.body})
        require(scene.bodies[body].has_direction(), value.source,
                "`" + joint.name + "` is on a point mass, which has no direction");
    return number;
}

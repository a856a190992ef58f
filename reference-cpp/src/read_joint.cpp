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

} // namespace

JointDescription read_joint(const std::string &name, const Value &value, const Scene &scene, const Library &library) {
    Fields f(value);
    JointDescription joint;
    joint.name = name;
    joint.source = value.source;
    joint.kind = f.choice<JointKind>(
        "type",
        {{"revolute", JointKind::revolute}, {"prismatic", JointKind::prismatic}, {"weld", JointKind::weld}});
    switch (joint.kind) {
    case JointKind::revolute: {
        read_sides(f, "bearing", "journal", scene, library, joint);
        const bool loose = f.choice<bool>("model", {{"ideal", false}, {"clearance", true}});
        if (loose || f.has("contact")) {
            const ContactLaw &law = named(library.contacts, f.get("contact"), "contact");
            if (loose) joint.law = law;
        }
        break;
    }
    case JointKind::prismatic: {
        read_sides(f, "guide", "slider", scene, library, joint);
        const Vec<double> direction = f.pair("direction");
        require(direction.x != 0.0 || direction.y != 0.0, f.source("direction"), "must not be zero");
        joint.direction = std::atan2(direction.y, direction.x);
        joint.locked = f.choice<bool>("rotation", {{"free", false}, {"locked", true}});
        joint.angle = f.number("angle", 0.0);
        require(joint.locked || !f.has("angle"), f.source("angle"), "only a locked guide has an angle");
        require_direction(f, "guide", joint.first, scene);
        if (joint.locked) require_direction(f, "slider", joint.second, scene);
        break;
    }
    case JointKind::weld:
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

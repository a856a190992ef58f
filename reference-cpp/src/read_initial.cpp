// The start: sketch, states, velocities.
#include "reader.hpp"

namespace {

// A body that can have a state.
int read_free_body(const std::string &name, const Value &value, const Scene &scene, const Library &library) {
    const auto found = library.bodies.find(name);
    require(found != library.bodies.end(), value.source, "there is no body `" + name + "`");
    const BodyKind kind = scene.bodies[found->second].kind;
    require(kind != BodyKind::ground && kind != BodyKind::moving, value.source,
            "the body `" + name + "` has no state of its own");
    return found->second;
}

State read_state(const Value &value, bool has_angle) {
    Fields f(value);
    State state;
    state.source = value.source;
    state.pose = {f.number("x"), f.number("y"), has_angle ? f.number("theta") : 0.0};
    if (f.has("vx") || f.has("vy") || (has_angle && f.has("omega")))
        state.velocity = Frame{f.number("vx"), f.number("vy"), has_angle ? f.number("omega") : 0.0};
    f.finish();
    return state;
}

void read_velocities(const Value &value, int body, bool has_angle, std::vector<SingleVelocity> &velocities) {
    Fields f(value);
    const std::size_t before = velocities.size();
    const char *keys[3] = {"vx", "vy", "omega"};
    for (int k = 0; k < (has_angle ? 3 : 2); ++k)
        if (f.has(keys[k])) velocities.push_back({f.source(keys[k]), body, k, f.number(keys[k])});
    f.finish();
    require(velocities.size() > before, value.source, "must have one velocity at least");
}

void read_sketch(const Value *section, const Scene &scene, const Library &library, Initial &initial) {
    each_entry(section, [&](const std::string &name, const Value &value) {
        const auto joint = library.joints.find(name);
        if (joint != library.joints.end()) {
            initial.joints.push_back({value.source, joint->second, as_pair(value)});
            return;
        }
        require(library.bodies.count(name) > 0, value.source, "there is no joint or body `" + name + "`");
        each_entry(&value, [&](const std::string &point, const Value &at) {
            Value reference;
            reference.kind = Value::string;
            reference.source = at.source;
            reference.text = name + "." + point;
            initial.points.push_back({at.source, read_point(reference, scene, library), as_pair(at)});
        });
    });
}

} // namespace

Initial read_initial(const Value *value, const Scene &scene, const Library &library) {
    Initial initial;
    initial.states.resize(scene.bodies.size());
    if (!value) return initial;
    Fields f(*value);
    read_sketch(f.find("sketch"), scene, library, initial);
    each_entry(f.find("bodies"), [&](const std::string &name, const Value &entry) {
        const int body = read_free_body(name, entry, scene, library);
        initial.states[body] = read_state(entry, scene.bodies[body].has_direction());
    });
    each_entry(f.find("velocities"), [&](const std::string &name, const Value &entry) {
        const int body = read_free_body(name, entry, scene, library);
        read_velocities(entry, body, scene.bodies[body].has_direction(), initial.velocities);
    });
    initial.equilibrium = f.flag("equilibrium", false);

    if (scene.inverse_kinematics)
        require(initial.velocities.empty(), f.source("velocities"), "are refused in a scene with inverse kinematics");
    if (initial.equilibrium) {
        const Source &source = f.source("equilibrium");
        require(!scene.is_static, source, "is refused in a static analysis");
        require(initial.velocities.empty(), source, "is refused in a scene with given velocities");
        for (const std::optional<State> &state : initial.states)
            require(!state || !state->velocity, source, "is refused in a scene with given velocities");
        require(!scene.inverse_kinematics, source, "is refused in a scene with inverse kinematics");
        for (const JointDescription &joint : scene.joints)
            require(!joint.law, source, "is refused in a scene with clearance");
        require(scene.maxwells.empty(), source, "is refused in a scene with a Maxwell element");
    }
    f.finish();
    return initial;
}

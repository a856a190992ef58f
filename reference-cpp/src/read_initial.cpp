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

// Turns place and velocity of a point into those of the centre of mass. at: as NamedPoint::at
void move_to_center(State &state, const BodyDescription &body, Vec<double> at) {
    const Deformation &d = state.deformation;
    const double x = at.x - 0.5 * body.length; // of a link from its middle; other bodies have no length
    const Vec<double> arm = rotated(Vec<double>{d.stretch() * x, at.y}, state.pose.theta);
    state.pose.x -= arm.x;
    state.pose.y -= arm.y;
    if (!state.velocity) return;
    const Vec<double> across = rotated(Vec<double>{0.0, d.velocity(x, body.length)}, state.pose.theta);
    const Vec<double> difference = state.velocity->theta * turned(arm) + across;
    state.velocity->x -= difference.x;
    state.velocity->y -= difference.y;
}

State read_state(const Value &value, const BodyDescription &body) {
    const bool has_angle = body.has_direction();
    Fields f(value);
    State state;
    state.source = value.source;
    state.pose = {f.number("x"), f.number("y"), has_angle ? f.number("theta") : 0.0};
    if (f.has("vx") || f.has("vy") || (has_angle && f.has("omega")))
        state.velocity = Frame{f.number("vx"), f.number("vy"), has_angle ? f.number("omega") : 0.0};
    if (body.is_link()) {
        const Deformation given{f.number("strain", 0.0), f.number("bending_rate", 0.0)};
        require(given.strain > -0.5 && given.strain <= 1.0, f.source("strain"), "must be above -0.5 and at most 1");
        if (body.kind == BodyKind::flexible_link) state.deformation = given; // a rigid link ignores them
        // a link that bends has a velocity: what is not given of it is zero, at the point too
        if (state.deformation.bending_rate != 0.0 && !state.velocity) state.velocity = Frame{};
    }
    if (has_angle)
        if (const Value *point = f.find("point"))
            move_to_center(state, body, named_point(body, as_text(*point), point->source));
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

Initial::Rest read_equilibrium(Fields &f) {
    const Value *value = f.find("equilibrium");
    if (value && value->kind == Value::string)
        return f.choice<Initial::Rest>("equilibrium", {{"nearest", Initial::Rest::nearest}});
    return f.flag("equilibrium", false) ? Initial::Rest::downhill : Initial::Rest::none;
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
        initial.states[body] = read_state(entry, scene.bodies[body]);
    });
    each_entry(f.find("velocities"), [&](const std::string &name, const Value &entry) {
        const int body = read_free_body(name, entry, scene, library);
        read_velocities(entry, body, scene.bodies[body].has_direction(), initial.velocities);
    });
    initial.pressed = f.has("journals") && f.choice<bool>("journals", {{"centred", false}, {"pressed", true}});
    initial.equilibrium = read_equilibrium(f);

    if (scene.is_static)
        for (const std::optional<State> &state : initial.states)
            if (state && state->deformation.bending_rate != 0.0)
                refuse(state->source, "a rate of bending is refused in a static analysis");
    if (scene.inverse_kinematics)
        require(initial.velocities.empty(), f.source("velocities"), "are refused in a scene with inverse kinematics");
    if (initial.equilibrium != Initial::Rest::none) {
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

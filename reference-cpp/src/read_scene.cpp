// The scene as a whole, its analysis, its integrator and its output.
#include <algorithm>
#include <limits>

#include "reader.hpp"

namespace {

void read_simulation(const Value &value, Scene &scene) {
    Fields f(value);
    scene.is_static = f.has("analysis") && f.choice<bool>("analysis", {{"dynamic", false}, {"static", true}});
    scene.duration = f.positive("duration");
    if (f.has("gravity")) scene.gravity = f.pair("gravity");
    scene.follow_at_limit = f.has("at_limit") && f.choice<bool>("at_limit", {{"stop", false}, {"follow", true}});
    f.finish();
}

void read_accuracy(const Value &value, bool has_clearance) {
    Fields f(value);
    f.positive("position");
    if (f.has("energy")) f.positive("energy");
    if (has_clearance || f.has("horizon")) f.positive("horizon");
    f.finish();
}

// The methods are those of the main program.
void read_method(Fields &f) {
    enum class Method { automatic, bathe, damped, hht, other };
    const Method method = f.choice<Method>("method", {{"auto", Method::automatic},
                                                      {"bathe", Method::bathe},
                                                      {"trapezoidal", Method::other},
                                                      {"generalized_alpha", Method::damped},
                                                      {"hht", Method::hht},
                                                      {"backward_euler", Method::other},
                                                      {"esdirk3", Method::other},
                                                      {"esdirk5", Method::other},
                                                      {"dormand_prince", Method::other},
                                                      {"dop853", Method::other},
                                                      {"velocity_verlet", Method::other}});
    require(method != Method::automatic || f.has("accuracy"), f.source("method"), "\"auto\" needs an accuracy");
    if (method == Method::bathe && f.has("gamma")) {
        const double gamma = f.number("gamma");
        require(gamma > 0.0 && gamma < 1.0, f.source("gamma"), "must be between 0 and 1");
    }
    const bool damps = method == Method::damped || method == Method::hht;
    if (!damps && !(method == Method::bathe && f.has("spectral_radius"))) return;
    const double radius = f.number("spectral_radius"), least = method == Method::hht ? 0.5 : 0.0;
    require(radius >= least && radius <= 1.0, f.source("spectral_radius"), "must be from " + text_of(least) + " to 1");
}

// Of this section the reference uses the step of a static analysis and the tolerance of onsets.
void read_integrator(const Value &value, Scene &scene) {
    Fields f(value);
    double least_clearance = std::numeric_limits<double>::infinity();
    for (const JointDescription &joint : scene.joints)
        if (joint.law) least_clearance = std::min(least_clearance, joint.law->clearance);

    if (!scene.is_static || f.has("method")) read_method(f);
    if (const Value *accuracy = f.find("accuracy")) {
        require(!f.has("step"), accuracy->source, "give either an accuracy or a step, not both");
        require(!scene.is_static, accuracy->source, "a static analysis needs a step, not an accuracy");
        read_accuracy(*accuracy, std::isfinite(least_clearance));
    } else {
        scene.step = f.positive("step");
        require(scene.step <= scene.duration, f.source("step"), "must be at most the duration");
    }
    if (f.has("newton_tolerance")) f.positive("newton_tolerance");
    scene.onset_tolerance = f.positive("onset_tolerance", 1e-7 * least_clearance);
    require(!std::isfinite(least_clearance) || scene.onset_tolerance < least_clearance, f.source("onset_tolerance"),
            "must be below every clearance");
    f.flag("locate_onsets", true);
    if (f.has("knots")) f.choice<int>("knots", {{"stop", 0}, {"ignore", 1}});
    f.finish();
}

void read_output(const Value &value, Scene &scene) {
    Fields f(value);
    scene.interval = f.positive("interval");
    require(scene.interval <= scene.duration, f.source("interval"), "must be at most the duration");
    if (scene.step > 0.0) {
        const double steps = scene.interval / scene.step;
        constexpr double rounding = 1e-6;
        require(std::round(steps) >= 1.0 && std::abs(steps - std::round(steps)) <= rounding * steps,
                f.source("interval"), "must be a whole multiple of the step");
    }
    scene.patterns = as_texts(f.get("channels"));
    scene.patterns_source = f.source("channels");
    // about files that are not written here
    if (f.has("format")) f.choice<int>("format", {{"csv", 0}, {"json_lines", 1}});
    f.flag("motion", true);
    require(f.not_negative("extremes_from", 0.0) <= scene.duration, f.source("extremes_from"), "must be at most the duration");
    f.finish();
}

// Every entry is the path of a field that the scene has.
void read_assumptions(const Value *section, const Value &root) {
    if (!section) return;
    for (const auto &[path, reason] : as_table(*section).entries) {
        as_text(reason);
        const Value *value = &root;
        for (std::size_t from = 0; value && from <= path.size();) {
            const std::size_t dot = std::min(path.find('.', from), path.size());
            value = value->find(path.substr(from, dot - from));
            from = dot + 1;
        }
        require(value, reason.source, "the scene has no field " + path);
    }
}

// Channels are called name.quantity: names of bodies, joints and forces must differ.
class ChannelNames {
public:
    void add(const std::string &name, const Source &source) {
        require(std::find(names_.begin(), names_.end(), name) == names_.end(), source,
                "the name is reserved, or another body, joint or force has it");
        names_.push_back(name);
    }

private:
    std::vector<std::string> names_{"error", "energy", "points", "t"};
};

} // namespace

Scene read_scene(const std::string &text, const std::vector<std::string> &overrides) {
    Value root = parse_toml(text);
    for (const std::string &assignment : overrides) override_value(root, assignment);

    Scene scene;
    Library library;
    ChannelNames names;
    Fields f(root);
    f.count("format", 1, 1);
    scene.title = f.text("title");
    require(scene.title.find('\n') == std::string::npos, f.source("title"), "must be one line");
    read_simulation(f.get("simulation"), scene);
    each_entry(f.find("materials"), [&](const std::string &name, const Value &value) {
        library.materials.emplace(name, read_material(value));
    });
    each_entry(f.find("sections"), [&](const std::string &name, const Value &value) {
        library.sections.emplace(name, read_section(value));
    });
    each_entry(f.find("contacts"), [&](const std::string &name, const Value &value) {
        library.contacts.emplace(name, read_contact(value, library));
    });
    int grounds = 0;
    each_entry(&f.get("bodies"), [&](const std::string &name, const Value &value) {
        names.add(name, value.source);
        library.bodies.emplace(name, static_cast<int>(scene.bodies.size()));
        scene.bodies.push_back(read_body(name, value, library, scene.duration));
        if (scene.bodies.back().kind == BodyKind::ground) ++grounds;
    });
    require(grounds == 1, f.source("bodies"), "exactly one body must be of type \"ground\"");
    each_entry(f.find("joints"), [&](const std::string &name, const Value &value) {
        names.add(name, value.source);
        library.joints.emplace(name, static_cast<int>(scene.joints.size()));
        scene.joints.push_back(read_joint(name, value, scene, library));
        require(!scene.is_static || !scene.joints.back().law, value.source,
                "clearance is refused in a static analysis");
    });
    each_entry(f.find("drives"),
               [&](const std::string &name, const Value &value) { read_drive(name, value, library, scene); });
    require(!scene.is_static || !scene.inverse_kinematics, f.source("drives"),
            "inverse kinematics is refused in a static analysis");
    each_entry(f.find("forces"), [&](const std::string &name, const Value &value) {
        names.add(name, value.source);
        read_force(name, value, library, scene);
    });
    require(!scene.is_static || scene.maxwells.empty(), f.source("forces"),
            "a Maxwell element is refused in a static analysis");
    read_integrator(f.get("integrator"), scene);
    read_output(f.get("output"), scene);
    scene.initial = read_initial(f.find("initial"), scene, library);
    read_assumptions(f.find("assumptions"), root);
    f.finish();
    return scene;
}

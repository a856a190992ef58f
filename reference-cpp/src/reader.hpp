// The parts of the scene reader, one a section of the scene language.
#pragma once

#include <map>

#include "fields.hpp"
#include "scene.hpp"

struct Material {
    double density;
    std::optional<double> youngs_modulus, poissons_ratio;
};
struct Section {
    double width, height;
};
// What later sections refer to by name.
struct Library {
    std::map<std::string, Material> materials;
    std::map<std::string, Section> sections;
    std::map<std::string, ContactLaw> contacts;
    std::map<std::string, int> bodies, joints;
};

// The entry that the word under a key names.
template <class T>
const T &named(const std::map<std::string, T> &items, const Value &name, const char *what) {
    const auto found = items.find(as_text(name));
    require(found != items.end(), name.source, std::string("there is no ") + what + " `" + name.text + "`");
    return found->second;
}

// Calls read(name, value) for the entries of a section that may be missing.
template <class Read>
void each_entry(const Value *section, Read read) {
    if (!section) return;
    for (const auto &[name, value] : as_table(*section).entries) {
        const bool fits = !name.empty() && name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                                                  "0123456789_-") == std::string::npos;
        require(fits, value.source, "names consist of ASCII letters, digits, _ and -");
        read(name, value);
    }
}

Material read_material(const Value &value);
Section read_section(const Value &value);
FrictionLaw read_friction(const Value &value);
ContactLaw read_contact(const Value &value, const Library &library);

BodyDescription read_body(const std::string &name, const Value &value, const Library &library, double duration);
Vec<double> named_point(const BodyDescription &body, const std::string &name, const Source &source);
PointReference read_point(const Value &value, const Scene &scene, const Library &library); // "body.point"

JointDescription read_joint(const std::string &name, const Value &value, const Scene &scene, const Library &library);
// A revolute joint whose sides both have a direction.
int read_turning_joint(const Value &value, const Scene &scene, const Library &library);

enum class Use { load, motion };
TimeFunction read_expression(const Value &value, double duration, Use use);
TimeFunction read_function(const Value &value, double duration);
TimeFunction read_motion(const Value &value, double duration); // a function with a finite acceleration
Path read_path(const Value &value, double duration);

void read_drive(const std::string &name, const Value &value, const Library &library, Scene &scene);
void read_force(const std::string &name, const Value &value, const Library &library, Scene &scene);
Initial read_initial(const Value *value, const Scene &scene, const Library &library);

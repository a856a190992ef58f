// Materials, sections and contacts.
#include "reader.hpp"

namespace {

enum class Law { hertz, lankarani_nikravesh, hunt_crossley, flores };

double damping_factor(Law law, double e) {
    switch (law) {
    case Law::lankarani_nikravesh: return 3.0 * (1.0 - e * e) / 4.0;
    case Law::hunt_crossley: return 3.0 * (1.0 - e) / 2.0;
    case Law::flores: return 8.0 * (1.0 - e) / (5.0 * e);
    default: return 0.0;
    }
}

// h = (1 - nu^2) / E of eq. 25
double compliance(const Value &name, const Library &library) {
    const Material &material = named(library.materials, name, "material");
    require(material.youngs_modulus && material.poissons_ratio, name.source,
            "the material `" + name.text + "` needs youngs_modulus and poissons_ratio in a contact");
    const double nu = *material.poissons_ratio;
    return (1.0 - nu * nu) / *material.youngs_modulus;
}

} // namespace

Material read_material(const Value &value) {
    Fields f(value);
    Material material{f.positive("density"), {}, {}};
    if (f.has("youngs_modulus")) material.youngs_modulus = f.positive("youngs_modulus");
    if (f.has("poissons_ratio")) {
        const double nu = f.number("poissons_ratio");
        require(nu > -1.0 && nu <= 0.5, f.source("poissons_ratio"), "must be above -1 and at most 0.5");
        material.poissons_ratio = nu;
    }
    f.finish();
    return material;
}

Section read_section(const Value &value) {
    Fields f(value);
    const Section section{f.positive("width"), f.positive("height")};
    f.finish();
    return section;
}

ContactLaw read_contact(const Value &value, const Library &library) {
    Fields f(value);
    const Law kind = f.choice<Law>("law", {{"hertz", Law::hertz},
                                           {"lankarani_nikravesh", Law::lankarani_nikravesh},
                                           {"hunt_crossley", Law::hunt_crossley},
                                           {"flores", Law::flores}});
    ContactLaw law{};
    if (f.has("bearing_radius")) law.bearing_radius = f.positive("bearing_radius");
    law.clearance = f.positive("clearance");
    require(!law.has_radii() || law.clearance < law.bearing_radius, f.source("clearance"),
            "must be below bearing_radius");
    if (f.has("stiffness")) {
        law.stiffness = f.positive("stiffness");
        for (const char *key : {"bearing_material", "journal_material"})
            require(!f.has(key), f.source(key), "give either a stiffness or the materials, not both");
    } else { // eq. 25, with i the bearing and j the journal
        require(law.has_radii(), f.source(), "without a bearing_radius it needs a stiffness");
        const double h_i = compliance(f.get("bearing_material"), library);
        const double h_j = compliance(f.get("journal_material"), library);
        law.stiffness = 4.0 / (3.0 * (h_i + h_j)) *
                        std::sqrt(law.bearing_radius * law.journal_radius() / law.clearance);
    }
    law.exponent = f.number("exponent");
    require(law.exponent >= 1.0, f.source("exponent"), "must be at least 1");
    const bool undamped = kind == Law::hertz;
    const double restitution = undamped ? f.number("restitution", 1.0) : f.not_negative("restitution");
    require(restitution <= 1.0, f.source("restitution"), "must be at most 1");
    require(!undamped || restitution == 1.0, f.source("restitution"), "must be 1 with Hertz's law, which has no damping");
    require(kind != Law::flores || restitution > 0.0, f.source("restitution"),
            "must be above 0 with the law of Flores, which divides by it");
    law.damping = damping_factor(kind, restitution);
    // without damping the impact velocity is without effect, but it tells a closed contact from an open one
    if (!undamped || f.has("impact_velocity_floor")) law.impact_velocity_floor = f.positive("impact_velocity_floor");
    if (undamped) law.impact_velocity_floor = 1.0;
    if (const Value *friction = f.find("friction")) law.friction = read_friction(*friction);
    f.finish();
    return law;
}

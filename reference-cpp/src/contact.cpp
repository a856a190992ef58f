#include "contact.hpp"

#include <cmath>

#include "failure.hpp"

namespace {

bool positive(double x) { return std::isfinite(x) && x > 0.0; }
bool not_negative(double x) { return std::isfinite(x) && x >= 0.0; }

// Eq. 25, with i the bearing and j the journal.
double hertz_stiffness(const ls_contact &c) {
    const double compliance_i = (1.0 - c.bearing_poisson * c.bearing_poisson) / c.bearing_modulus;
    const double compliance_j = (1.0 - c.journal_poisson * c.journal_poisson) / c.journal_modulus;
    const double r_i = c.bearing_radius, r_j = c.bearing_radius - c.clearance;
    return 4.0 / (3.0 * (compliance_i + compliance_j)) * std::sqrt(r_i * r_j / c.clearance);
}

double damping_factor(const ls_contact &c, const std::string &name) {
    const double e = c.restitution;
    switch (c.normal) {
    case LS_LANKARANI_NIKRAVESH: return 3.0 * (1.0 - e * e) / 4.0;
    case LS_HUNT_CROSSLEY: return 3.0 * (1.0 - e) / 2.0;
    case LS_FLORES: require(e > 0.0, name + ": the law of Flores needs restitution > 0"); return 8.0 * (1.0 - e) / (5.0 * e);
    default: throw Failure(LS_BAD_INPUT, name + ": unknown normal law");
    }
}

} // namespace

ContactLaw make_contact_law(const ls_contact &c, const std::string &name) {
    require(positive(c.clearance), name + ": clearance must be positive");
    require(positive(c.bearing_radius) && c.bearing_radius > c.clearance,
            name + ": bearing_radius must be larger than the clearance");
    require(not_negative(c.stiffness), name + ": stiffness must not be negative");
    if (c.stiffness == 0.0) {
        require(positive(c.bearing_modulus) && positive(c.journal_modulus), name + ": moduli must be positive");
        require(std::abs(c.bearing_poisson) < 1.0 && std::abs(c.journal_poisson) < 1.0,
                name + ": Poisson's ratios must lie between -1 and 1");
    }
    require(std::isfinite(c.exponent) && c.exponent >= 1.0, name + ": exponent must be at least 1");
    require(not_negative(c.restitution) && c.restitution <= 1.0, name + ": restitution must lie between 0 and 1");
    require(positive(c.impact_velocity_floor), name + ": impact_velocity_floor must be positive");
    require(c.friction == LS_NO_FRICTION || c.friction == LS_AMBROSIO, name + ": unknown friction law");
    require(c.slip == LS_SLIP_PAPER || c.slip == LS_SLIP_MATERIAL, name + ": unknown slip");
    if (c.friction == LS_AMBROSIO) {
        require(not_negative(c.friction_coefficient), name + ": friction_coefficient must not be negative");
        require(not_negative(c.friction_v0) && std::isfinite(c.friction_v1) && c.friction_v1 > c.friction_v0,
                name + ": friction velocities must satisfy 0 <= v0 < v1");
    }
    ContactLaw law{};
    law.bearing_radius = c.bearing_radius;
    law.journal_radius = c.bearing_radius - c.clearance;
    law.clearance = c.clearance;
    law.stiffness = c.stiffness > 0.0 ? c.stiffness : hertz_stiffness(c);
    law.exponent = c.exponent;
    law.damping = damping_factor(c, name);
    law.impact_velocity_floor = c.impact_velocity_floor;
    law.friction = c.friction == LS_AMBROSIO && c.friction_coefficient > 0.0;
    law.material_slip = c.slip == LS_SLIP_MATERIAL;
    law.friction_coefficient = c.friction_coefficient;
    law.friction_v0 = c.friction_v0;
    law.friction_v1 = c.friction_v1;
    return law;
}

// The friction of a contact.
#include "reader.hpp"

namespace {

void read_ambrosio(Fields &f, FrictionLaw &law) {
    law.coefficient = f.not_negative("coefficient");
    law.v0 = f.not_negative("v0", 1e-4);
    law.v1 = f.positive("v1", 1e-3);
    require(law.v1 > law.v0, f.source("v1"), "must be greater than v0");
    if (law.coefficient == 0.0) law.kind = FrictionKind::none;
}

void read_stribeck(Fields &f, FrictionLaw &law) {
    law.mu_c = f.positive("mu_c");
    law.mu_s = f.positive("mu_s");
    require(law.mu_s >= law.mu_c, f.source("mu_s"), "must be at least mu_c");
    law.v_s = f.positive("v_s");
    law.s2 = f.not_negative("s2", 0.0);
}

void read_bristles(Fields &f, FrictionLaw &law) {
    law.s0 = f.positive("s0");
    law.s1 = f.not_negative("s1", 0.0);
    law.v_d = f.positive("v_d", 0.0);
    if (law.kind != FrictionKind::elasto_plastic) return;
    law.breakaway = f.not_negative("breakaway");
    require(law.breakaway < 1.0, f.source("breakaway"), "must be below 1");
}

} // namespace

FrictionLaw read_friction(const Value &value) {
    Fields f(value);
    FrictionLaw law;
    law.kind = f.choice<FrictionKind>("law", {{"ambrosio", FrictionKind::ambrosio},
                                              {"coulomb_stribeck", FrictionKind::coulomb_stribeck},
                                              {"lugre", FrictionKind::lugre},
                                              {"elasto_plastic", FrictionKind::elasto_plastic}});
    law.material_slip = !f.has("slip") || f.choice<bool>("slip", {{"material", true}, {"paper", false}});
    if (law.kind == FrictionKind::ambrosio)
        read_ambrosio(f, law);
    else
        read_stribeck(f, law);
    if (law.kind == FrictionKind::coulomb_stribeck) law.v_r = f.positive("v_r");
    if (law.has_bristles()) read_bristles(f, law);
    f.finish();
    return law;
}

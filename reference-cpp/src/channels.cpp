#include "channels.hpp"

#include <algorithm>

#include "body_motion.hpp"

namespace {

// Values, rates and accelerations of the coordinates of an attachment.
struct Motion {
    std::array<Jet, attachment_size> q;
    Motion(const Attachment &a, const Snapshot &s) {
        for (int i = 0; i < a.size; ++i) q[i] = jet(s.q[a.offset + i], s.v[a.offset + i], s.a[a.offset + i]);
    }
};

// The angular velocity of an attachment and its rate.
Dual<double, 1> turning(const Attachment &a, const Snapshot &s) {
    std::array<Dual<double, 1>, attachment_size> q, v;
    for (int i = 0; i < a.size; ++i) {
        q[i].value = s.q[a.offset + i];
        q[i].slope[0] = v[i].value = s.v[a.offset + i];
        v[i].slope[0] = s.a[a.offset + i];
    }
    return spin(a, q.data(), v.data());
}

const double *part(const VectorXd &x, const Attachment &a) { return x.data() + a.offset; }

void put(double *out, std::initializer_list<double> values) { std::copy(values.begin(), values.end(), out); }

bool matches(const char *pattern, const char *name) {
    if (*pattern == 0) return *name == 0;
    if (*pattern != '*') return *name == *pattern && matches(pattern + 1, name + 1);
    return matches(pattern + 1, name) || (*name != 0 && matches(pattern, name + 1));
}

double magnitude(Vec<double> a) { return std::sqrt(dot(a, a)); }

} // namespace

Channels::Channels(const Model &model) : model_(model), system_(model.system) {
    add("", {"t"}, [](const Snapshot &s, double *out) { *out = s.t; });
    add_bodies();
    add_deviation();
    add_joints();
    add_points();
    add_forces();
    add_energies();
}

void Channels::add(const std::string &prefix, std::initializer_list<const char *> quantities, Fill fill) {
    groups_.push_back({names_.size(), std::move(fill)});
    for (const char *quantity : quantities) names_.push_back(prefix + quantity);
}

void Channels::evaluate(const Snapshot &snapshot, double *values) const {
    for (const Group &group : groups_) group.fill(snapshot, values + group.first);
}

void Channels::note_absent(const std::string &prefix, std::initializer_list<const char *> quantities) {
    for (const char *quantity : quantities) absent_.push_back(prefix + quantity);
}

std::vector<std::size_t> Channels::selected(const std::vector<std::string> &patterns, const Source &source,
                                            std::vector<std::string> &notes) const {
    std::vector<std::size_t> chosen{0};
    for (const std::string &pattern : patterns) {
        bool any = false;
        for (std::size_t i = 0; i < names_.size(); ++i) {
            if (!matches(pattern.c_str(), names_[i].c_str())) continue;
            any = true;
            if (std::find(chosen.begin(), chosen.end(), i) == chosen.end()) chosen.push_back(i);
        }
        if (any) continue;
        const bool is_pattern = pattern.find('*') != std::string::npos;
        require(is_pattern || std::find(absent_.begin(), absent_.end(), pattern) != absent_.end(), source,
                "there is no channel \"" + pattern + "\"");
        notes.push_back(is_pattern ? "the pattern \"" + pattern + "\" matches no channel"
                                   : "the link is rigid or the joint ideal: there is no channel \"" + pattern + "\"");
    }
    return chosen;
}

void Channels::add_bodies() {
    for (std::size_t i = 0; i < system_.bodies().size(); ++i) {
        const Body &body = system_.bodies()[i];
        if (body.kind == BodyKind::ground) continue;
        const std::string prefix = body.name + ".";
        const int number = static_cast<int>(i);
        add(prefix, {"x", "y", "theta", "vx", "vy", "omega", "ax", "ay", "alpha"},
            [&body, number](const Snapshot &s, double *out) {
                const Vec<double> r = center(body, s.q), v = center(body, s.v), a = center(body, s.a);
                double omega = 0.0, alpha = 0.0;
                if (body.is_link()) {
                    const Vec<double> d = chord(body, s.q), d1 = chord(body, s.v), d2 = chord(body, s.a);
                    const Jet angle = atan2(jet(d.y, d1.y, d2.y), jet(d.x, d1.x, d2.x));
                    omega = rate_of(angle);
                    alpha = acceleration_of(angle);
                } else if (body.size == 3) {
                    omega = s.v[body.offset + 2];
                    alpha = s.a[body.offset + 2];
                }
                put(out, {r.x, r.y, s.angles.body[number], v.x, v.y, omega, a.x, a.y, alpha});
            });
        if (body.kind == BodyKind::flexible_link)
            add(prefix, {"strain"}, [&body](const Snapshot &s, double *out) { *out = largest_strain(body, s.q); });
        if (body.kind == BodyKind::rigid_link) note_absent(prefix, {"strain"});
    }
}

void Channels::add_deviation() {
    if (!model_.scene.inverse_kinematics) return;
    const InverseKinematicsDrive &drive = *model_.scene.inverse_kinematics;
    const int offset = system_.bodies()[drive.body].offset;
    add("error.", {"x", "y", "theta"}, [&drive, offset](const Snapshot &s, double *out) {
        for (int k = 0; k < 3; ++k) out[k] = s.q[offset + k] - ::evaluate(drive.path[k], s.t).value;
    });
}

void Channels::add_joints() {
    for (std::size_t i = 0; i < system_.joints().size(); ++i) {
        const std::string prefix = system_.joints()[i].name + ".";
        const int number = static_cast<int>(i);
        add(prefix, {"fx", "fy", "force"}, [this, number](const Snapshot &s, double *out) {
            const Vec<double> f = system_.joint_force(number, s.q, s.v, s.memory, s.lambda);
            put(out, {f.x, f.y, magnitude(f)});
        });
        add_joint_kinematics(prefix, number);
    }
}

void Channels::add_joint_kinematics(const std::string &prefix, int number) {
    const Joint &joint = system_.joints()[number];
    if (joint.law) {
        add(prefix, {"ex", "ey", "eccentricity", "ex_rate", "ey_rate", "eccentricity_rate", "penetration", "contact"},
            [this, number](const Snapshot &s, double *out) {
                const Gap g = system_.gap(number, s.q.data(), s.v.data());
                const bool touches = s.memory.impact_velocity[number] > 0.0 && g.delta() > 0.0;
                put(out, {g.e.x, g.e.y, g.size(), g.e_dot.x, g.e_dot.y, g.rate(), g.delta(), touches ? 1.0 : 0.0});
            });
        if (joint.bristle >= 0)
            add(prefix, {"bristle"}, [&joint, number](const Snapshot &s, double *out) {
                *out = s.memory.impact_velocity[number] > 0.0 ? s.memory.state[joint.bristle] : 0.0;
            });
    } else if (joint.kind == JointKind::revolute) {
        note_absent(prefix, {"ex", "ey", "eccentricity", "ex_rate", "ey_rate", "eccentricity_rate", "penetration", "contact",
                             "bristle"});
    }
    if (joint.driven)
        add(prefix, {"angle", "speed", "acceleration"}, [&joint, number](const Snapshot &s, double *out) {
            const Dual<double, 1> speed = turning(joint.journal, s) - turning(joint.bearing, s);
            put(out, {s.angles.joint[number], speed.value, speed.slope[0]});
        });
    if (joint.driven || joint.holds_angle)
        add(prefix, {"torque"}, [this, number](const Snapshot &s, double *out) {
            *out = system_.joint_couple(number, s.inputs, s.q, s.lambda);
        });
    if (joint.kind == JointKind::prismatic)
        add(prefix, {"travel", "travel_rate"}, [&joint](const Snapshot &s, double *out) {
            const Motion guide(joint.bearing, s), slider(joint.journal, s);
            const Jet *qi = guide.q.data(), *qj = slider.q.data();
            const Vec<Jet> line = rotated(direction(joint.bearing, qi), Jet(joint.direction));
            const Jet travel = dot(line, position(joint.journal, qj) - position(joint.bearing, qi)) / sqrt(dot(line, line));
            put(out, {value_of(travel), rate_of(travel)});
        });
}

void Channels::add_points() {
    for (std::size_t i = 0; i < system_.bodies().size(); ++i) {
        const Body &body = system_.bodies()[i];
        if (body.kind == BodyKind::ground) continue;
        for (const NamedPoint &named_point : model_.scene.bodies[i].points) {
            const Attachment point = make_attachment(body, named_point.at);
            const std::string prefix = "points." + body.name + "." + named_point.name + ".";
            add(prefix, {"x", "y", "vx", "vy", "ax", "ay"}, [point](const Snapshot &s, double *out) {
                const Motion motion(point, s);
                const Vec<Jet> r = position(point, motion.q.data());
                put(out, {value_of(r.x), value_of(r.y), rate_of(r.x), rate_of(r.y), acceleration_of(r.x),
                          acceleration_of(r.y)});
            });
            if (body.kind == BodyKind::flexible_link)
                add(prefix, {"slope_x", "slope_y"}, [point](const Snapshot &s, double *out) {
                    put(out, {s.q[point.offset + 2], s.q[point.offset + 3]});
                });
            if (body.kind == BodyKind::rigid_link) note_absent(prefix, {"slope_x", "slope_y"});
        }
    }
}

void Channels::add_forces() {
    for (const Load &load : system_.loads()) {
        const std::string prefix = load.name + ".";
        if (load.kind == LoadKind::torque)
            add(prefix, {"torque"},
                [&load](const Snapshot &s, double *out) { *out = s.inputs.given[load.x].value; });
        else
            add(prefix, {"fx", "fy"}, [&load](const Snapshot &s, double *out) {
                const Vec<double> given{s.inputs.given[load.x].value, s.inputs.given[load.y].value};
                const Vec<double> f = applied_force(load, given, part(s.q, load.point));
                put(out, {f.x, f.y});
            });
    }
    for (const Spring &spring : system_.springs())
        add(spring.name + ".", {"force", "length", "rate"}, [&spring](const Snapshot &s, double *out) {
            const double *qi = part(s.q, spring.from), *qj = part(s.q, spring.to);
            const Vec<double> e = position(spring.to, qj) - position(spring.from, qi);
            const Vec<double> rate =
                velocity(spring.to, qj, part(s.v, spring.to)) - velocity(spring.from, qi, part(s.v, spring.from));
            const double length = magnitude(e), growth = length > 0.0 ? dot(e, rate) / length : magnitude(rate);
            const double pull = spring.stiffness * (length - spring.rest_length) + spring.damping * growth;
            put(out, {pull, length, growth});
        });
    for (std::size_t i = 0; i < system_.maxwells().size(); ++i) {
        const Maxwell &m = system_.maxwells()[i];
        const int state = system_.elongation(static_cast<int>(i));
        add(m.name + ".", {"length", "elongation", "force"}, [&m, state](const Snapshot &s, double *out) {
            const double length = magnitude(position(m.to, part(s.q, m.to)) - position(m.from, part(s.q, m.from)));
            const double z = s.memory.state[state];
            put(out, {length, z, m.stiffness * (length - m.rest_length - z)});
        });
    }
    for (std::size_t i = 0; i < system_.torsion_springs().size(); ++i) {
        const TorsionSpring &spring = system_.torsion_springs()[i];
        const int number = static_cast<int>(i);
        add(spring.name + ".", {"torque", "angle", "speed"}, [&spring, number](const Snapshot &s, double *out) {
            const double angle = s.angles.spring[number], speed = rate(spring, s.q, s.v);
            const double torque = -spring.stiffness * (angle - spring.rest_angle) - spring.damping * speed;
            put(out, {torque, angle, speed});
        });
    }
}

void Channels::add_energies() {
    add("energy.", {"kinetic", "axial", "bending", "contact", "gravity"}, [this](const Snapshot &s, double *out) {
        const Energies u = system_.energies(s.q, s.v, s.memory);
        put(out, {u.kinetic, u.axial, u.bending, u.contact, u.gravity});
    });
    if (!system_.springs().empty() || !system_.torsion_springs().empty() || !system_.maxwells().empty())
        add("energy.", {"springs"}, [this](const Snapshot &s, double *out) {
            *out = system_.energies(s.q, s.v, s.memory).springs;
        });
    if (model_.scene.is_static) return;
    add("energy.", {"work", "contact_dissipated", "friction_dissipated"}, [](const Snapshot &s, double *out) {
        put(out, {s.ledger.work, s.ledger.contact_dissipated, s.ledger.friction_dissipated});
    });
    if (system_.bristles() > 0)
        add("energy.", {"normal_variation"}, [](const Snapshot &s, double *out) { *out = s.ledger.normal_variation; });
    add("energy.", {"damping_dissipated", "clamp", "numerical"}, [this](const Snapshot &s, double *out) {
        const Powers &l = s.ledger;
        const double balance = s.initial_energy + l.work + l.normal_variation - l.contact_dissipated -
                               l.friction_dissipated - l.damping_dissipated;
        put(out, {l.damping_dissipated, l.clamp, balance - system_.energies(s.q, s.v, s.memory).total()});
    });
}

// The legs of a driven parallel mechanism and the state they prescribe.
#include <cmath>

#include "failure.hpp"
#include "names.hpp"
#include "system.hpp"

namespace {

bool is_link(const Body &b) { return b.kind == LS_RIGID_LINK || b.kind == LS_FLEXIBLE_LINK; }

bool is_end(const Body &b, double x) { return x == 0.0 || std::abs(x - b.length) <= 1e-12 * b.length; }

} // namespace

void System::add_leg(const ls_leg &l, int number, const ls_mechanism &m) {
    const std::string name = named("leg", number);
    for (int joint : {l.joint_a, l.joint_b, l.joint_c})
        require(joint >= 0 && joint < joints(), name + ": there is no joint " + std::to_string(joint));
    require(l.elbow == 1 || l.elbow == -1, name + ": elbow must be 1 or -1");
    for (int joint : {l.joint_a, l.joint_b, l.joint_c})
        require(joints_[joint].kind == LS_REVOLUTE, name + ": joint " + std::to_string(joint) + " is not a revolute joint");
    const ls_joint &a = m.joints[l.joint_a], &b = m.joints[l.joint_b], &c = m.joints[l.joint_c];
    const int crank = a.journal.body, passive = b.journal.body;
    require(bodies_[a.bearing.body].kind == LS_GROUND, name + ": the bearing of joint A must be on ground");
    require(bodies_[crank].kind == LS_RIGID_LINK, name + ": the crank, journal of joint A, must be a rigid link");
    require(b.bearing.body == crank, name + ": the bearing of joint B must be on the crank");
    require(is_link(bodies_[passive]), name + ": the journal of joint B must be on a link");
    require(c.journal.body == passive, name + ": the journal of joint C must be on the passive link");
    require(c.bearing.body == m.path.body, name + ": the bearing of joint C must be on the driven body");
    for (double x : {b.journal.x, c.journal.x})
        require(is_end(bodies_[passive], x), name + ": joints B and C must be at the ends of the passive link");
    const Joint &ja = joints_[l.joint_a], &jc = joints_[l.joint_c];
    require(b.bearing.x != a.journal.x, name + ": joints A and B are at the same end of the crank");
    require((c.journal.x == 0.0) != (b.journal.x == 0.0), name + ": joints B and C are at the same end of the passive link");
    for (const Leg &other : legs_)
        require(other.crank != crank && other.passive != passive, name + ": shares a link with another leg");
    legs_.push_back({crank, passive, ja.journal.end == 0, b.journal.x == 0.0, ja.bearing.point, jc.bearing.point,
                     bodies_[crank].length, bodies_[passive].length, l.elbow});
}

void System::find_undriven() {
    std::vector<bool> placed(bodies_.size(), false);
    for (const Leg &leg : legs_) placed[leg.crank] = placed[leg.passive] = true;
    if (!legs_.empty()) placed[path_.body] = true;
    if (legs_.empty()) undriven_ = "there are no legs";
    for (std::size_t i = 0; i < bodies_.size(); ++i)
        if (undriven_.empty() && bodies_[i].size > 0 && !placed[i])
            undriven_ = named("body", static_cast<int>(i)) + " belongs to no leg";
}

std::vector<Prescribed> System::crank_angles(double t) const {
    std::vector<Prescribed> angles;
    const Jet time = time_jet(t);
    for (int i = 0; i < legs(); ++i) {
        const Jet phi = crank_angle(legs_[i], path_, time, i);
        angles.push_back({value_of(phi), rate_of(phi), acceleration_of(phi)});
    }
    return angles;
}

namespace {

void put(VectorXd &q, VectorXd &v, int i, const Vec<Jet> &x) {
    q[i] = value_of(x.x);
    q[i + 1] = value_of(x.y);
    v[i] = rate_of(x.x);
    v[i + 1] = rate_of(x.y);
}

// A link along the straight line from `start` to `end`.
void put_link(VectorXd &q, VectorXd &v, const Body &b, const Vec<Jet> &start, const Vec<Jet> &end) {
    if (b.kind == LS_RIGID_LINK) {
        put(q, v, b.offset, start);
        put(q, v, b.offset + 2, end);
        return;
    }
    const Vec<Jet> chord = end - start;
    const Jet inverse = 1.0 / sqrt(dot(chord, chord)); // of the length, exactly: unit slopes carry no strain
    for (int i = 0; i <= b.elements; ++i) {
        put(q, v, b.offset + 4 * i, start + Jet(static_cast<double>(i) / b.elements) * chord);
        put(q, v, b.offset + 4 * i + 2, inverse * chord);
    }
}

} // namespace

void System::start(double t, VectorXd &q, VectorXd &v) const {
    require(undriven_.empty(), "the start is undetermined: " + undriven_);
    q.setZero(n_);
    v.setZero(n_);
    const Jet time = time_jet(t);
    for (int i = 0; i < legs(); ++i) {
        const Leg &leg = legs_[i];
        const Jet phi = crank_angle(leg, path_, time, i);
        const Vec<Jet> a{Jet(leg.a.x), Jet(leg.a.y)};
        const Vec<Jet> b = a + Jet(leg.crank_length) * Vec<Jet>{cos(phi), sin(phi)};
        const Vec<Jet> c = path_point(path_, leg.c_on_body, time);
        put_link(q, v, bodies_[leg.crank], leg.crank_from_start ? a : b, leg.crank_from_start ? b : a);
        put_link(q, v, bodies_[leg.passive], leg.passive_from_start ? b : c, leg.passive_from_start ? c : b);
    }
    const int o = bodies_[path_.body].offset;
    put(q, v, o, path_centre(path_, time));
    q[o + 2] = path_.theta;
}

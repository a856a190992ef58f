#include "inverse_kinematics.hpp"

#include <cmath>

namespace {

constexpr double pi = 3.14159265358979323846;

template <class T>
Vec<T> lifted(Vec<double> a) { return {T(a.x), T(a.y)}; }

double angle_of(Vec<double> a) { return std::atan2(a.y, a.x); }

Vec<double> on(const Frame &pose, Vec<double> at) { return Vec<double>{pose.x, pose.y} + rotated(at, pose.theta); }

// A joint between two bodies, seen from one of them.
struct Side {
    Vec<double> here;
    PointReference there;
};
std::optional<Side> side(const JointDescription &joint, int body) {
    if (joint.kind != JointKind::revolute) return {};
    if (joint.first.body == body) return Side{joint.first.at, joint.second};
    if (joint.second.body == body) return Side{joint.second.at, joint.first};
    return {};
}

} // namespace

InverseKinematics::InverseKinematics(const Scene &ideal, const std::vector<Frame> &start) {
    std::vector<bool> placed;
    for (const BodyDescription &body : ideal.bodies) {
        paths_.push_back(body.path);
        placed.push_back(body.kind == BodyKind::ground || body.path);
    }
    while (find_pair(ideal, placed, start)) {}
    for (int j : ideal.inverse_kinematics->joints) {
        const JointDescription &joint = ideal.joints[j];
        complete_ = complete_ && placed[joint.first.body] && placed[joint.second.body];
        joints_.push_back({joint.first.body, joint.second.body});
    }
}

bool InverseKinematics::find_pair(const Scene &ideal, std::vector<bool> &placed, const std::vector<Frame> &start) {
    // a joint of the body with a placed one
    auto anchor = [&](int body) -> std::optional<Side> {
        for (const JointDescription &joint : ideal.joints) {
            const std::optional<Side> s = side(joint, body);
            if (s && placed[s->there.body]) return s;
        }
        return {};
    };
    for (const JointDescription &b : ideal.joints) {
        const int crank = b.first.body, passive = b.second.body;
        if (b.kind != JointKind::revolute || placed[crank] || placed[passive]) continue;
        const std::optional<Side> a = anchor(crank), c = anchor(passive);
        if (!a || !c) continue;
        const Vec<double> at_a = on(start[crank], a->here), at_b = on(start[crank], b.first.at),
                          at_c = on(start[passive], c->here);
        const double elbow = cross(at_b - at_a, at_c - at_b) < 0.0 ? -1.0 : 1.0;
        pairs_.push_back({a->there, c->there, crank, passive, a->here, b.first.at, b.second.at, c->here, elbow, b.name});
        placed[crank] = placed[passive] = true;
        return true;
    }
    return false;
}

// Law of cosines in the triangle A B C: the angle at A between A C and the crank. Since B - A turns from A C by it,
// (B - A) x (C - B) = (B - A) x (C - A) is positive when the crank lies clockwise of A C.
void InverseKinematics::place(const Pair &pair, std::vector<Pose> &poses, double t) {
    auto point = [&](const PointReference &p) {
        const Pose &pose = poses[p.body];
        return pose.center + rotated(lifted<Jet>(p.at), pose.theta);
    };
    const Vec<Jet> a = point(pair.a), c = point(pair.c), ac = c - a;
    const Vec<double> crank = pair.crank_b - pair.crank_a, passive = pair.passive_c - pair.passive_b;
    const double l1 = std::sqrt(dot(crank, crank)), l2 = std::sqrt(dot(passive, passive));
    const Jet square = dot(ac, ac);
    const double distance = std::sqrt(value_of(square));
    if (!(distance < l1 + l2 && distance > std::abs(l1 - l2)))
        throw Failure(LS_UNREACHABLE, "inverse kinematics: the path is out of reach of the bodies joined by `" +
                                          pair.name + "`", t);
    const Jet opening = acos((square + (l1 * l1 - l2 * l2)) / (2.0 * l1 * sqrt(square)));
    const Jet phi = atan2(ac.y, ac.x) - pair.elbow * opening;
    const Vec<Jet> b = a + Vec<Jet>{l1 * cos(phi), l1 * sin(phi)}, bc = c - b;
    auto put = [&](int body, const Jet &theta, const Vec<Jet> &fixed, Vec<double> at) {
        poses[body] = {fixed - rotated(lifted<Jet>(at), theta), theta};
    };
    put(pair.crank, phi - angle_of(crank), a, pair.crank_a);
    put(pair.passive, atan2(bc.y, bc.x) - angle_of(passive), c, pair.passive_c);
}

std::vector<Prescribed> InverseKinematics::at_time(double t) const {
    const Jet time = jet(t, 1.0, 0.0);
    std::vector<Pose> poses(paths_.size());
    for (std::size_t i = 0; i < paths_.size(); ++i)
        if (paths_[i]) poses[i] = {{at((*paths_[i])[0], time), at((*paths_[i])[1], time)}, at((*paths_[i])[2], time)};
    for (const Pair &pair : pairs_) place(pair, poses, t);
    std::vector<Prescribed> angles;
    for (const ActuatedJoint &joint : joints_) {
        const Jet angle = poses[joint.second].theta - poses[joint.first].theta;
        const double turns = std::ceil((value_of(angle) - pi) / (2.0 * pi));
        angles.push_back({value_of(angle) - 2.0 * pi * turns, rate_of(angle), acceleration_of(angle)});
    }
    return angles;
}

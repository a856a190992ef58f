#include "placing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace {

double length(Vec<double> a) { return std::hypot(a.x, a.y); }
double angle_of(Vec<double> a) { return std::atan2(a.y, a.x); }

struct KnownPoint {
    Vec<double> on_body, place;
};

// What is known of one body.
struct Known {
    std::vector<KnownPoint> points;
    std::optional<double> angle;
};

using Placed = std::vector<std::optional<Frame>>; // by body

Known gather(const Scene &ideal, int body, const Placed &placed) {
    Known known;
    for (std::size_t j = 0; j < ideal.joints.size(); ++j) {
        const JointDescription &joint = ideal.joints[j];
        const bool is_first = joint.first.body == body;
        if (!is_first && joint.second.body != body) continue;
        const PointReference &here = is_first ? joint.first : joint.second;
        const PointReference &there = is_first ? joint.second : joint.first;
        const bool coincide = joint.kind == JointKind::revolute || joint.kind == JointKind::weld;
        for (const SketchedJoint &sketch : ideal.initial.joints)
            if (sketch.joint == static_cast<int>(j) && (coincide || !is_first))
                known.points.push_back({here.at, sketch.at});
        if (!placed[there.body]) continue;
        const Frame &other = *placed[there.body];
        if (coincide) known.points.push_back({here.at, point_at(other, there.at)});
        std::optional<double> angle; // of the second body relative to the first
        if (joint.holds_angle()) angle = joint.angle;
        for (const AngleDrive &drive : ideal.angle_drives)
            if (drive.joint == static_cast<int>(j)) angle = evaluate(drive.angle, 0.0).value;
        if (angle) known.angle = is_first ? other.theta - *angle : other.theta + *angle;
    }
    for (const SketchedPoint &sketch : ideal.initial.points)
        if (sketch.point.body == body) known.points.push_back({sketch.point.at, sketch.at});
    for (const PointDrive &drive : ideal.point_drives)
        if (drive.point.body == body && drive.x && drive.y)
            known.points.push_back({drive.point.at, {evaluate(*drive.x, 0.0).value, evaluate(*drive.y, 0.0).value}});
    return known;
}

// The two points that are farthest apart on the body give its angle.
std::optional<double> angle_from_points(const std::vector<KnownPoint> &points) {
    double widest = 0.0;
    std::optional<double> angle;
    for (const KnownPoint &a : points)
        for (const KnownPoint &b : points) {
            const Vec<double> on_body = b.on_body - a.on_body, place = b.place - a.place;
            if (length(on_body) <= widest || length(place) == 0.0) continue;
            widest = length(on_body);
            angle = std::remainder(angle_of(place) - angle_of(on_body), 2.0 * 3.14159265358979323846);
        }
    return angle;
}

std::optional<Frame> place(const Known &known, bool has_angle) {
    if (known.points.empty()) return {};
    const std::optional<double> angle =
        !has_angle ? 0.0 : known.angle ? known.angle : angle_from_points(known.points);
    if (!angle) return {};
    Frame frame{0.0, 0.0, *angle}; // the points fit in the mean
    for (const KnownPoint &p : known.points) {
        const Vec<double> center = p.place - rotated(p.on_body, *angle);
        frame.x += center.x / static_cast<double>(known.points.size());
        frame.y += center.y / static_cast<double>(known.points.size());
    }
    return frame;
}

// Of a link its length, of a rigid body the distance from the joint to its farthest point; infinite where there is none.
double size_at(const BodyDescription &body, Vec<double> joint) {
    if (body.length > 0.0) return body.length;
    double size = 0.0;
    if (body.kind == BodyKind::rigid_body)
        for (const NamedPoint &point : body.points) size = std::max(size, length(point.at - joint));
    return size > 0.0 ? size : std::numeric_limits<double>::infinity();
}

} // namespace

Vec<double> point_at(const Frame &pose, Vec<double> at) {
    return Vec<double>{pose.x, pose.y} + rotated(at, pose.theta);
}

std::vector<Frame> place_bodies(const Scene &ideal) {
    Placed placed(ideal.bodies.size());
    for (std::size_t i = 0; i < placed.size(); ++i) {
        const BodyDescription &body = ideal.bodies[i];
        if (body.kind == BodyKind::ground) placed[i] = Frame{};
        if (ideal.initial.states[i]) placed[i] = ideal.initial.states[i]->pose;
        if (body.path) {
            const Path &path = *body.path;
            placed[i] = {evaluate(path[0], 0.0).value, evaluate(path[1], 0.0).value, evaluate(path[2], 0.0).value};
        }
    }
    for (bool progress = true; progress;) {
        progress = false;
        for (std::size_t i = 0; i < placed.size(); ++i) {
            if (placed[i]) continue;
            placed[i] = place(gather(ideal, static_cast<int>(i), placed), ideal.bodies[i].has_direction());
            progress = progress || placed[i];
        }
    }
    std::vector<Frame> frames;
    for (std::size_t i = 0; i < placed.size(); ++i) {
        require(placed[i].has_value(), ideal.bodies[i].source,
                "the start does not say where this body is: sketch its joints or points, or give its state");
        frames.push_back(*placed[i]);
    }
    return frames;
}

void check_sketch(const Scene &ideal, const std::vector<Frame> &poses) {
    for (const SketchedJoint &sketch : ideal.initial.joints) {
        const JointDescription &joint = ideal.joints[sketch.joint];
        const Vec<double> end = point_at(poses[joint.second.body], joint.second.at);
        const double distance = length(end - sketch.at);
        const double size = std::min(size_at(ideal.bodies[joint.first.body], joint.first.at),
                                     size_at(ideal.bodies[joint.second.body], joint.second.at));
        require(distance <= 0.25 * size, sketch.source,
                "the joint is at [" + text_of(end.x) + ", " + text_of(end.y) + "], " + text_of(distance) +
                    " m from its sketch, more than a quarter of its smaller body");
    }
}

// A scene as data: names resolved, materials and sections turned into masses and stiffnesses.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "contact.hpp"
#include "failure.hpp"
#include "function.hpp"
#include "plane.hpp"

struct NamedPoint {
    std::string name;
    Vec<double> at; // ground, moving body: in its frame; rigid body: from the centre of mass; link: (distance, 0)
};

enum class BodyKind { ground, moving, rigid_body, point_mass, rigid_link, flexible_link };

struct BodyDescription {
    std::string name;
    Source source;
    BodyKind kind = BodyKind::ground;
    std::vector<NamedPoint> points;
    double mass = 0.0, inertia = 0.0; // about the centre of mass
    double length = 0.0;              // links
    int elements = 0;                 // flexible links, as the rest
    double axial_stiffness = 0.0, bending_stiffness = 0.0;
    double strain_damping = 0.0; // retardation time, s
    double mass_damping = 0.0;   // 1/s
    std::optional<Path> path;    // prescribes x, y, theta

    bool is_link() const { return kind == BodyKind::rigid_link || kind == BodyKind::flexible_link; }
    bool has_direction() const { return kind != BodyKind::point_mass; }
};

struct PointReference {
    int body = 0;
    Vec<double> at; // as NamedPoint::at
};

enum class JointKind { revolute, prismatic, weld, rod };

struct JointDescription {
    std::string name;
    Source source;
    JointKind kind = JointKind::revolute;
    PointReference first, second;  // bearing, guide; journal, slider
    std::optional<ContactLaw> law; // with clearance: revolute, or prismatic without locked rotation (a loose guide)
    double direction = 0.0;        // prismatic: angle of the line in the frame of the first body
    bool locked = false;           // prismatic
    double angle = 0.0;            // locked prismatic, weld
    bool slope_vector = false;     // weld
    double length = 0.0;           // rod

    bool holds_angle() const { return locked || kind == JointKind::weld; }
};

struct AngleDrive {
    std::string name;
    Source source;
    int joint = 0;
    TimeFunction angle;
};

struct PointDrive {
    std::string name;
    Source source;
    PointReference point;
    std::optional<TimeFunction> x, y;
};

struct InverseKinematicsDrive {
    std::string name;
    Source source;
    std::vector<int> joints;
    int body = 0;
    Path path;
};

struct SpringDescription {
    std::string name;
    Source source;
    PointReference from, to;
    double stiffness = 0.0, damping = 0.0, rest_length = 0.0;
};

struct TorsionSpringDescription {
    std::string name;
    Source source;
    int joint = 0;
    double stiffness = 0.0, damping = 0.0, rest_angle = 0.0;
};

struct MaxwellDescription {
    std::string name;
    Source source;
    PointReference from, to;
    double stiffness = 0.0, damping = 0.0, rest_length = 0.0;
    double elongation = 0.0; // of the damper at t = 0
};

enum class LoadKind { dead_force, follower_force, torque };

struct LoadDescription {
    std::string name;
    Source source;
    LoadKind kind = LoadKind::dead_force;
    PointReference point, reaction; // reaction: torque
    TimeFunction x, y;              // torque: x
};

// The state of a body: its centre of mass and angle, and their rates. A point mass has no angle.
struct Frame {
    double x = 0.0, y = 0.0, theta = 0.0;
};
// What a flexible link does at the start beside the motion of a straight line of its own length. x is the distance of a point
// from the middle of the undeformed link, positive towards its end.
struct Deformation {
    double strain = 0.0;       // (r'.r' - 1) / 2, uniform
    double bending_rate = 0.0; // uniform rate of r'' across the link, 1/(m s)

    bool any() const { return strain != 0.0 || bending_rate != 0.0; }
    double stretch() const { return std::sqrt(1.0 + 2.0 * strain); } // |r'|
    // Velocity across the link, of a link of the given length without momentum and moment of momentum.
    double velocity(double x, double length) const { return bending_rate * (0.5 * x * x - length * length / 24.0); }
    double slope_rate(double x) const { return bending_rate * x; } // the derivative of this velocity by x
};
struct State {
    Source source;
    Frame pose;
    std::optional<Frame> velocity;
    Deformation deformation; // flexible links
};

struct SingleVelocity {
    Source source;
    int body = 0;
    int component = 0; // 0 vx, 1 vy, 2 omega
    double value = 0.0;
};

struct SketchedJoint {
    Source source;
    int joint = 0;
    Vec<double> at;
};
struct SketchedPoint {
    Source source;
    PointReference point;
    Vec<double> at;
};

struct Initial {
    std::vector<SketchedJoint> joints;
    std::vector<SketchedPoint> points;
    std::vector<std::optional<State>> states; // by body
    std::vector<SingleVelocity> velocities;
    bool pressed = false; // the journals
    enum class Rest { none, downhill, nearest } equilibrium = Rest::none;
};

struct Scene {
    std::string title;
    bool is_static = false;
    bool follow_at_limit = false; // static
    double duration = 0.0;
    Vec<double> gravity{0.0, 0.0};
    double step = 0.0; // 0: an accuracy instead
    double onset_tolerance = 0.0;
    double interval = 0.0;
    std::vector<std::string> patterns; // of channels
    Source patterns_source;
    std::vector<BodyDescription> bodies;
    std::vector<JointDescription> joints;
    std::vector<AngleDrive> angle_drives;
    std::vector<PointDrive> point_drives;
    std::optional<InverseKinematicsDrive> inverse_kinematics;
    std::vector<SpringDescription> springs;
    std::vector<TorsionSpringDescription> torsion_springs;
    std::vector<MaxwellDescription> maxwells;
    std::vector<LoadDescription> loads;
    Initial initial;
};

Scene read_scene(const std::string &text, const std::vector<std::string> &overrides);

// Functions of time, paths and drives.
#include <algorithm>

#include "reader.hpp"

namespace {

constexpr double pi = 3.14159265358979323846;

// Rows [t, value, ...], one vector a column.
std::vector<std::vector<double>> read_rows(const Value &value, std::size_t columns, double duration) {
    as_array(value);
    require(value.items.size() >= 2, value.source, "must have two rows or more");
    std::vector<std::vector<double>> table(columns);
    for (const Value &item : value.items) {
        const std::vector<double> row = as_numbers(item, columns);
        require(table[0].empty() || row[0] > table[0].back(), item.source, "the times must increase");
        for (std::size_t i = 0; i < columns; ++i) table[i].push_back(row[i]);
    }
    require(table[0].front() <= 0.0, value.source, "the first time must be 0 or earlier");
    require(table[0].back() >= duration, value.source, "the last time must reach the duration of the simulation");
    return table;
}

// One curve a column of values.
std::vector<TimeFunction> read_table(Fields &f, std::size_t columns, double duration) {
    const std::vector<std::vector<double>> table = read_rows(f.get("rows"), columns, duration);
    const bool monotone = f.has("shape") && f.choice<bool>("shape", {{"natural", false}, {"monotone", true}});
    std::vector<TimeFunction> curves;
    for (std::size_t i = 1; i < columns; ++i)
        if (monotone)
            curves.emplace_back(monotone_table(table[0], table[i]));
        else
            curves.emplace_back(natural_spline(table[0], table[i]));
    return curves;
}

} // namespace

TimeFunction read_function(const Value &value, double duration) {
    if (value.is_number()) return Constant{as_number(value)};
    if (value.kind == Value::string) return read_expression(value, duration, Use::load);
    require(value.kind == Value::table, value.source, "must be a number, an expression in quotes or a table");
    enum class Type { polynomial, harmonic, ramp, smooth_step, piecewise, spin_up, table };
    Fields f(value);
    TimeFunction function;
    switch (f.choice<Type>("type", {{"polynomial", Type::polynomial},
                                    {"harmonic", Type::harmonic},
                                    {"ramp", Type::ramp},
                                    {"smooth_step", Type::smooth_step},
                                    {"piecewise", Type::piecewise},
                                    {"spin_up", Type::spin_up},
                                    {"table", Type::table}})) {
    case Type::polynomial: {
        const Value &list = as_array(f.get("coefficients"));
        require(!list.items.empty(), list.source, "must have one coefficient at least");
        function = Polynomial{as_numbers(list, list.items.size())};
        break;
    }
    case Type::harmonic:
        function = Harmonic{f.number("mean"), f.number("amplitude"), f.number("frequency"), f.number("phase")};
        break;
    case Type::ramp: function = Ramp{f.number("from"), f.number("to"), f.number("start"), f.positive("duration")}; break;
    case Type::smooth_step:
        function = SmoothStep{f.number("from"), f.number("to"), f.number("start"), f.positive("duration")};
        break;
    case Type::piecewise: {
        std::vector<std::vector<double>> table = read_rows(f.get("rows"), 2, duration);
        function = PiecewiseLinear{std::move(table[0]), std::move(table[1])};
        break;
    }
    case Type::spin_up: function = SpinUp{f.number("start"), f.number("speed"), f.positive("duration")}; break;
    case Type::table: function = read_table(f, 2, duration)[0]; break;
    }
    f.finish();
    return function;
}

TimeFunction read_motion(const Value &value, double duration) {
    if (value.kind == Value::string) return read_expression(value, duration, Use::motion);
    TimeFunction function = read_function(value, duration);
    require(!std::holds_alternative<Ramp>(function), value.source, "a ramp cannot prescribe a motion, because its rate jumps");
    require(!std::holds_alternative<PiecewiseLinear>(function), value.source,
            "straight lines between rows cannot prescribe a motion, because its rate jumps");
    return function;
}

Path read_path(const Value &value, double duration) {
    enum class Type { circle, line, table, coordinates };
    Fields f(value);
    Path path;
    switch (f.choice<Type>("type", {{"circle", Type::circle},
                                    {"line", Type::line},
                                    {"table", Type::table},
                                    {"coordinates", Type::coordinates}})) {
    case Type::circle: {
        const Vec<double> center = f.pair("center");
        const double radius = f.not_negative("radius"), frequency = f.number("frequency"), phase = f.number("phase");
        path = {Harmonic{center.x, radius, frequency, phase + 0.5 * pi}, Harmonic{center.y, radius, frequency, phase},
                Constant{f.number("theta")}};
        break;
    }
    case Type::line: {
        const std::vector<double> from = as_numbers(f.get("from"), 3), to = as_numbers(f.get("to"), 3);
        const double time = f.positive("duration");
        for (std::size_t i = 0; i < 3; ++i) path[i] = SmoothStep{from[i], to[i], 0.0, time};
        break;
    }
    case Type::table: {
        const std::vector<TimeFunction> curves = read_table(f, 4, duration);
        std::copy(curves.begin(), curves.end(), path.begin());
        break;
    }
    case Type::coordinates:
        path = {read_motion(f.get("x"), duration), read_motion(f.get("y"), duration),
                read_motion(f.get("theta"), duration)};
        break;
    }
    f.finish();
    return path;
}

namespace {

void read_inverse_kinematics(Fields &f, const std::string &name, const Library &library, Scene &scene) {
    InverseKinematicsDrive drive;
    drive.name = name;
    drive.source = f.source();
    require(!scene.inverse_kinematics, f.source(), "there may be only one drive of this type");
    const Value &list = as_array(f.get("joints"));
    require(!list.items.empty(), list.source, "must name one joint at least");
    for (const Value &item : list.items) {
        const int number = read_turning_joint(item, scene, library);
        require(!scene.joints[number].law, item.source, "an actuated joint must be ideal");
        const bool fresh = std::find(drive.joints.begin(), drive.joints.end(), number) == drive.joints.end();
        require(fresh, item.source, "at most one drive may act on a joint");
        drive.joints.push_back(number);
    }
    drive.body = named(library.bodies, f.get("body"), "body");
    require(scene.bodies[drive.body].kind == BodyKind::rigid_body, f.source("body"), "must be of type \"rigid_body\"");
    drive.path = read_path(f.get("path"), scene.duration);

    // bodies that a chain of actuated joints connects to the ground
    std::vector<bool> reached;
    for (const BodyDescription &body : scene.bodies) reached.push_back(body.kind == BodyKind::ground);
    for (std::size_t pass = 0; pass < drive.joints.size(); ++pass)
        for (int j : drive.joints) {
            const int first = scene.joints[j].first.body, second = scene.joints[j].second.body;
            if (reached[first] || reached[second]) reached[first] = reached[second] = true;
        }
    for (int j : drive.joints) {
        const JointDescription &joint = scene.joints[j];
        require(reached[joint.first.body], list.source,
                "no chain of actuated joints connects `" + joint.name + "` to the ground");
        for (int body : {joint.first.body, joint.second.body})
            require(scene.bodies[body].kind != BodyKind::flexible_link, list.source,
                    "the body `" + scene.bodies[body].name + "` that `" + joint.name + "` moves is not rigid");
    }
    scene.inverse_kinematics = std::move(drive);
}

bool is_driven(const Scene &scene, int joint) {
    for (const AngleDrive &drive : scene.angle_drives)
        if (drive.joint == joint) return true;
    return false;
}

} // namespace

void read_drive(const std::string &name, const Value &value, const Library &library, Scene &scene) {
    enum class Type { inverse_kinematics, angle, point };
    Fields f(value);
    switch (f.choice<Type>("type", {{"inverse_kinematics", Type::inverse_kinematics},
                                    {"angle", Type::angle},
                                    {"point", Type::point}})) {
    case Type::inverse_kinematics: read_inverse_kinematics(f, name, library, scene); break;
    case Type::angle: {
        const int joint = read_turning_joint(f.get("joint"), scene, library);
        require(!is_driven(scene, joint), f.source("joint"), "at most one drive may act on a joint");
        scene.angle_drives.push_back({name, value.source, joint, read_motion(f.get("angle"), scene.duration)});
        break;
    }
    case Type::point: {
        PointDrive drive{name, value.source, read_point(f.get("point"), scene, library), {}, {}};
        const BodyKind kind = scene.bodies[drive.point.body].kind;
        require(kind != BodyKind::ground && kind != BodyKind::moving, f.source("point"),
                "the point is fixed, or its motion is prescribed already");
        if (const Value *x = f.find("x")) drive.x = read_motion(*x, scene.duration);
        if (const Value *y = f.find("y")) drive.y = read_motion(*y, scene.duration);
        require(drive.x || drive.y, value.source, "needs x or y");
        scene.point_drives.push_back(std::move(drive));
        break;
    }
    }
    f.finish();
    if (scene.inverse_kinematics)
        for (int joint : scene.inverse_kinematics->joints)
            require(!is_driven(scene, joint), value.source, "at most one drive may act on a joint");
}

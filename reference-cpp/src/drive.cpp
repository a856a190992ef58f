#include "drive.hpp"

#include "failure.hpp"

namespace {
constexpr double pi = 3.14159265358979323846;
}

Jet time_jet(double t) { return jet(t, 1.0, 0.0); }

Vec<Jet> path_centre(const Path &p, const Jet &t) {
    const Jet angle = 2.0 * pi * p.frequency * t + p.phase;
    return {p.centre.x + p.radius * cos(angle), p.centre.y + p.radius * sin(angle)};
}

Vec<Jet> path_point(const Path &p, Vec<double> s, const Jet &t) {
    const double c = std::cos(p.theta), n = std::sin(p.theta);
    const Vec<Jet> centre = path_centre(p, t);
    return {centre.x + (c * s.x - n * s.y), centre.y + (n * s.x + c * s.y)};
}

// Law of cosines in the triangle A B C: the angle at A between A C and the crank. Since B - A turns from A C by it,
// (B - A) x (C - B) = (B - A) x (C - A) is positive when the crank lies clockwise of A C.
Jet crank_angle(const Leg &leg, const Path &path, const Jet &t, int number) {
    const Vec<Jet> c = path_point(path, leg.c_on_body, t);
    const Vec<Jet> ac{c.x - leg.a.x, c.y - leg.a.y};
    const Jet square = dot(ac, ac);
    const double l1 = leg.crank_length, l2 = leg.passive_length;
    const double distance = std::sqrt(value_of(square));
    if (!(distance < l1 + l2 && distance > std::abs(l1 - l2)))
        throw Failure(LS_UNREACHABLE, "leg " + std::to_string(number) + ": the driven body is out of reach", value_of(t));
    const Jet opening = acos((square + (l1 * l1 - l2 * l2)) / (2.0 * l1 * sqrt(square)));
    const Jet direction = atan2(ac.y, ac.x);
    Jet angle = leg.elbow > 0 ? direction - opening : direction + opening;
    if (value_of(angle) > pi) angle = angle - 2.0 * pi;
    if (value_of(angle) <= -pi) angle = angle + 2.0 * pi;
    return angle;
}

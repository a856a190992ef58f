// Inverse kinematics of the ideal rigid mechanism, leg by leg, and the path of eq. 27.
#pragma once

#include "dual.hpp"
#include "plane.hpp"

struct Leg {
    int crank, passive;               // bodies
    bool crank_from_start;            // A is the start of the crank
    bool passive_from_start;          // B is the start of the passive link
    Vec<double> a;                    // the fixed pivot
    Vec<double> c_on_body;            // C in the axes of the driven body
    double crank_length, passive_length;
    int elbow;                        // sign of (B - A) x (C - B)
};

struct Path {
    int body;
    Vec<double> centre;
    double radius, frequency, phase, theta;
};

Jet time_jet(double t);
Vec<Jet> path_centre(const Path &path, const Jet &t);            // eq. 27
Vec<Jet> path_point(const Path &path, Vec<double> on_body, const Jet &t);

// The crank angle that puts C on the path; throws LS_UNREACHABLE. `number` names the leg.
Jet crank_angle(const Leg &leg, const Path &path, const Jet &t, int number);

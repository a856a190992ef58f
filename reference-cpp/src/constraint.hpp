// Constraint rows Phi(t, q) = 0. Time enters through the prescribed crank angles only.
#pragma once

#include <Eigen/Dense>
#include <array>

#include "bodies.hpp"

// A prescribed angle with its derivatives.
struct CrankAngle {
    double angle = 0.0, rate = 0.0, acceleration = 0.0;
};

constexpr int constraint_size = 2 * attachment_size;

struct Constraint {
    enum Kind { length, coincide, drive } kind;
    std::array<int, constraint_size> index; // the coordinates it depends on, in the order of `row`
    int size;
    double link_length;          // length, drive
    Attachment bearing, journal; // coincide
    int axis;                    // coincide: 0 x, 1 y
    int leg;                     // drive
    double sense;                // drive: +1 if A is the start of the crank, -1 if its end
    bool linear;                 // in its coordinates
};

Constraint length_constraint(const Body &link);
Constraint coincide_constraint(const Attachment &bearing, const Attachment &journal, int axis);
Constraint drive_constraint(const Body &crank, bool from_start, int leg);

// What a solver needs of a row beyond Phi itself.
struct ConstraintRow {
    double value = 0.0;
    double by_angle = 0.0;                            // d/d(phi)
    std::array<double, constraint_size> by_q{};       // d/dq of the coordinates listed in `index`
};
ConstraintRow evaluate(const Constraint &c, const Eigen::VectorXd &q, double angle);

// d2Phi/dt2 at zero acceleration of q: the part of it that does not depend on a.
double convective_acceleration(const Constraint &c, const Eigen::VectorXd &q, const Eigen::VectorXd &v,
                               const CrankAngle &angle);

// Second derivatives by the coordinates (first `size`) and the angle (last).
using ConstraintHessian = Eigen::Matrix<double, constraint_size + 1, constraint_size + 1>;
void hessian(const Constraint &c, const Eigen::VectorXd &q, double angle, ConstraintHessian &h);

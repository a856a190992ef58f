// Constraint rows Phi(t, q) = 0. Time enters through one prescribed quantity a row: an angle or a coordinate.
#pragma once

#include <Eigen/Dense>
#include <array>

#include "bodies.hpp"
#include "function.hpp"

constexpr int constraint_size = 2 * attachment_size;

struct Constraint {
    enum Kind {
        length,     // of a rigid link
        coordinate, // of a moving body
        coincide,   // two points, one component
        slide,      // the journal on a line of the bearing's body
        align,      // angle of d_2 relative to d_1
        slope,      // d_2 relative to d_1 in full, one component
        drive,      // angle of the crank of a leg
        place       // n . r of the journal
    } kind;
    std::array<int, constraint_size> index; // the coordinates it depends on, in the order of `row`
    int size;
    double link_length;          // length, drive
    Attachment bearing, journal; // coincide, slide, align, slope; place: the journal only
    int axis;                    // coincide, slope: 0 x, 1 y
    double angle;                // slide, slope, align that is not prescribed: R turns by it
    Vec<double> normal;          // place
    int leg;                     // drive: the one that prescribes the angle, else -1
    int function;                // prescribes the angle or the coordinate, else -1
    double sense;                // drive: +1 if A is the start of the crank, -1 if its end
    bool linear;                 // in its coordinates

    bool timed() const { return leg >= 0 || function >= 0; }
};

Constraint length_constraint(const Body &link);
Constraint coordinate_constraint(const Body &moving_body, int coordinate, int function);
Constraint coincide_constraint(const Attachment &bearing, const Attachment &journal, int axis);
Constraint slide_constraint(const Attachment &bearing, const Attachment &journal, double direction);
Constraint align_constraint(const Attachment &bearing, const Attachment &journal, double angle);
Constraint turn_constraint(const Attachment &bearing, const Attachment &journal, int function); // align, prescribed
Constraint slope_constraint(const Attachment &bearing, const Attachment &journal, double angle, int axis);
Constraint drive_constraint(const Body &crank, bool from_start, int leg);
Constraint place_constraint(const Attachment &point, Vec<double> normal, int function);

// What a solver needs of a row beyond Phi itself.
struct ConstraintRow {
    double value = 0.0;
    double by_given = 0.0;                      // by the prescribed quantity
    std::array<double, constraint_size> by_q{}; // by the coordinates listed in `index`
};
ConstraintRow evaluate(const Constraint &c, const Eigen::VectorXd &q, double given);

// d2Phi/dt2 at zero acceleration of q: the part of it that does not depend on a.
double convective_acceleration(const Constraint &c, const Eigen::VectorXd &q, const Eigen::VectorXd &v,
                               const Prescribed &given);

// Second derivatives by the coordinates (first `size`) and the prescribed quantity (last).
using ConstraintHessian = Eigen::Matrix<double, constraint_size + 1, constraint_size + 1>;
void hessian(const Constraint &c, const Eigen::VectorXd &q, double given, ConstraintHessian &h);

// dPhi/d(r_2) of a slide row.
Vec<double> by_journal(const Constraint &c, const Eigen::VectorXd &q);
// dPhi/d(rotation of d_2) of an align or slope row.
double by_rotation(const Constraint &c, const Eigen::VectorXd &q, double given);
// An angle satisfies Phi = 0 in two positions, half a turn apart: whether it is in the one half of the turn that is meant.
bool right_way_round(const Constraint &c, const Eigen::VectorXd &q, double given);

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
        distance,   // of two points
        coordinate, // prescribed, of a body
        coincide,   // two points, one component
        slide,      // the journal on a line of the bearing's body
        align,      // angle of d_2 relative to d_1
        slope,      // d_2 relative to d_1 in full, one component
        place       // one component of the journal's position
    } kind;
    std::array<int, constraint_size> index; // the coordinates it depends on, in the order of `row`
    int size;
    double link_length;          // length, distance: that of the link or rod
    Attachment bearing, journal; // distance, coincide, slide, align, slope; place: the journal only
    int axis;                    // coincide, slope, place: 0 x, 1 y
    double angle;                // slide, slope, align that is not prescribed: R turns by it
    int given;                   // index in Inputs::given of the angle or coordinate prescribed, else -1
    bool linear;                 // in its coordinates

    bool timed() const { return given >= 0; }
};

Constraint length_constraint(const Body &link);
Constraint distance_constraint(const Attachment &bearing, const Attachment &journal, double length);
Constraint coordinate_constraint(const Body &body, int coordinate, int given);
Constraint coincide_constraint(const Attachment &bearing, const Attachment &journal, int axis);
Constraint slide_constraint(const Attachment &bearing, const Attachment &journal, double direction);
Constraint align_constraint(const Attachment &bearing, const Attachment &journal, double angle);
Constraint turn_constraint(const Attachment &bearing, const Attachment &journal, int given); // align, prescribed
Constraint slope_constraint(const Attachment &bearing, const Attachment &journal, double angle, int axis);
Constraint place_constraint(const Attachment &point, int axis, int given);

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

// dPhi/d(r_2) of a slide or distance row.
Vec<double> by_journal(const Constraint &c, const Eigen::VectorXd &q);
// dPhi/d(rotation of d_2) of an align or slope row.
double by_rotation(const Constraint &c, const Eigen::VectorXd &q, double given);
// An angle satisfies Phi = 0 in two positions, half a turn apart: whether it is in the one half of the turn that is meant.
bool right_way_round(const Constraint &c, const Eigen::VectorXd &q, double given);

// The assembled mechanism: M a + f(t, q, v; z) + Phi_q^T lambda = 0, Phi(t, q) = 0 (eqs. 17, 18).
#pragma once

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <string>
#include <vector>

#include "bodies.hpp"
#include "constraint.hpp"
#include "contact.hpp"
#include "drive.hpp"
#include "function.hpp"
#include "load.hpp"
#include "loose_joint.hpp"
#include "spring.hpp"

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Joint {
    Attachment bearing, journal;
    ls_joint_kind kind = LS_REVOLUTE;
    int contact = -1;    // index of its law, -1 for an ideal joint
    int constraint = -1; // ideal joint: index of the first of its rows
    int holding = 0;     // first of the rows that hold rotation or slope, and their number
    int held = 0;
};

struct Gap {
    Vec<double> e, e_dot;
    double delta() const { return std::sqrt(dot(e, e)) - clearance; }
    double rate() const { return dot(e, e_dot) / std::sqrt(dot(e, e)); } // needs e != 0
    double clearance;
};

// All that depends on time alone.
struct Inputs {
    std::vector<Prescribed> cranks;    // one a leg
    std::vector<Prescribed> functions; // as in the description
};

struct Energies {
    double kinetic = 0.0, axial = 0.0, bending = 0.0, contact = 0.0, gravity = 0.0, springs = 0.0;
};

// Powers whose integrals are in the ledger of EQUATIONS.md.
struct Powers {
    double work = 0.0, contact_dissipated = 0.0, clamp = 0.0, friction_dissipated = 0.0, damping_dissipated = 0.0;
};

class System {
public:
    explicit System(const ls_mechanism &mechanism);

    int coordinates() const { return n_; }
    int constraints() const { return static_cast<int>(constraints_.size()); }
    int joints() const { return static_cast<int>(joints_.size()); }
    int legs() const { return static_cast<int>(legs_.size()); }
    int motions() const { return static_cast<int>(motions_.size()); }
    const std::vector<int> &loose_joints() const { return loose_; }
    const ContactLaw &law(int joint) const { return laws_[joints_[joint].contact]; }
    // What a constraint row belongs to.
    const std::string &row_name(int row) const { return row_names_[row]; }

    const MatrixXd &mass() const { return mass_; }
    const Eigen::SparseMatrix<double> &sparse_mass() const { return sparse_mass_; }
    // M^-1 on the coordinates that are not prescribed, zero on the others: block diagonal by bodies
    const Eigen::SparseMatrix<double> &inverse_mass() const { return inverse_mass_; }
    // Coordinates of moving bodies, each with the row that prescribes it. They have no mass.
    struct PrescribedCoordinate {
        int coordinate, row;
    };
    const std::vector<PrescribedCoordinate> &prescribed() const { return prescribed_; }
    // Length by which tolerances in m and m/s are divided for each coordinate (1 where it is a length itself).
    const VectorXd &levers() const { return levers_; }
    // Instants at which a function in use has a kink in some derivative, in order.
    const std::vector<double> &breaks() const { return breaks_; }

    std::vector<Prescribed> crank_angles(double t) const;
    std::vector<Prescribed> functions(double t) const;
    Inputs inputs(double t) const { return {crank_angles(t), functions(t)}; }
    void start(double t, VectorXd &q, VectorXd &v) const;

    void force(const std::vector<Prescribed> &functions, const VectorXd &q, const VectorXd &v, const VectorXd &z,
               VectorXd &f) const;
    // df/dq and df/dv; overwritten
    void force_derivatives(const std::vector<Prescribed> &functions, const VectorXd &q, const VectorXd &v,
                           const VectorXd &z, MatrixXd &by_q, MatrixXd &by_v) const;

    void constraint_rows(const Inputs &inputs, const VectorXd &q, VectorXd &phi, MatrixXd &phi_q, VectorXd &phi_t) const;
    // W = M^-1 Phi_q^T and S = Phi_q W, by the few coordinates each row depends on, with inverse_mass(). S has a one on the
    // diagonal for the rows of prescribed coordinates: they stand apart.
    void reduce_mass(const MatrixXd &phi_q, MatrixXd &w, MatrixXd &s) const;
    // gamma: d2Phi/dt2 = Phi_q a + gamma
    void convective(const Inputs &inputs, const VectorXd &q, const VectorXd &v, VectorXd &gamma) const;
    // Adds d(Phi_q^T lambda)/dq to the first, writes d(Phi_q v + Phi_t)/dq into the second.
    void constraint_derivatives(const Inputs &inputs, const VectorXd &q, const VectorXd &v, const VectorXd &lambda,
                                MatrixXd &stiffness, MatrixXd &rate_by_q) const;
    // Throws where an angle is half a turn from the one prescribed, which Phi does not see.
    void check_angles(const Inputs &inputs, const VectorXd &q, double t) const;

    Gap gap(int joint, const double *q, const double *v) const;
    LooseForces<double> loose(int joint, const VectorXd &q, const VectorXd &v, double z) const;

    Energies energies(const VectorXd &q, const VectorXd &v, const VectorXd &z) const;
    // Without the power of constraints that prescribe a motion, which is lambda . Phi_t.
    Powers powers(const std::vector<Prescribed> &functions, const VectorXd &q, const VectorXd &v, const VectorXd &z) const;
    bool prescribes_motion() const; // some row depends on time
    bool follows_functions() const { return !motions_.empty() || !prescribed_.empty() || !loads_.empty(); }
    bool has_power() const;         // powers() may differ from zero even if no contact is closed
    Vec<double> joint_force(int joint, const VectorXd &q, const VectorXd &v, const VectorXd &z,
                            const VectorXd &lambda) const;
    double joint_couple(int joint, const VectorXd &q, const VectorXd &lambda) const;
    double motion_force(int motion, const Inputs &inputs, const VectorXd &q, const VectorXd &lambda) const;
    double torque(int leg, const VectorXd &lambda) const { return -lambda[first_drive_ + leg]; }

private:
    void add_bodies(const ls_mechanism &mechanism);
    void add_joint(const ls_joint &joint, int number);
    void add_leg(const ls_leg &leg, int number, const ls_mechanism &mechanism);
    void add_springs(const ls_mechanism &mechanism);
    void add_load(const ls_load &load, int number);
    void add_constraints(const ls_mechanism &mechanism);
    void add_joint_rows(Joint &joint, const ls_joint &description, int number);
    void add_motion_row(const ls_motion &motion, int number);
    void add_row(const Constraint &row, const std::string &name);
    void complete_mass(double gravity_x, double gravity_y);
    void find_undriven();

    const Body &body(int index, const std::string &name) const;
    Attachment attachment(const ls_point &point, const std::string &name) const;
    Attachment directed_attachment(const ls_point &point, const std::string &name) const;
    int use_function(int index, const std::string &name);
    int use_smooth_function(int index, const std::string &name);
    const Joint &turning_joint(int index, const std::string &name) const;

    template <class Visit>
    void visit_pairs(const std::vector<Prescribed> &functions, const VectorXd &z, Visit visit) const;
    double given(const Constraint &c, const Inputs &inputs) const { return prescription(c, inputs).value; }
    Prescribed prescription(const Constraint &c, const Inputs &inputs) const;

    std::vector<Body> bodies_;
    std::vector<Joint> joints_;
    std::vector<ContactLaw> laws_;
    std::vector<Leg> legs_;
    std::vector<TimeFunction> functions_;
    std::vector<Spring> springs_;
    std::vector<TorsionSpring> torsion_springs_;
    std::vector<Load> loads_;
    std::vector<int> motions_; // their rows
    std::vector<Constraint> constraints_;
    std::vector<std::string> row_names_;
    std::vector<PrescribedCoordinate> prescribed_;
    std::vector<double> breaks_;
    std::vector<int> loose_;
    Path path_{};
    int n_ = 0, first_drive_ = 0;
    std::string undriven_; // why `start` is impossible; empty if it is possible
    MatrixXd mass_;
    Eigen::SparseMatrix<double> sparse_mass_, inverse_mass_;
    Eigen::SparseMatrix<double> mass_damping_; // alpha M of each body
    VectorXd weight_;                          // the force of gravity, M g
    VectorXd levers_;
};

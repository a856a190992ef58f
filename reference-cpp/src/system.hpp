// The assembled mechanism: M a + f(t, q, v; memory) + Phi_q^T lambda = 0, Phi(t, q) = 0 (eqs. 17, 18).
#pragma once

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <memory>
#include <string>
#include <vector>

#include "bodies.hpp"
#include "constraint.hpp"
#include "driven_angles.hpp"
#include "load.hpp"
#include "loose_guide.hpp"
#include "loose_joint.hpp"
#include "maxwell.hpp"
#include "scene.hpp"
#include "spring.hpp"

using Eigen::MatrixXd;
using Eigen::VectorXd;
using SparseMatrix = Eigen::SparseMatrix<double>;

struct Joint {
    std::string name;
    JointKind kind;
    Attachment bearing, journal;      // also of the guide and the slider, and of the two sides of a weld or rod
    std::optional<ContactLaw> law;    // with clearance
    std::array<int, 2> rows{-1, -1};  // that hold the points; prismatic, rod: the first. -1: none, or left out
    std::array<int, 2> holds{-1, -1}; // that hold rotation or slope
    int drive = -1;                   // that prescribes the angle
    double direction = 0.0;           // prismatic: of the line
    bool holds_angle = false, driven = false;
    int bristle = -1;                 // number of its internal state; -1: none
};

// A joint with clearance and its contact.
template <class T>
LooseForces<T> contact_forces(const Joint &j, double impact_velocity, const T &bristle, const T *qi, const T *vi,
                              const T *qj, const T *vj) {
    if (j.kind == JointKind::prismatic)
        return guide_forces(*j.law, impact_velocity, bristle, j.direction, j.bearing, j.journal, qi, vi, qj, vj);
    return loose_forces(*j.law, impact_velocity, bristle, j.bearing, j.journal, qi, vi, qj, vj);
}

struct Gap {
    Vec<double> e, e_dot; // of a loose guide the part across the guide
    double clearance;
    double size() const { return std::sqrt(dot(e, e)); }
    double delta() const { return size() - clearance; }
    // of the eccentricity; where it is zero, the speed at which it grows
    double rate() const { return size() > 0.0 ? dot(e, e_dot) / size() : std::sqrt(dot(e_dot, e_dot)); }
};

// All that depends on time alone.
struct Inputs {
    std::vector<Prescribed> given; // the functions of time in use, then the angles of the inverse kinematics
    double weight = 1.0;           // part of the weight that acts; differs from 1 only in a static analysis
    double weight_rate = 0.0;      // its rate
};

// What the forces remember.
struct Memory {
    VectorXd impact_velocity; // by joint: of eq. 24 while its contact is closed, else 0
    VectorXd turn;            // by torsion spring: an angle phi - phi_0 within half a turn of the present one
    // internal states: z of the bristles by joint that has them, 0 while its contact is open, then z by Maxwell element;
    // unknowns of the motion, unlike the others
    VectorXd state;
};

struct Energies {
    double kinetic = 0.0, axial = 0.0, bending = 0.0, contact = 0.0, gravity = 0.0, springs = 0.0;
    double total() const { return kinetic + axial + bending + contact + gravity + springs; }
};

// Powers whose integrals are in the ledger of EQUATIONS.md.
struct Powers {
    double work = 0.0, contact_dissipated = 0.0, clamp = 0.0, friction_dissipated = 0.0, normal_variation = 0.0,
           damping_dissipated = 0.0;
    void add(double weight, const Powers &p);
};

class System {
public:
    // Without driven angles a scene with inverse kinematics leaves its actuated joints free.
    explicit System(const Scene &scene, std::shared_ptr<const DrivenAngles> driven_angles = {});

    int coordinates() const { return n_; }
    int constraints() const { return static_cast<int>(constraints_.size()); }
    const std::vector<Body> &bodies() const { return bodies_; }
    const std::vector<Joint> &joints() const { return joints_; }
    const std::vector<Spring> &springs() const { return springs_; }
    const std::vector<TorsionSpring> &torsion_springs() const { return torsion_springs_; }
    const std::vector<Maxwell> &maxwells() const { return maxwells_; }
    // Internal states, each an unknown of the motion: bristles of joints, then elongations of Maxwell elements. A static
    // analysis has none.
    int states() const { return bristles_ + static_cast<int>(maxwells_.size()); }
    int bristles() const { return bristles_; }
    int elongation(int maxwell) const { return bristles_ + maxwell; } // number of its state
    std::string state_name(int state) const;
    const std::vector<Load> &loads() const { return loads_; }
    const std::vector<int> &loose_joints() const { return loose_; }
    const ContactLaw &law(int joint) const { return *joints_[joint].law; }
    const std::string &row_name(int row) const { return row_names_[row]; }
    const Source &row_source(int row) const { return row_sources_[row]; } // body, joint or drive it belongs to
    const std::string &coordinate_name(int i) const { return coordinate_names_[i]; }
    Attachment attachment(const PointReference &point) const { return make_attachment(bodies_[point.body], point.at); }
    // Removes constraint rows that repeat others; their multipliers count as zero.
    void leave_out(const std::vector<int> &rows);
    // Throws where a row that has been left out does not hold: then it does not repeat the others.
    void check_left_out(const Inputs &inputs, const VectorXd &q, double t) const;

    const SparseMatrix &mass() const { return mass_; }
    // M^-1 x on the coordinates that have a mass, zero on the others
    VectorXd divided_by_mass(const VectorXd &x) const;
    // Coordinates of moving bodies, each with the row that prescribes it. They have no mass.
    struct PrescribedCoordinate {
        int coordinate, row;
    };
    const std::vector<PrescribedCoordinate> &prescribed() const { return prescribed_; }
    // Length by which tolerances in m and m/s are divided for each coordinate (1 where it is a length itself).
    const VectorXd &levers() const { return levers_; }
    // The coordinate of largest magnitude in a motion; slopes follow the positions of their nodes and do not count.
    int moves_most(const VectorXd &motion) const;
    // Instants at which a function in use has a kink in some derivative, in order.
    const std::vector<double> &breaks() const { return breaks_; }

    Inputs inputs(double t) const;
    Memory memory() const; // at the start: all contacts open, turns of torsion springs and z of the scene
    // Makes torsion springs remember their angles at q, less than half a turn from those they remember.
    void count_turns(const VectorXd &q, Memory &memory) const;

    void force(const Inputs &inputs, const VectorXd &q, const VectorXd &v, const Memory &memory, VectorXd &f) const;
    // df/dq and df/dv, appended; entries of the same place add up
    void force_derivatives(const Inputs &inputs, const VectorXd &q, const VectorXd &v, const Memory &memory,
                           Entries &by_q, Entries &by_v) const;

    // df/dt of loads and weight, with the state held
    void load_rates(const Inputs &inputs, const VectorXd &q, VectorXd &rates) const;

    // The rates of the internal states, and all derivatives with them, appended. Bristles of an open contact rest.
    void state_rates(const VectorXd &q, const VectorXd &v, const Memory &memory, VectorXd &rates) const;
    void state_derivatives(const VectorXd &q, const VectorXd &v, const Memory &memory, StateDerivatives &out) const;

    void constraint_rows(const Inputs &inputs, const VectorXd &q, VectorXd &phi, MatrixXd &phi_q, VectorXd &phi_t) const;
    // The coordinates that a row depends on are the first `size` of `index`.
    const Constraint &constraint(int row) const { return constraints_[row]; }
    // W = M^-1 Phi_q^T and S = Phi_q W, by the few coordinates each row depends on, with M^-1 as above. S has a one on
    // the diagonal for the rows of prescribed coordinates: they stand apart.
    void reduce_mass(const MatrixXd &phi_q, MatrixXd &w, MatrixXd &s) const;
    // gamma: d2Phi/dt2 = Phi_q a + gamma
    void convective(const Inputs &inputs, const VectorXd &q, const VectorXd &v, VectorXd &gamma) const;
    // Appends d(Phi_q^T lambda)/dq to the first and d(Phi_q v + Phi_t)/dq to the second.
    void constraint_derivatives(const Inputs &inputs, const VectorXd &q, const VectorXd &v, const VectorXd &lambda,
                                Entries &stiffness, Entries &rate_by_q) const;
    // Throws where an angle is half a turn from the one prescribed, which Phi does not see.
    void check_angles(const Inputs &inputs, const VectorXd &q) const;

    Gap gap(int joint, const double *q, const double *v) const;
    LooseForces<double> loose(int joint, const VectorXd &q, const VectorXd &v, const Memory &memory) const;

    Energies energies(const VectorXd &q, const VectorXd &v, const Memory &memory) const;
    double bristle_energy(int joint, const VectorXd &q, const VectorXd &v, const Memory &memory) const; // F_n s_0 z^2 / 2
    double bristle_energy(const VectorXd &q, const VectorXd &v, const Memory &memory) const; // of all joints
    // Without the power of constraints that prescribe a motion, which is lambda . Phi_t. normal_variation is its part
    // -F_n s_0 z z' only: the rate of F_n s_0 z^2 / 2 is missing.
    Powers powers(const Inputs &inputs, const VectorXd &q, const VectorXd &v, const Memory &memory) const;
    bool prescribes_motion() const; // some row depends on time
    bool has_loads() const { return !loads_.empty(); }
    bool has_power() const; // powers() may differ from zero even if no contact is closed
    // Of the first side on the second.
    Vec<double> joint_force(int joint, const VectorXd &q, const VectorXd &v, const Memory &memory,
                            const VectorXd &lambda) const;
    double joint_couple(int joint, const Inputs &inputs, const VectorXd &q, const VectorXd &lambda) const;

private:
    void add_bodies(const Scene &scene);
    void add_joints(const Scene &scene);
    void add_forces(const Scene &scene);
    void add_constraints(const Scene &scene);
    void add_joint_rows(Joint &joint, const JointDescription &description);
    int add_row(const Constraint &row, const std::string &name, const Source &source);
    int add_function(const TimeFunction &function, bool grows = false);
    void complete_mass(const Scene &scene);

    template <class Visit>
    void visit_pairs(const Inputs &inputs, const Memory &memory, Visit visit) const;
    template <class Visit>
    void visit_states(const Memory &memory, Visit visit) const;
    double bristle(int joint, const Memory &memory) const; // its deflection, 0 without bristles
    Prescribed prescription(const Constraint &c, const Inputs &inputs) const;

    std::vector<Body> bodies_;
    std::vector<Joint> joints_;
    std::vector<TimeFunction> functions_;
    std::vector<bool> grows_; // by function: in proportion to t, in a static analysis
    std::shared_ptr<const DrivenAngles> driven_angles_;
    std::vector<Spring> springs_;
    std::vector<TorsionSpring> torsion_springs_;
    std::vector<Maxwell> maxwells_;
    std::vector<Load> loads_;
    std::vector<Constraint> constraints_;
    struct LeftOut {
        Constraint row;
        std::string name;
        Source source;
    };
    std::vector<LeftOut> left_out_;
    std::vector<std::string> row_names_, coordinate_names_;
    std::vector<Source> row_sources_;
    std::vector<PrescribedCoordinate> prescribed_;
    std::vector<double> breaks_;
    std::vector<int> loose_;
    int n_ = 0, bristles_ = 0;
    double full_load_ = 0.0; // static analysis: t of the full load
    SparseMatrix mass_, mass_damping_; // mass_damping_: alpha M of each body
    // of M with ones for the coordinates without mass; a copy of the system shares it
    std::shared_ptr<const Eigen::SimplicialLDLT<SparseMatrix>> mass_factor_;
    VectorXd has_mass_;        // by coordinate, 1 or 0
    SparseMatrix inverse_mass_; // its columns of the coordinates that constraints depend on
    VectorXd weight_;          // the force of gravity, M g
    VectorXd levers_;
    VectorXd elongation_;      // of the Maxwell elements at t = 0
};

// The assembled mechanism: M a + f(q, v; z) + Phi_q^T lambda = 0, Phi(t, q) = 0 (eqs. 17, 18).
#pragma once

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <string>
#include <vector>

#include "bodies.hpp"
#include "constraint.hpp"
#include "contact.hpp"
#include "drive.hpp"
#include "loose_joint.hpp"

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Joint {
    Attachment bearing, journal;
    int contact = -1;    // index of its law, -1 for an ideal joint
    int constraint = -1; // ideal joint: index of the first of its two rows
};

struct Gap {
    Vec<double> e, e_dot;
    double delta() const { return std::sqrt(dot(e, e)) - clearance; }
    double rate() const { return dot(e, e_dot) / std::sqrt(dot(e, e)); } // needs e != 0
    double clearance;
};

struct Energies {
    double kinetic = 0.0, axial = 0.0, bending = 0.0, contact = 0.0;
};

// Powers whose integrals are in the ledger of EQUATIONS.md.
struct Powers {
    double drive = 0.0, contact_dissipated = 0.0, clamp = 0.0, friction_dissipated = 0.0;
};

class System {
public:
    explicit System(const ls_mechanism &mechanism);

    int coordinates() const { return n_; }
    int constraints() const { return static_cast<int>(constraints_.size()); }
    int joints() const { return static_cast<int>(joints_.size()); }
    int legs() const { return static_cast<int>(legs_.size()); }
    const std::vector<int> &loose_joints() const { return loose_; }
    const ContactLaw &law(int joint) const { return laws_[joints_[joint].contact]; }

    const MatrixXd &mass() const { return mass_; }
    const Eigen::SparseMatrix<double> &sparse_mass() const { return sparse_mass_; }
    // M^-1: block diagonal by bodies
    const Eigen::SparseMatrix<double> &inverse_mass() const { return inverse_mass_; }
    // Length by which tolerances in m and m/s are divided for each coordinate (1 where it is a length itself).
    const VectorXd &levers() const { return levers_; }

    std::vector<CrankAngle> crank_angles(double t) const;
    void start(double t, VectorXd &q, VectorXd &v) const;

    void force(const VectorXd &q, const VectorXd &v, const VectorXd &z, VectorXd &f) const;
    // df/dq and df/dv; overwritten
    void force_derivatives(const VectorXd &q, const VectorXd &v, const VectorXd &z, MatrixXd &by_q, MatrixXd &by_v) const;

    void constraint_rows(const std::vector<CrankAngle> &cranks, const VectorXd &q, VectorXd &phi, MatrixXd &phi_q,
                         VectorXd &phi_t) const;
    // W = M^-1 Phi_q^T and S = Phi_q W, by the few coordinates each row depends on
    void reduce_mass(const MatrixXd &phi_q, MatrixXd &w, MatrixXd &s) const;
    // gamma: d2Phi/dt2 = Phi_q a + gamma
    void convective(const std::vector<CrankAngle> &cranks, const VectorXd &q, const VectorXd &v, VectorXd &gamma) const;
    // Adds d(Phi_q^T lambda)/dq to the first, writes d(Phi_q v + Phi_t)/dq into the second.
    void constraint_derivatives(const std::vector<CrankAngle> &cranks, const VectorXd &q, const VectorXd &v,
                                const VectorXd &lambda, MatrixXd &stiffness, MatrixXd &rate_by_q) const;

    Gap gap(int joint, const double *q, const double *v) const;
    LooseForces<double> loose(int joint, const VectorXd &q, const VectorXd &v, double z) const;

    Energies energies(const VectorXd &q, const VectorXd &v, const VectorXd &z) const;
    // lambda: consistent multipliers at (t, q, v)
    Powers powers(const std::vector<CrankAngle> &cranks, const VectorXd &q, const VectorXd &v, const VectorXd &z,
                  const VectorXd &lambda) const;
    Vec<double> joint_force(int joint, const VectorXd &q, const VectorXd &v, const VectorXd &z,
                            const VectorXd &lambda) const;
    double torque(int leg, const VectorXd &lambda) const { return -lambda[first_drive_ + leg]; }

private:
    void add_joint(const ls_joint &joint, int number, const ls_mechanism &mechanism);
    void add_leg(const ls_leg &leg, int number, const ls_mechanism &mechanism);
    void add_constraints();
    void complete_mass();

    std::vector<Body> bodies_;
    std::vector<Joint> joints_;
    std::vector<ContactLaw> laws_;
    std::vector<Leg> legs_;
    std::vector<Constraint> constraints_;
    std::vector<int> loose_;
    Path path_{};
    int n_ = 0, first_drive_ = 0;
    std::string undriven_; // why `start` is impossible; empty if it is possible
    MatrixXd mass_;
    Eigen::SparseMatrix<double> sparse_mass_, inverse_mass_;
    VectorXd levers_;
};

// The acceleration-level equations M a + f + Phi_q^T lambda = 0, Phi_q a + gamma = 0 at given (t, q, v), by elimination
// of a: (Phi_q M^-1 Phi_q^T) lambda = gamma - Phi_q M^-1 f. Also the projections on the constraints, which have the
// same matrix. Keeps its work arrays.
class Acceleration {
public:
    explicit Acceleration(const System &system);

    // refine: one step of iterative refinement
    void solve(double t, const VectorXd &q, const VectorXd &v, const VectorXd &z, bool refine);
    // Moves q to Phi = 0 and v to Phi_q v + Phi_t = 0 along M^-1 Phi_q^T; refuses larger violations than `limit`.
    void project(double t, VectorXd &q, VectorXd &v, double limit);

    VectorXd a, lambda;
    std::vector<CrankAngle> cranks;

private:
    void linearise(double t, const VectorXd &q);

    const System &system_;
    VectorXd f_, phi_, phi_t_, gamma_;
    MatrixXd phi_q_, w_, s_; // Phi_q, M^-1 Phi_q^T, Phi_q M^-1 Phi_q^T
    Eigen::LDLT<MatrixXd> factor_;
};

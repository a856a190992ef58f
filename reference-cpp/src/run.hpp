// Integration in time by IDA, with located onsets and losses of contact.
#pragma once

#include <optional>

#include "acceleration.hpp"
#include "channels.hpp"
#include "failure.hpp"
#include "newton.hpp"
#include "sundials.hpp"

// Integrals of System::powers.
using Ledger = Powers;

class Run {
public:
    // memory: the impact velocities of closed contacts and the internal states at t
    Run(const Model &model, double t, const VectorXd &q, const VectorXd &v, const Memory &memory,
        const ls_tolerances &tolerances);
    Run(const Run &) = delete;
    Run &operator=(const Run &) = delete;

    void advance(double t);
    const Snapshot &snapshot() const { return snapshot_; } // where `advance` has come to
    const Channels &channels() const { return channels_; }
    const std::vector<ls_event> &events() const { return events_; }
    ls_statistics statistics() const;

private:
    // what the events of one loose joint are decided by, at one instant
    struct Watch {
        double gap = 0.0;  // (|e|^2 - c^2) / (2 c): differentiable at e = 0, and delta near contact
        double rate = 0.0; // its rate
    };

    // callbacks of IDA
    static int residual(double t, N_Vector y, N_Vector yp, N_Vector r, void *run);
    static int jacobian(double t, double c, N_Vector y, N_Vector yp, N_Vector r, SUNMatrix, void *run, N_Vector,
                        N_Vector, N_Vector);
    static int roots(double t, N_Vector y, N_Vector yp, double *g, void *run);
    static int weights(N_Vector y, N_Vector w, void *run);
    static int solve_linear(SUNLinearSolver solver, SUNMatrix, N_Vector x, N_Vector b, double);
    template <class Work>
    int guarded(Work work);

    void check(int flag);
    void set_up(const ls_tolerances &tolerances);
    void set_up_dense();
    void set_up_sparse();
    void fill_sparse(const SparseMatrix &matrix);
    const Inputs &inputs(double t);

    void step();
    void restart();
    double first_step();
    void apply_pending_events();
    void stop_at_next_break();

    void find_events(const int *flagged);
    double crossing(int joint, const Watch &then, bool flagged);
    template <class Function>
    double bisect(double from, double to, Function f, int joint);
    Watch watch(int joint, const double *y) const;
    Watch interpolated(int joint, double t);
    bool closed(int joint) const { return memory_.impact_velocity[joint] > 0.0; }
    void watch_clamps();
    void watch_depth();

    int unknowns() const { return 2 * (n_ + m_) + x_; } // q, v, lambda, mu, x
    const Memory &memory_at(const double *y);           // memory_ with the internal states of y
    bool bristles_touch() const;                        // some contact with bristles is closed
    void state_at(double t, VectorXd &q, VectorXd &v, Memory &memory);
    Ledger integral(double to);
    std::vector<double> kinks(double to);
    void describe(double t);
    void collect_statistics();

    Model model_;
    const System &system_;
    Channels channels_;
    ls_tolerances tolerances_;
    int n_, m_, x_; // numbers of coordinates, constraints, internal states

    // the last interval IDA has covered without a restart inside; t_ is reached, a restart may be pending there
    double before_, t_;
    double target_;                   // the time asked for
    VectorXd q_, v_;
    Memory memory_;                   // its internal states: at t_
    Memory memory_at_;                // of memory_at
    Angles angles_;                   // at t_
    double initial_energy_;
    Ledger ledger_before_, ledger_;
    double bristle_energy_before_ = 0.0;
    std::vector<Watch> watch_before_; // by loose joint, at before_
    std::vector<char> clamped_;       // by loose joint
    std::vector<double> deepest_;     // by loose joint: largest penetration since the onset
    std::vector<int> pending_;        // joints whose contact closes or opens at t_
    bool restart_pending_ = true;
    std::vector<ls_event> events_;
    ls_statistics statistics_{};

    Acceleration acceleration_;
    DenseNewton newton_;
    std::optional<Failure> failure_;  // in a callback
    double inputs_time_;
    Inputs inputs_;
    VectorXd qs_, vs_, f_, phi_, phi_t_; // work arrays
    MatrixXd phi_q_;

    Snapshot snapshot_;

    // released from the last to the first: IDA before what it uses
    ida::ErrorText errors_;
    ida::Context context_;
    ida::Vector y_, yp_, scratch_;
    ida::Matrix matrix_;
    ida::LinearSolver solver_;
    ida::Integrator ida_;
};

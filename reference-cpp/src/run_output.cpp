// States between steps, integrals of power, statistics.
#include <algorithm>
#include <cmath>

#include "gauss.hpp"
#include "run_vectors.hpp"

// Inside the last interval from IDA's interpolant, at its end as returned.
void Run::state_at(double t, VectorXd &q, VectorXd &v, Memory &memory) {
    if (t == t_) {
        q = q_;
        v = v_;
        memory = memory_;
        return;
    }
    check(IDAGetDky(ida_, t, 0, scratch_.get()));
    q = part(static_cast<const double *>(data(scratch_)), 0, n_);
    v = part(static_cast<const double *>(data(scratch_)), n_, n_);
    memory = memory_at(data(scratch_));
}

// Gauss quadrature of the powers over the last interval up to `to`, piecewise between the kinks of the contact law. The
// rule matches the order of the interpolant. Where functions of time are prescribed IDA may take long steps, exact for
// polynomials of its order, and powers have twice their degree, those of bristles more.
Ledger Run::integral(double to) {
    double from = before_;
    Ledger sum;
    if (!(to > from) || (!system_.has_power() && (memory_.impact_velocity.array() <= 0.0).all())) return sum;
    int order = 0;
    check(IDAGetLastOrder(ida_, &order));
    const bool bristles = bristles_touch();
    std::vector<double> ends = kinks(to);
    ends.push_back(to);
    for (double end : ends) {
        auto add_point = [&](const GaussPoint &g) {
            const double t = from + g.x * (end - from);
            check(IDAGetDky(ida_, t, 0, scratch_.get()));
            qs_ = part(static_cast<const double *>(data(scratch_)), 0, n_);
            vs_ = part(static_cast<const double *>(data(scratch_)), n_, n_);
            const double weight = g.weight * (end - from);
            const Memory &memory = memory_at(data(scratch_));
            sum.add(weight, system_.powers(inputs(t), qs_, vs_, memory));
            if (!system_.prescribes_motion()) return;
            acceleration_.solve(t, qs_, vs_, memory, false);
            sum.work += weight * acceleration_.prescribed_power();
        };
        if (system_.prescribes_motion() || system_.has_loads() || bristles)
            std::for_each(gauss5.begin(), gauss5.end(), add_point);
        else if (order <= 3)
            std::for_each(gauss2.begin(), gauss2.end(), add_point);
        else
            std::for_each(gauss3.begin(), gauss3.end(), add_point);
        from = end;
    }
    // by parts, since F_n' would need accelerations: those of a stiff contact are noise between two steps
    if (bristles) {
        Memory memory;
        state_at(to, qs_, vs_, memory);
        sum.normal_variation += system_.bristle_energy(qs_, vs_, memory) - bristle_energy_before_;
    }
    return sum;
}

void Run::advance(double t) {
    require(std::isfinite(t), "the time to advance to is not finite");
    require(t >= before_, "time must not run backwards");
    target_ = t;
    std::int64_t steps = 0;
    while (t_ < t) {
        if (steps++ >= tolerances_.max_steps)
            throw Failure(LS_IDA, "the limit `max_steps` is reached before the requested time", t_, IDA_TOO_MUCH_WORK);
        step();
    }
    describe(t);
}

void Run::describe(double t) {
    Snapshot &s = snapshot_;
    s.t = t;
    state_at(t, s.q, s.v, s.memory);
    s.ledger = t == t_ ? ledger_ : ledger_before_;
    if (t != t_) s.ledger.add(1.0, integral(t));
    acceleration_.solve(t, s.q, s.v, s.memory, true);
    if (!acceleration_.a.allFinite() || !acceleration_.lambda.allFinite())
        throw Failure(LS_NOT_FINITE, "the acceleration is not finite", t);
    s.a = acceleration_.a;
    s.lambda = acceleration_.lambda;
    s.inputs = acceleration_.inputs;
    system_.check_left_out(s.inputs, s.q, t);
    s.angles = continued(system_, angles_, s.q);
    s.initial_energy = initial_energy_;
}

// IDA's counters start anew with every restart.
void Run::collect_statistics() { statistics_ = statistics(); }

ls_statistics Run::statistics() const {
    long steps = 0, residuals = 0, jacobians = 0, error_failures = 0, convergence_failures = 0;
    IDAGetNumSteps(ida_, &steps);
    IDAGetNumResEvals(ida_, &residuals);
    IDAGetNumJacEvals(ida_, &jacobians);
    IDAGetNumErrTestFails(ida_, &error_failures);
    IDAGetNumNonlinSolvConvFails(ida_, &convergence_failures);
    ls_statistics s = statistics_;
    s.steps += steps;
    s.residuals += residuals;
    s.jacobians += jacobians;
    s.error_failures += error_failures;
    s.convergence_failures += convergence_failures;
    return s;
}

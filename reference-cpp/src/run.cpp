#include "run.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "gauss.hpp"

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Newton's method stops at this fraction of the error tolerance. Tighter than IDA's 0.33: the drift of energy counts.
constexpr double newton_fraction = 0.05;
// Constraints make Newton's method slow with the matrix of another step length; IDA would tolerate more.
constexpr double refresh_threshold = 0.1;
// The predicted error of the first step after a restart, in units of the tolerance.
constexpr double first_step_error = 0.25;

double *data(const ida::Vector &v) { return N_VGetArrayPointer(v.get()); }

Eigen::Map<const VectorXd> part(const double *y, int offset, int size) { return {y + offset, size}; }
Eigen::Map<VectorXd> part(double *y, int offset, int size) { return {y + offset, size}; }

void add(Ledger &sum, double weight, const Powers &p) {
    sum.work += weight * p.work;
    sum.contact_dissipated += weight * p.contact_dissipated;
    sum.clamp += weight * p.clamp;
    sum.friction_dissipated += weight * p.friction_dissipated;
    sum.damping_dissipated += weight * p.damping_dissipated;
}

SUNLinearSolver_Type solver_type(SUNLinearSolver) { return SUNLINEARSOLVER_DIRECT; }
SUNLinearSolver_ID solver_id(SUNLinearSolver) { return SUNLINEARSOLVER_CUSTOM; }
int solver_ready(SUNLinearSolver) { return 0; }
int solver_set_up(SUNLinearSolver, SUNMatrix) { return 0; } // the matrix arrives factorised from `jacobian`
SUNMatrix_ID matrix_id(SUNMatrix) { return SUNMATRIX_CUSTOM; }
int matrix_zero(SUNMatrix) { return 0; }

template <class Handle>
Handle allocated(Handle handle) {
    if (!handle) throw std::bad_alloc();
    return handle;
}

} // namespace

Run::Run(const System &system, double t, const VectorXd &q, const VectorXd &v, const ls_tolerances &tolerances)
    : system_(system), tolerances_(tolerances), n_(system.coordinates()), m_(system.constraints()), before_(t), t_(t),
      target_(t), q_(q), v_(v), z_(VectorXd::Zero(system.joints())), watch_before_(system.loose_joints().size()),
      clamped_(system.loose_joints().size(), 0), deepest_(system.loose_joints().size(), 0.0),
      acceleration_(system_), newton_(system_),
      inputs_time_(std::numeric_limits<double>::quiet_NaN()), context_(&errors_),
      y_(allocated(N_VNew_Serial(2 * (n_ + m_), context_))), yp_(allocated(N_VClone(y_.get()))),
      scratch_(allocated(N_VClone(y_.get()))), matrix_(allocated(SUNMatNewEmpty(context_))),
      solver_(allocated(SUNLinSolNewEmpty(context_))), ida_(context_) {
    constexpr double consistent = 1e-6;
    if (!q.allFinite() || !v.allFinite()) throw Failure(LS_NOT_FINITE, "the initial state is not finite", t);
    VectorXd q0 = q, v0 = v;
    acceleration_.project(t, q0, v0, consistent);
    system_.check_angles(acceleration_.inputs, q0, t);
    set_up(tolerances);
}

void Run::set_up(const ls_tolerances &tol) {
    require(std::isfinite(tol.relative) && tol.relative >= 0.0, "tolerances: relative must not be negative");
    require(std::isfinite(tol.position) && tol.position > 0.0, "tolerances: position must be positive");
    require(std::isfinite(tol.velocity) && tol.velocity > 0.0, "tolerances: velocity must be positive");
    require(std::isfinite(tol.max_step) && tol.max_step >= 0.0, "tolerances: max_step must not be negative");
    require(tol.max_order >= 1 && tol.max_order <= 5, "tolerances: max_order must be 1 to 5");
    require(tol.max_steps > 0, "tolerances: max_steps must be positive");

    matrix_->ops->getid = matrix_id;
    matrix_->ops->zero = matrix_zero;
    solver_->ops->gettype = solver_type;
    solver_->ops->getid = solver_id;
    solver_->ops->initialize = solver_ready;
    solver_->ops->setup = solver_set_up;
    solver_->ops->solve = solve_linear;
    solver_->content = this;

    N_VConst(0.0, y_.get());
    N_VConst(0.0, yp_.get());
    check(ida::route_errors(ida_, &errors_));
    check(IDAInit(ida_, residual, t_, y_.get(), yp_.get()));
    check(IDASetUserData(ida_, this));
    check(IDAWFtolerances(ida_, weights));
    check(IDASetLinearSolver(ida_, solver_.get(), matrix_.get()));
    check(IDASetJacFn(ida_, jacobian));
    check(IDASetMaxOrd(ida_, tol.max_order));
    if (tol.max_step > 0.0) check(IDASetMaxStep(ida_, tol.max_step));
    check(IDASetNonlinConvCoef(ida_, newton_fraction));
    check(ida::set_refresh_threshold(ida_, refresh_threshold));
    if (!system_.loose_joints().empty()) {
        check(IDARootInit(ida_, static_cast<int>(system_.loose_joints().size()), roots));
        check(IDASetNoInactiveRootWarn(ida_));
    }
}

// Throws for a failure of IDA, preferring what went wrong in a callback to IDA's report that a callback failed.
void Run::check(int flag) {
    if (flag >= 0) return;
    if (failure_) throw *failure_;
    const std::unique_ptr<char, decltype(&std::free)> name(IDAGetReturnFlagName(flag), &std::free);
    throw Failure(LS_IDA, errors_.text.empty() ? name.get() : errors_.text, t_, flag);
}

// ---- callbacks --------------------------------------------------------------------------------------------------

// No exception may pass through IDA. Positive: IDA tries a smaller step; negative: it gives up.
template <class Work>
int Run::guarded(Work work) {
    try {
        work();
        return 0;
    } catch (const Failure &e) {
        failure_ = e;
        // IDA steps past the time asked for: out of reach there, a smaller step may still do
        const bool beyond = e.code == LS_UNREACHABLE && e.time > target_;
        return e.code == LS_NOT_FINITE || beyond ? 1 : -1;
    } catch (const std::exception &e) {
        failure_ = Failure(LS_INTERNAL, e.what(), t_);
        return -1;
    }
}

const Inputs &Run::inputs(double t) {
    if (t != inputs_time_) {
        inputs_ = system_.inputs(t);
        inputs_time_ = t;
    }
    return inputs_;
}

int Run::residual(double t, N_Vector yy, N_Vector yyp, N_Vector rr, void *user) {
    Run &run = *static_cast<Run *>(user);
    return run.guarded([&] {
        const int n = run.n_, m = run.m_;
        const double *y = N_VGetArrayPointer(yy), *yp = N_VGetArrayPointer(yyp);
        double *r = N_VGetArrayPointer(rr);
        run.qs_ = part(y, 0, n);
        run.vs_ = part(y, n, n);
        const auto lambda = part(y, 2 * n, m), mu = part(y, 2 * n + m, m);
        const System &s = run.system_;
        const Inputs &inputs = run.inputs(t);
        s.constraint_rows(inputs, run.qs_, run.phi_, run.phi_q_, run.phi_t_);
        s.force(inputs.functions, run.qs_, run.vs_, run.z_, run.f_);
        auto r1 = part(r, 0, n), r2 = part(r, n, n);
        r1.noalias() = s.sparse_mass() * (part(yp, 0, n) - run.vs_);
        r1.noalias() += run.phi_q_.transpose() * mu;
        r2.noalias() = s.sparse_mass() * part(yp, n, n);
        r2 += run.f_;
        r2.noalias() += run.phi_q_.transpose() * lambda;
        part(r, 2 * n, m) = run.phi_;
        part(r, 2 * n + m, m) = run.phi_t_ + run.phi_q_ * run.vs_;
        if (!part(r, 0, 2 * (n + m)).allFinite())
            throw Failure(LS_NOT_FINITE, "the residual of the equations of motion is not finite", t);
    });
}

int Run::jacobian(double t, double c, N_Vector yy, N_Vector, N_Vector, SUNMatrix, void *user, N_Vector, N_Vector,
                  N_Vector) {
    Run &run = *static_cast<Run *>(user);
    return run.guarded([&] {
        const double *y = N_VGetArrayPointer(yy);
        run.newton_.assemble(c, run.inputs(t), part(y, 0, run.n_), part(y, run.n_, run.n_), run.z_,
                             part(y, 2 * run.n_, run.m_));
    });
}

int Run::solve_linear(SUNLinearSolver solver, SUNMatrix, N_Vector x, N_Vector b, double) {
    Run &run = *static_cast<Run *>(solver->content);
    return run.guarded([&] {
        const int size = 2 * (run.n_ + run.m_);
        run.newton_.solve(part(static_cast<const double *>(N_VGetArrayPointer(b)), 0, size),
                          part(N_VGetArrayPointer(x), 0, size));
    });
}

// Multipliers have no weight: neither the error test nor Newton's convergence test looks at them.
int Run::weights(N_Vector yy, N_Vector ww, void *user) {
    const Run &run = *static_cast<Run *>(user);
    const double *y = N_VGetArrayPointer(yy);
    double *w = N_VGetArrayPointer(ww);
    const VectorXd &levers = run.system_.levers();
    const ls_tolerances &tol = run.tolerances_;
    for (int i = 0; i < run.n_; ++i) {
        w[i] = 1.0 / (tol.relative * std::abs(y[i]) + tol.position / levers[i]);
        w[run.n_ + i] = 1.0 / (tol.relative * std::abs(y[run.n_ + i]) + tol.velocity / levers[i]);
    }
    std::fill(w + 2 * run.n_, w + 2 * (run.n_ + run.m_), 0.0);
    return 0;
}

// The gap of each loose joint: contact closes and opens where it vanishes.
int Run::roots(double, N_Vector yy, N_Vector, double *g, void *user) {
    const Run &run = *static_cast<Run *>(user);
    const double *y = N_VGetArrayPointer(yy);
    for (int k : run.system_.loose_joints()) *g++ = run.watch(k, y).gap;
    return 0;
}

Run::Watch Run::watch(int joint, const double *y) const {
    const Gap g = system_.gap(joint, y, y + n_);
    const double c = g.clearance;
    return {(dot(g.e, g.e) - c * c) / (2.0 * c), dot(g.e, g.e_dot) / c};
}

// ---- steps ------------------------------------------------------------------------------------------------------

void Run::step() {
    if (restart_pending_) restart();
    // Where the path leaves the reach of a leg the rate of its crank grows like 1 / sqrt: IDA would creep up to it with
    // ever smaller steps. Looking ahead ends that.
    constexpr double glance = 1e-6;
    if (t_ + glance <= target_) system_.crank_angles(t_ + glance);
    before_ = t_;
    ledger_before_ = ledger_;
    const double *y = data(y_);
    const std::vector<int> &loose = system_.loose_joints();
    for (std::size_t i = 0; i < loose.size(); ++i) watch_before_[i] = watch(loose[i], y);

    failure_.reset();
    const int flag = IDASolve(ida_, t_ + 1.0, &t_, y_.get(), yp_.get(), IDA_ONE_STEP);
    check(flag);
    if (!loose.empty()) {
        std::vector<int> flagged(loose.size(), 0);
        if (flag == IDA_ROOT_RETURN) check(IDAGetRootInfo(ida_, flagged.data()));
        find_events(flagged.data());
    }
    if (flag == IDA_TSTOP_RETURN) restart_pending_ = true;
    q_ = part(y, 0, n_);
    v_ = part(y, n_, n_);
    add(ledger_, 1.0, integral(t_));
    watch_clamps();
    watch_depth();
}

// Continues from (t_, q_, v_) with consistent derivatives; multipliers from the acceleration level.
void Run::restart() {
    apply_pending_events();
    acceleration_.project(t_, q_, v_, infinity);
    acceleration_.solve(t_, q_, v_, z_, true);
    double *y = data(y_), *yp = data(yp_);
    N_VConst(0.0, y_.get());
    N_VConst(0.0, yp_.get());
    part(y, 0, n_) = q_;
    part(y, n_, n_) = v_;
    part(y, 2 * n_, m_) = acceleration_.lambda;
    part(yp, 0, n_) = v_;
    part(yp, n_, n_) = acceleration_.a;
    collect_statistics();
    ++statistics_.restarts;
    check(IDAReInit(ida_, t_, y_.get(), yp_.get()));
    check(IDASetInitStep(ida_, first_step()));
    std::vector<int> direction;
    for (int k : system_.loose_joints()) direction.push_back(closed(k) ? -1 : 1);
    if (!direction.empty()) check(IDASetRootDirection(ida_, direction.data()));
    stop_at_next_break();
    restart_pending_ = false;
}

// The history that a high order rests on must not reach across a kink of a function.
void Run::stop_at_next_break() {
    const std::vector<double> &breaks = system_.breaks();
    const double rounding = 1e-14 * std::max(1.0, std::abs(t_)); // IDA cannot stop nearer than that
    const auto next = std::upper_bound(breaks.begin(), breaks.end(), t_ + rounding);
    if (next != breaks.end()) check(IDASetStopTime(ida_, *next));
}

// IDA starts at order 1: its error is h^2/2 y''. For q that is the acceleration; the change of the acceleration over
// a trial step stands for v''. It catches the contact force, F ~ t^1.5 after an onset.
double Run::first_step() {
    const VectorXd a = acceleration_.a;
    if (weights(y_.get(), scratch_.get(), this) != 0) return 0.0;
    const auto w = part(static_cast<const double *>(data(scratch_)), 0, 2 * n_);
    const double scale = std::sqrt(1.0 / (2.0 * (n_ + m_)));
    auto norm = [&](const VectorXd &x, int offset) { return scale * x.cwiseProduct(w.segment(offset, n_)).norm(); };

    constexpr double longest = 1e-3;
    const double limit = tolerances_.max_step > 0.0 ? std::min(longest, tolerances_.max_step) : longest;
    const double shortest = 1e3 * std::numeric_limits<double>::epsilon() * std::max(1e-3, std::abs(t_));
    double h = std::min(limit, std::sqrt(2.0 * first_step_error / std::max(norm(a, 0), 1e-300)));
    for (int trial = 0; trial < 12 && h > shortest; ++trial) {
        acceleration_.solve(t_ + h, q_ + h * v_ + 0.5 * h * h * a, v_ + h * a, z_, false);
        const double error = 0.5 * h * norm(acceleration_.a - a, n_);
        if (error <= first_step_error) break;
        h *= std::max(0.05, 0.8 * std::sqrt(first_step_error / error));
    }
    return std::max(h, shortest);
}

void Run::apply_pending_events() {
    const std::vector<int> &loose = system_.loose_joints();
    for (int k : pending_) {
        const auto i = std::find(loose.begin(), loose.end(), k) - loose.begin();
        const Gap g = system_.gap(k, q_.data(), v_.data());
        const double speed = g.rate();
        const bool onset = !closed(k);
        events_.push_back({t_, speed, g.e.x, g.e.y, onset ? 0.0 : deepest_[i], k, onset ? 1 : 0});
        z_[k] = onset ? std::max(speed, system_.law(k).impact_velocity_floor) : 0.0;
        clamped_[i] = 0;
        deepest_[i] = 0.0;
    }
    pending_.clear();
}

// ---- contact ----------------------------------------------------------------------------------------------------

// Decides at the end of the interval which contacts close or open; may shorten the interval.
void Run::find_events(const int *flagged) {
    const std::vector<int> &loose = system_.loose_joints();
    double earliest = t_;
    for (std::size_t i = 0; i < loose.size(); ++i) {
        const double event = crossing(loose[i], watch_before_[i], flagged[i] != 0);
        if (event < earliest) {
            earliest = event;
            pending_.clear();
        }
        if (event <= earliest) pending_.push_back(loose[i]);
    }
    if (earliest < t_) {
        check(IDAGetDky(ida_, earliest, 0, y_.get()));
        t_ = earliest;
    }
    restart_pending_ = !pending_.empty();
}

// The first instant in the last interval at which f = s gap rises through zero, s = 1 for an open contact, -1 for a
// closed one; infinity if there is none. IDA compares the signs of f at the two ends of a step. That is not all: f can
// rise above zero and fall again inside one step, so its maximum is looked at; and where the interval starts with a
// restart f is zero up to rounding, and its sign there says nothing.
double Run::crossing(int joint, const Watch &then, bool flagged) {
    const double s = closed(joint) ? -1.0 : 1.0;
    const Watch now = watch(joint, data(y_));
    auto f = [s](const Watch &w) { return s * w.gap; };
    auto rate = [s](const Watch &w) { return s * w.rate; };
    const bool has_maximum = rate(then) > 0.0 && rate(now) < 0.0;
    const double reach = f(then) + 2.0 * rate(then) * (t_ - before_); // twice what the first slope could bring it up
    if (has_maximum && f(then) < 0.0 && reach > 0.0) {
        const double top = bisect(before_, t_, [&](const Watch &w) { return -rate(w); }, joint);
        if (f(interpolated(joint, top)) > 0.0) return bisect(before_, top, f, joint);
    }
    if (flagged) return t_;
    if (!(f(now) > 0.0)) return infinity;
    if (f(then) < 0.0) return bisect(before_, t_, f, joint);
    if (rate(then) < 0.0) { // f fell from zero first
        const double bottom = bisect(before_, t_, rate, joint);
        if (rate(now) > 0.0) return f(interpolated(joint, bottom)) < 0.0 ? bisect(bottom, t_, f, joint) : bottom;
        return infinity; // on its way back over zero
    }
    return before_; // it grew from zero
}

Run::Watch Run::interpolated(int joint, double t) {
    check(IDAGetDky(ida_, t, 0, scratch_.get()));
    return watch(joint, data(scratch_));
}

// The zero of f between f(from) < 0 and f(to) > 0, to the last bit of t.
template <class Function>
double Run::bisect(double from, double to, Function f, int joint) {
    for (;;) {
        const double middle = 0.5 * (from + to);
        if (!(middle > from && middle < to)) return to;
        (f(interpolated(joint, middle)) > 0.0 ? to : from) = middle;
    }
}

void Run::watch_clamps() {
    const std::vector<int> &loose = system_.loose_joints();
    for (std::size_t i = 0; i < loose.size(); ++i) {
        const bool now = closed(loose[i]) && system_.loose(loose[i], q_, v_, z_[loose[i]]).clamped;
        if (now && !clamped_[i]) ++statistics_.clamps;
        clamped_[i] = now;
    }
}

// The penetration of a closed contact is largest at an end of an interval or where its rate falls through zero inside.
void Run::watch_depth() {
    const std::vector<int> &loose = system_.loose_joints();
    for (std::size_t i = 0; i < loose.size(); ++i) {
        const int k = loose[i];
        if (!closed(k)) continue;
        deepest_[i] = std::max(deepest_[i], system_.gap(k, q_.data(), v_.data()).delta());
        if (!(watch_before_[i].rate > 0.0 && system_.gap(k, q_.data(), v_.data()).rate() < 0.0)) continue;
        const double top = bisect(before_, t_, [](const Watch &w) { return -w.rate; }, k);
        interpolated(k, top);
        deepest_[i] = std::max(deepest_[i], system_.gap(k, data(scratch_), data(scratch_) + n_).delta());
    }
}

// ---- output -----------------------------------------------------------------------------------------------------

// Inside the last interval from IDA's interpolant, at its end as returned.
void Run::state_at(double t, VectorXd &q, VectorXd &v) {
    if (t == t_) {
        q = q_;
        v = v_;
        return;
    }
    check(IDAGetDky(ida_, t, 0, scratch_.get()));
    q = part(static_cast<const double *>(data(scratch_)), 0, n_);
    v = part(static_cast<const double *>(data(scratch_)), n_, n_);
}

// Gauss quadrature of the powers over the last interval up to `to`, piecewise between the kinks of the contact law. The
// rule matches the order of the interpolant. Where functions of time are prescribed IDA may take long steps, exact for
// polynomials of its order, and powers have twice their degree.
Ledger Run::integral(double to) {
    double from = before_;
    Ledger sum;
    if (!(to > from) || (!system_.has_power() && (z_.array() <= 0.0).all())) return sum;
    int order = 0;
    check(IDAGetLastOrder(ida_, &order));
    std::vector<double> ends = kinks(to);
    ends.push_back(to);
    for (double end : ends) {
        auto add_point = [&](const GaussPoint &g) {
            const double t = from + g.x * (end - from);
            check(IDAGetDky(ida_, t, 0, scratch_.get()));
            qs_ = part(static_cast<const double *>(data(scratch_)), 0, n_);
            vs_ = part(static_cast<const double *>(data(scratch_)), n_, n_);
            const double weight = g.weight * (end - from);
            add(sum, weight, system_.powers(inputs(t).functions, qs_, vs_, z_));
            if (!system_.prescribes_motion()) return;
            acceleration_.solve(t, qs_, vs_, z_, false);
            sum.work += weight * acceleration_.prescribed_power();
        };
        if (system_.follows_functions())
            std::for_each(gauss5.begin(), gauss5.end(), add_point);
        else if (order <= 3)
            std::for_each(gauss2.begin(), gauss2.end(), add_point);
        else
            std::for_each(gauss3.begin(), gauss3.end(), add_point);
        from = end;
    }
    return sum;
}

// Where closed contacts start or cease to be clamped, in the last interval up to `to`.
std::vector<double> Run::kinks(double to) {
    std::vector<double> times;
    const std::vector<int> &loose = system_.loose_joints();
    for (std::size_t i = 0; i < loose.size(); ++i) {
        const int k = loose[i];
        if (!closed(k)) continue;
        auto pull = [&](const Watch &w) { return -bracket(system_.law(k), w.rate, z_[k]); };
        const double first = pull(watch_before_[i]), last = pull(to == t_ ? watch(k, data(y_)) : interpolated(k, to));
        if (first * last >= 0.0) continue;
        const double sign = first < 0.0 ? 1.0 : -1.0;
        times.push_back(bisect(before_, to, [&](const Watch &w) { return sign * pull(w); }, k));
    }
    std::sort(times.begin(), times.end());
    return times;
}

void Run::advance(double t, ls_row &row) {
    require(std::isfinite(t), "the time to advance to is not finite");
    require(t >= before_, "time must not run backwards");
    target_ = t;
    std::int64_t steps = 0;
    while (t_ < t) {
        if (steps++ >= tolerances_.max_steps)
            throw Failure(LS_IDA, "max_steps steps taken before reaching the time asked for", t_, IDA_TOO_MUCH_WORK);
        step();
    }
    describe(t, row);
}

void Run::describe(double t, ls_row &row) {
    state_at(t, row_q_, row_v_);
    acceleration_.solve(t, row_q_, row_v_, z_, true);
    const VectorXd &lambda = acceleration_.lambda;
    if (!acceleration_.a.allFinite() || !lambda.allFinite())
        throw Failure(LS_NOT_FINITE, "the acceleration is not finite", t);

    joint_force_.setZero(2 * system_.joints());
    joint_couple_.setZero(system_.joints());
    motion_force_.setZero(system_.motions());
    penetration_.setZero(system_.joints());
    torque_.setZero(system_.legs());
    for (int k = 0; k < system_.joints(); ++k) {
        const Vec<double> f = system_.joint_force(k, row_q_, row_v_, z_, lambda);
        joint_force_.segment<2>(2 * k) << f.x, f.y;
        joint_couple_[k] = system_.joint_couple(k, row_q_, lambda);
    }
    for (int k : system_.loose_joints()) penetration_[k] = system_.gap(k, row_q_.data(), row_v_.data()).delta();
    for (int i = 0; i < system_.legs(); ++i) torque_[i] = system_.torque(i, lambda);
    for (int i = 0; i < system_.motions(); ++i)
        motion_force_[i] = system_.motion_force(i, acceleration_.inputs, row_q_, lambda);

    const Energies u = system_.energies(row_q_, row_v_, z_);
    Ledger ledger = t == t_ ? ledger_ : ledger_before_;
    if (t != t_) {
        const VectorXd a = acceleration_.a, multipliers = lambda;
        add(ledger, 1.0, integral(t));
        acceleration_.a = a;
        acceleration_.lambda = multipliers;
    }
    row.t = t;
    row.q = row_q_.data();
    row.v = row_v_.data();
    row.a = acceleration_.a.data();
    row.lambda = acceleration_.lambda.data();
    row.joint_force = joint_force_.data();
    row.joint_couple = joint_couple_.data();
    row.penetration = penetration_.data();
    row.impact_velocity = z_.data();
    row.torque = torque_.data();
    row.motion_force = motion_force_.data();
    row.kinetic = u.kinetic;
    row.axial = u.axial;
    row.bending = u.bending;
    row.contact = u.contact;
    row.gravity = u.gravity;
    row.springs = u.springs;
    row.work = ledger.work;
    row.contact_dissipated = ledger.contact_dissipated;
    row.clamp = ledger.clamp;
    row.friction_dissipated = ledger.friction_dissipated;
    row.damping_dissipated = ledger.damping_dissipated;
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

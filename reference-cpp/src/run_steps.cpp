// Steps of IDA and restarts.
#include <algorithm>
#include <cmath>
#include <limits>

#include "run_vectors.hpp"

namespace {

// The predicted error of the first step after a restart, in units of the tolerance.
constexpr double first_step_error = 0.25;

} // namespace

void Run::step() {
    if (restart_pending_) restart();
    // Where the path leaves the reach of the mechanism, rates of actuated joints grow like 1 / sqrt: IDA would creep up with
    // ever smaller steps. Looking ahead ends that.
    constexpr double glance = 1e-6;
    if (t_ + glance <= target_) system_.inputs(t_ + glance);
    before_ = t_;
    ledger_before_ = ledger_;
    bristle_energy_before_ = system_.bristle_energy(q_, v_, memory_);
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
    if (x_ > 0) memory_.state = part(y, 2 * (n_ + m_), x_);
    ledger_.add(1.0, integral(t_));
    angles_ = continued(system_, angles_, q_);
    memory_.turn = spring_turns(system_, angles_);
    watch_clamps();
    watch_depth();
}

// Continues from (t_, q_, v_) with consistent derivatives; multipliers from the acceleration level.
void Run::restart() {
    apply_pending_events();
    acceleration_.project(t_, q_, v_, std::numeric_limits<double>::infinity());
    acceleration_.solve(t_, q_, v_, memory_, true);
    double *y = data(y_), *yp = data(yp_);
    N_VConst(0.0, y_.get());
    N_VConst(0.0, yp_.get());
    part(y, 0, n_) = q_;
    part(y, n_, n_) = v_;
    part(y, 2 * n_, m_) = acceleration_.lambda;
    part(yp, 0, n_) = v_;
    part(yp, n_, n_) = acceleration_.a;
    if (x_ > 0) {
        VectorXd rates;
        system_.state_rates(q_, v_, memory_, rates);
        part(y, 2 * (n_ + m_), x_) = memory_.state;
        part(yp, 2 * (n_ + m_), x_) = rates;
    }
    collect_statistics();
    ++statistics_.restarts;
    check(IDAReInit(ida_, t_, y_.get(), yp_.get()));
    check(IDASetInitStep(ida_, first_step()));
    // the contacts that are closed decide which entries the matrix has
    if (tolerances_.linear_solver == LS_SPARSE)
        check(SUNLinSol_KLUReInit(solver_.get(), matrix_.get(), SM_NNZ_S(matrix_.get()), SUNKLU_REINIT_PARTIAL));
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
// a trial step stands for v''. It catches the contact force, F ~ t^1.5 after an onset. The change of x' stands for x''.
double Run::first_step() {
    const VectorXd a = acceleration_.a;
    VectorXd rates, rates_there;
    system_.state_rates(q_, v_, memory_, rates);
    if (weights(y_.get(), scratch_.get(), this) != 0) return 0.0;
    const VectorXd w = part(static_cast<const double *>(data(scratch_)), 0, unknowns());
    const double scale = std::sqrt(1.0 / unknowns());
    auto norm = [&](const VectorXd &x, int offset) { return scale * x.cwiseProduct(w.segment(offset, n_)).norm(); };

    constexpr double longest = 1e-3;
    const double limit = tolerances_.max_step > 0.0 ? std::min(longest, tolerances_.max_step) : longest;
    const double shortest = 1e3 * std::numeric_limits<double>::epsilon() * std::max(1e-3, std::abs(t_));
    double h = std::min(limit, std::sqrt(2.0 * first_step_error / std::max(norm(a, 0), 1e-300)));
    for (int trial = 0; trial < 12 && h > shortest; ++trial) {
        const VectorXd q = q_ + h * v_ + 0.5 * h * h * a;
        const VectorXd v = v_ + h * a;
        Memory memory = memory_;
        memory.state += h * rates;
        acceleration_.solve(t_ + h, q, v, memory, false);
        double error = 0.5 * h * norm(acceleration_.a - a, n_);
        if (x_ > 0) {
            system_.state_rates(q, v, memory, rates_there);
            const VectorXd change = rates_there - rates;
            error = std::hypot(error, 0.5 * h * scale * change.cwiseProduct(w.tail(x_)).norm());
        }
        if (error <= first_step_error) break;
        h *= std::max(0.05, 0.8 * std::sqrt(first_step_error / error));
    }
    return std::max(h, shortest);
}

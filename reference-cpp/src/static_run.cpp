#include "static_run.hpp"

#include <algorithm>
#include <cmath>

StaticRun::StaticRun(const Model &model)
    : model_(model), channels_(model_), statics_(model_.system),
      x_{0.0, model_.q, VectorXd::Zero(model_.system.constraints()), model_.memory},
      path_(statics_, model_.q, model_.scene.duration), stability_(statics_.stability(x_)), angles_(starting_angles(model_)) {
    come_down(0.0);
    steps_ = 0;
}

void StaticRun::advance(double t) {
    require(std::isfinite(t) && t >= x_.t, "time must not run backwards");
    constexpr double rounding = 1e-9;
    while (x_.t < t) {
        // the path has a kink where a load has one
        const std::vector<double> &breaks = model_.system.breaks();
        const auto kink = std::upper_bound(breaks.begin(), breaks.end(), x_.t);
        const double end = kink != breaks.end() ? std::min(t, *kink) : t, step = model_.scene.step;
        const double next = end - x_.t <= step * (1.0 + rounding) ? end : x_.t + step;
        if (unstable_path_)
            follow_path(end);
        else if (!stability_.is_stable())
            come_down(next);
        else if (!follow_load(next))
            follow_path(next);
    }
}

void StaticRun::accept(const Equilibrium &x) {
    const System &system = model_.system;
    x_ = x;
    stability_ = statics_.stability(x_);
    for (int i = 0; i < angles_.spring.size(); ++i) // they may have turned far on the way down
        angles_.spring[i] = system.torsion_springs()[i].rest_angle + x_.memory.turn[i];
    angles_ = continued(system, angles_, x_.q);
    snapshot_.t = x_.t;
    snapshot_.q = x_.q;
    snapshot_.v = snapshot_.a = VectorXd::Zero(system.coordinates());
    snapshot_.lambda = x_.lambda;
    snapshot_.memory = x_.memory;
    snapshot_.angles = angles_;
    snapshot_.inputs = system.inputs(x_.t);
    system.check_left_out(snapshot_.inputs, x_.q, x_.t);
    ++steps_;
}

void StaticRun::come_down(double t) {
    Equilibrium next = x_;
    next.t = t;
    statics_.descend(next);
    accept(next);
}

// One step of t from a stable equilibrium. False where it leads away from the path or over a critical point.
bool StaticRun::follow_load(double t) {
    const PathPoint here = path_.start(x_);
    Equilibrium next = x_;
    next.t = t;
    if (!statics_.correct(next) || !statics_.stability(next).is_stable()) return false;
    constexpr double bend = 0.5, rounding = 1e-9;
    const VectorXd levers = model_.system.levers(), expected = (t - x_.t) / here.dt * here.dq;
    const double off = levers.cwiseProduct(next.q - x_.q - expected).norm();
    if (off > bend * levers.cwiseProduct(expected).norm() + rounding * statics_.equations().extent(x_.q)) return false;
    accept(next);
    return true;
}

// Along the arc length to t, or to where the path is stable again and its load grows.
void StaticRun::follow_path(double t) {
    PathPoint here = unstable_path_ ? *unstable_path_ : path_.start(x_);
    const double longest = model_.scene.step / model_.scene.duration, shortest = 1e-7 * longest;
    constexpr int most_steps = 100000;
    double length = longest;
    for (int i = 0; i < most_steps; ++i) {
        PathPoint next;
        if (!path_.step(here, length, next)) {
            length *= 0.5;
            if (length < shortest) throw Failure(LS_NOT_FINITE, "no equilibrium is found near the last one", here.x.t);
            continue;
        }
        const bool arrives = next.x.t >= t;
        bool passes = false;
        if (next.negative != here.negative) {
            const CriticalPoint critical = path_.locate(here, length, next);
            constexpr double rounding = 1e-9;
            passes = !arrives || critical.t <= t + rounding * model_.scene.duration;
            if (passes) pass(critical);
        }
        if (arrives) {
            const int beyond = next.negative;
            next = path_.at_load(here, length, next, t);
            if (passes) next.negative = beyond; // where a critical point is at t itself, rounding would decide
        }
        here = next;
        accept(here.x);
        const bool goes_on = here.negative == 0 && here.dt > 0.0; // as the load grows
        if (here.negative > 0) unstable_.push_back(snapshot_);
        if (goes_on)
            unstable_path_.reset();
        else
            unstable_path_ = here;
        if (arrives || (goes_on && i > 0 && critical_.size() > 0)) return;
        length = std::min(longest, 1.5 * length);
    }
    throw Failure(LS_NOT_FINITE, "the path of equilibria does not come to this load", t);
}

void StaticRun::pass(const CriticalPoint &c) {
    critical_.push_back(c);
    if (model_.scene.follow_at_limit) return;
    throw Failure(LS_LIMIT,
                  (c.limit ? "the load cannot grow beyond " : "another path of equilibria begins at ") +
                      text_of(c.t / model_.scene.duration) + " of its full size: " +
                      model_.system.coordinate_name(c.coordinate) + " moves without resistance",
                  c.t);
}

#include "static_run.hpp"

#include <cmath>

StaticRun::StaticRun(const Model &model)
    : model_(model), channels_(model_), statics_(model_.system), q_(model_.q), angles_(starting_angles(model_)),
      memory_(model_.memory) {
    if (!statics_.follow(0.0, memory_, q_)) statics_.relax(memory_, q_);
    describe();
}

// Steps of the scene's length, shorter ones where Newton's method needs them.
void StaticRun::advance(double t) {
    require(std::isfinite(t) && t >= t_, "time must not run backwards");
    const double shortest = 1e-6 * model_.scene.step;
    double step = model_.scene.step;
    while (t_ < t) {
        constexpr double rounding = 1e-9;
        const double next = t - t_ <= step * (1.0 + rounding) ? t : t_ + step;
        if (statics_.follow(next, memory_, q_)) {
            t_ = next;
            ++steps_;
            describe();
            step = std::min(2.0 * step, model_.scene.step);
            continue;
        }
        step *= 0.5;
        if (step < shortest) throw Failure(LS_NOT_FINITE, "no equilibrium is found near the last one", next);
    }
}

void StaticRun::describe() {
    const System &system = model_.system;
    angles_ = continued(system, angles_, q_);
    memory_.turn = spring_turns(system, angles_);
    const VectorXd rest = VectorXd::Zero(system.coordinates());
    snapshot_.t = t_;
    snapshot_.q = q_;
    snapshot_.v = snapshot_.a = rest;
    snapshot_.lambda = statics_.lambda();
    snapshot_.memory = memory_;
    snapshot_.angles = angles_;
    snapshot_.inputs = system.inputs(t_);
    system.check_left_out(snapshot_.inputs, q_, t_);
}

// A static analysis: equilibria under growing loads.
#pragma once

#include <optional>

#include "channels.hpp"
#include "load_path.hpp"

class StaticRun {
public:
    explicit StaticRun(const Model &model);
    StaticRun(const StaticRun &) = delete;
    StaticRun &operator=(const StaticRun &) = delete;

    // To the first equilibrium at t that the path comes to.
    void advance(double t);
    const Snapshot &snapshot() const { return snapshot_; }
    const Channels &channels() const { return channels_; }
    std::int64_t steps() const { return steps_; }
    const System &system() const { return model_.system; }
    double full_load() const { return model_.scene.duration; } // its t
    const Stability &stability() const { return stability_; }
    const std::vector<CriticalPoint> &critical_points() const { return critical_; }
    const std::vector<Snapshot> &unstable() const { return unstable_; } // steps along unstable paths so far

private:
    void accept(const Equilibrium &x);
    void come_down(double t);
    bool follow_load(double t);
    void follow_path(double t);
    void pass(const CriticalPoint &critical);

    Model model_;
    Channels channels_;
    Statics statics_;
    Equilibrium x_;
    LoadPath path_;
    Stability stability_;
    std::optional<PathPoint> unstable_path_; // beyond a critical point
    Angles angles_;
    std::int64_t steps_ = 0;
    std::vector<CriticalPoint> critical_;
    std::vector<Snapshot> unstable_;
    Snapshot snapshot_;
};

// A static analysis: equilibria under growing loads.
#pragma once

#include "channels.hpp"
#include "statics.hpp"

class StaticRun {
public:
    explicit StaticRun(const Model &model);
    StaticRun(const StaticRun &) = delete;
    StaticRun &operator=(const StaticRun &) = delete;

    void advance(double t);
    const Snapshot &snapshot() const { return snapshot_; }
    const Channels &channels() const { return channels_; }
    std::int64_t steps() const { return steps_; }

private:
    void describe();

    Model model_;
    Channels channels_;
    Statics statics_;
    double t_ = 0.0;
    VectorXd q_;
    Angles angles_;
    Memory memory_;
    std::int64_t steps_ = 0;
    Snapshot snapshot_;
};

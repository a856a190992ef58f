// The channels of docs/scene.md: named numbers that describe a state.
#pragma once

#include <functional>

#include "angles.hpp"

// All that channels are computed from.
struct Snapshot {
    double t = 0.0;
    VectorXd q, v, a, lambda;
    Memory memory;
    Angles angles;
    Powers ledger; // integrals since the start
    double initial_energy = 0.0;
    Inputs inputs;
};

class Channels {
public:
    explicit Channels(const Model &model); // which must outlive the channels

    const std::vector<std::string> &names() const { return names_; }
    void evaluate(const Snapshot &snapshot, double *values) const;
    // Those that patterns select, each once, t first. Refuses a pattern that matches nothing.
    std::vector<std::size_t> selected(const std::vector<std::string> &patterns, const Source &source) const;

private:
    using Fill = std::function<void(const Snapshot &, double *)>;
    void add(const std::string &prefix, std::initializer_list<const char *> quantities, Fill fill);
    void add_bodies();
    void add_deviation();
    void add_joints();
    void add_joint_kinematics(const std::string &prefix, int number);
    void add_points();
    void add_forces();
    void add_energies();

    struct Group {
        std::size_t first; // of its channels
        Fill fill;
    };
    const Model &model_;
    const System &system_;
    std::vector<std::string> names_;
    std::vector<Group> groups_;
};

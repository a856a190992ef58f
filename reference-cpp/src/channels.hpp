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
    // Those that patterns select, each once, t first. Notes a pattern that matches nothing, and a channel that the mechanism
    // would have with flexible links and clearance; refuses other names without a channel.
    std::vector<std::size_t> selected(const std::vector<std::string> &patterns, const Source &source,
                                      std::vector<std::string> &notes) const;

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

    void note_absent(const std::string &prefix, std::initializer_list<const char *> quantities);

    struct Group {
        std::size_t first; // of its channels
        Fill fill;
    };
    const Model &model_;
    const System &system_;
    std::vector<std::string> names_;
    std::vector<std::string> absent_; // names that other models of links and joints have
    std::vector<Group> groups_;
};

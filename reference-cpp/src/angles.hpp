// Angles that count full turns.
#pragma once

#include "model.hpp"

struct Angles {
    VectorXd body;   // by body: of a link that of its chord
    VectorXd joint;  // by joint: of the journal's body relative to the bearing's, driven joints only
    VectorXd spring; // by torsion spring: the same
};

// In the ranges in which docs/scene.md lets them start.
Angles starting_angles(const Model &model);
// The angles of a state less than half a turn away from `near`.
Angles continued(const System &system, const Angles &near, const VectorXd &q);
// What torsion springs remember of them.
VectorXd spring_turns(const System &system, const Angles &angles);

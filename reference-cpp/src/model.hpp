// A scene with its equations and its start.
#pragma once

#include "stability.hpp"
#include "system.hpp"

struct Model {
    Scene scene;
    System system;
    VectorXd q, v;                      // start
    Memory memory;                      // at the start
    std::vector<Frame> poses;           // of the bodies at the start
    std::vector<std::string> redundant; // rows left out
    std::optional<Stability> rest;      // of a start in equilibrium
};

Model make_model(Scene scene);

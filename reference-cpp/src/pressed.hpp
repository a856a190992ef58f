// A start with its journals against their bearings, in the balance of the mechanism with rigid links and ideal joints.
#pragma once

#include <memory>

#include "assembly.hpp"

struct Pressed {
    Assembled start;
    std::vector<bool> closed; // by joint: whether its contact begins closed
};

// start: with the journals in the middle of their bearings, or elsewhere in them.
Pressed press(const Scene &scene, std::shared_ptr<const DrivenAngles> driven_angles, const Assembled &start);

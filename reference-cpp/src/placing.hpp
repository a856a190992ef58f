// First places of the bodies of an ideal mechanism: from given states, paths, joints with bodies that are placed, drives and
// the sketch.
#pragma once

#include <vector>

#include "scene.hpp"

// The point of a body of an ideal mechanism, in the frame of the ground.
Vec<double> point_at(const Frame &pose, Vec<double> at);

// By body; at t = 0.
std::vector<Frame> place_bodies(const Scene &ideal);

// Refuses a sketched joint that has ended too far from its sketch.
void check_sketch(const Scene &ideal, const std::vector<Frame> &poses);

// The ideal mechanism of a scene: its links are rigid bodies, described by the frame in their middle, its joints have no
// clearance, and nothing acts on it. The driven body of inverse kinematics follows its path.
#pragma once

#include "scene.hpp"

Scene idealised(const Scene &scene);

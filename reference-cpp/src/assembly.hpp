// The start of the ideal mechanism: places that close its joints and velocities of least kinetic energy.
#pragma once

#include "system.hpp"

struct Assembled {
    std::vector<Frame> poses, velocities; // by body
};

// ideal: see ideal.hpp. Bodies with a given state stay in it, unless `states_are_guesses`.
Assembled assemble(const Scene &ideal, bool states_are_guesses);

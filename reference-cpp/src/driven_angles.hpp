// Angles of the actuated joints of inverse kinematics, so that the driven body of the ideal mechanism follows its path (eq. 27).
#pragma once

#include <memory>
#include <vector>

#include "function.hpp"
#include "scene.hpp"

class DrivenAngles {
public:
    virtual ~DrivenAngles() = default;
    // One angle of the journal's body relative to the bearing's for every actuated joint, in (-pi, pi]. Throws LS_UNREACHABLE
    // where the mechanism cannot follow its path.
    virtual std::vector<Prescribed> at_time(double t) const = 0;
};

// ideal: see ideal.hpp; start: the places of its bodies at t = 0, which choose the branch.
std::shared_ptr<const DrivenAngles> make_driven_angles(const Scene &ideal, const std::vector<Frame> &start);

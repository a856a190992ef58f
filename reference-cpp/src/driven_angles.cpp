#include "driven_angles.hpp"

#include "inverse_kinematics.hpp"
#include "path_following.hpp"

std::shared_ptr<const DrivenAngles> make_driven_angles(const Scene &ideal, const std::vector<Frame> &start) {
    auto pairs = std::make_shared<InverseKinematics>(ideal, start);
    if (pairs->complete()) return pairs;
    return std::make_shared<PathFollowing>(ideal, start);
}

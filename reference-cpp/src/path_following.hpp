// Inverse kinematics of any ideal mechanism by Newton's method, where it is no sequence of pairs of bodies.
#pragma once

#include "driven_angles.hpp"
#include "system.hpp"

class PathFollowing : public DrivenAngles {
public:
    PathFollowing(const Scene &ideal, const std::vector<Frame> &start);
    std::vector<Prescribed> at_time(double t) const override;

private:
    struct Station {
        double t;
        VectorXd q;
    };

    // Newton's method at t from q; false if it fails or would move further than `reach`.
    bool close(double t, double reach, VectorXd &q) const;
    void follow_path(double duration);
    void check_determined(const Source &source) const;
    VectorXd relative_angle(int joint) const; // its derivative by q

    System system_; // without rows for the actuated joints
    std::vector<std::pair<int, int>> angles_; // coordinates theta of first and second side, -1 for the ground
    std::vector<Station> stations_;           // places on the way, near enough for Newton's method
    double extent_;
};

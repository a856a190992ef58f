// Inverse kinematics of a sequence of pairs of bodies in closed form.
//
// The ground, moving bodies and the driven body are placed by functions of time. A pair of bodies A-B-C that a revolute
// joint B joins to each other, and revolute joints A and C to bodies already placed, follows from the law of cosines.
#pragma once

#include "driven_angles.hpp"

class InverseKinematics : public DrivenAngles {
public:
    InverseKinematics(const Scene &ideal, const std::vector<Frame> &start);
    bool complete() const { return complete_; } // whether it finds all actuated joints
    std::vector<Prescribed> at_time(double t) const override;

private:
    struct Pair {
        PointReference a, c;             // on bodies placed before
        int crank, passive;              // from A to B, from B to C
        Vec<double> crank_a, crank_b;    // A and B on the crank
        Vec<double> passive_b, passive_c;
        double elbow;                    // sign of (B - A) x (C - B)
        std::string name;                // of the joint B
    };
    struct Pose {
        Vec<Jet> center;
        Jet theta;
    };
    struct ActuatedJoint {
        int first, second; // bodies
    };

    bool find_pair(const Scene &ideal, std::vector<bool> &placed, const std::vector<Frame> &start);
    static void place(const Pair &pair, std::vector<Pose> &poses, double t);

    std::vector<std::optional<Path>> paths_; // by body
    std::vector<Pair> pairs_;
    std::vector<ActuatedJoint> joints_;
    bool complete_ = true;
};

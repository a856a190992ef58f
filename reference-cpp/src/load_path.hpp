// The path (q, lambda, t) of equilibria, by its arc length: where the load must fall, and over unstable equilibria.
#pragma once

#include "statics.hpp"

struct PathPoint {
    Equilibrium x;
    VectorXd dq, dlambda; // tangent, of length 1
    double dt = 0.0;
    int negative = 0; // eigenvalues
};

struct CriticalPoint {
    double t = 0.0;
    bool limit = false; // the load has an extreme there; otherwise another path crosses
    int coordinate = 0; // that moves most in the motion without resistance
};

class LoadPath {
public:
    // duration: t of the full load
    LoadPath(Statics &statics, const VectorXd &q, double duration);

    // From a stable equilibrium in the sense of growing t; otherwise in that of `before`.
    PathPoint start(const Equilibrium &x);
    PathPoint go_on(const Equilibrium &x, const PathPoint &before);
    // A step of the given arc length. False where it is too long for the bend of the path.
    bool step(const PathPoint &from, double length, PathPoint &to);
    // The point under the load t within the last step.
    PathPoint at_load(const PathPoint &from, double length, const PathPoint &to, double t);
    // Within the last step, which has changed the number of negative eigenvalues.
    CriticalPoint locate(const PathPoint &from, double length, const PathPoint &to);

private:
    double product(const PathPoint &a, const VectorXd &dq, double dt) const;
    void normalise(PathPoint &point) const;
    VectorXd weighted(const PathPoint &a) const;
    PathPoint with_tangent(const Equilibrium &x, const VectorXd &last_row);
    double test_function(const Equilibrium &x, const VectorXd &border);
    PathPoint at(const PathPoint &from, double length);

    Statics &statics_;
    VectorXd weight_; // of q in the square of the arc length
    double time_weight_;
};

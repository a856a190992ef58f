// Equilibria by Newton's method and by descent.
#pragma once

#include "equilibrium.hpp"

class Statics {
public:
    explicit Statics(const System &system) : equations_(system) {}

    // From an equilibrium near by, under the loads at x.t. False if Newton's method does not converge; x is then as it was.
    bool correct(Equilibrium &x);
    // From anywhere, down to the equilibrium that a heavily damped mechanism comes to, neutral at worst. Throws if there is
    // none.
    void descend(Equilibrium &x);
    // From anywhere, to the equilibrium that Newton's method with short steps comes to, stable or not. Throws if there is none.
    void approach(Equilibrium &x);
    Stability stability(const Equilibrium &x);

    StaticEquations &equations() { return equations_; }

private:
    bool step(const Equilibrium &x, double inertia, VectorXd &dq, VectorXd &lambda) const;
    bool settles(const Equilibrium &x, const VectorXd &lambda) const;

    StaticEquations equations_;
};

#include "acceleration.hpp"

#include "failure.hpp"

Acceleration::Acceleration(const System &system) : system_(system) {}

void Acceleration::linearise(double t, const VectorXd &q) {
    inputs = system_.inputs(t);
    system_.constraint_rows(inputs, q, phi_, phi_q_, phi_t_);
    system_.reduce_mass(phi_q_, w_, s_);
    if (system_.constraints() == 0) return;
    factor_.compute(s_);
    if (factor_.independent()) return;
    const std::vector<int> rows = ConstraintFactor::dependent_rows(s_);
    throw Failure(LS_BAD_INPUT, "singular pose: row " + (rows.empty() ? "a constraint" : system_.row_name(rows.front())) +
                                    " depends linearly on the rows before it", t);
}

void Acceleration::solve(double t, const VectorXd &q, const VectorXd &v, const Memory &memory, bool refine) {
    linearise(t, q);
    system_.force(inputs, q, v, memory, f_);
    a = -system_.divided_by_mass(f_);
    lambda.setZero(system_.constraints());
    if (system_.constraints() == 0) return;
    system_.convective(inputs, q, v, gamma_);
    for (const auto &p : system_.prescribed()) a[p.coordinate] = -gamma_[p.row];
    for (int pass = 0; pass < (refine ? 2 : 1); ++pass) {
        const VectorXd correction = factor_.solve(gamma_ + phi_q_ * a);
        lambda += correction;
        a.noalias() -= w_ * correction;
    }
    for (const auto &p : system_.prescribed()) {
        lambda[p.row] = 0.0;
        lambda[p.row] = -(f_[p.coordinate] + phi_q_.col(p.coordinate).dot(lambda));
    }
}

void Acceleration::require_small(const VectorXd &violation, double limit, const char *what, double t) const {
    Eigen::Index worst = 0;
    const double size = violation.cwiseAbs().maxCoeff(&worst);
    if (!(size <= limit))
        throw Failure(LS_BAD_INPUT,
                      std::string("the ") + what + " violate the constraints: " +
                          system_.row_name(static_cast<int>(worst)) + ", by " + text_of(size),
                      t);
}

void Acceleration::project(double t, VectorXd &q, VectorXd &v, double limit) {
    if (system_.constraints() == 0) return;
    constexpr double rounding = 1e-15;
    linearise(t, q);
    require_small(phi_, limit, "positions", t);
    if (!system_.prescribed().empty()) {
        for (const auto &p : system_.prescribed()) q[p.coordinate] -= phi_[p.row];
        linearise(t, q);
    }
    for (int pass = 0; pass < 3; ++pass) {
        if (phi_.cwiseAbs().maxCoeff() <= rounding) break;
        q.noalias() -= w_ * factor_.solve(phi_);
        linearise(t, q);
        require_small(phi_, limit, "positions", t);
    }
    require_small(phi_q_ * v + phi_t_, limit, "velocities", t);
    project_velocities(v);
}

void Acceleration::project_velocities(double t, const VectorXd &q, VectorXd &v) {
    if (system_.constraints() == 0) return;
    linearise(t, q);
    project_velocities(v);
}

void Acceleration::project_velocities(VectorXd &v) const {
    for (const auto &p : system_.prescribed()) v[p.coordinate] = -phi_t_[p.row];
    v.noalias() -= w_ * factor_.solve(phi_q_ * v + phi_t_);
}

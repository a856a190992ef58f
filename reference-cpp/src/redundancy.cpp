#include "redundancy.hpp"

#include <cmath>

#include "acceleration.hpp"

namespace {

std::vector<int> dependent_rows(const System &system, const VectorXd &q) {
    VectorXd phi, phi_t;
    MatrixXd phi_q, w, s;
    system.constraint_rows(system.inputs(0.0), q, phi, phi_q, phi_t);
    if (phi.size() == 0) return {};
    system.reduce_mass(phi_q, w, s);
    return ConstraintFactor::dependent_rows(s);
}

} // namespace

// The mechanism is moved a little in a direction that its independent rows permit. Rows that hold there as well repeat the
// others; rows that do not were dependent in a singular pose.
std::vector<int> redundant_rows(const System &system, const VectorXd &q) {
    const std::vector<int> rows = dependent_rows(system, q);
    if (rows.empty()) return rows;
    System independent = system;
    independent.leave_out(rows);
    Acceleration level(independent);
    const double extent = q.maxCoeff() - q.minCoeff(), part = 1e-3, limit = 1e-9 * extent;
    for (int trial = 1; trial <= 2; ++trial) {
        VectorXd moved = q, direction(q.size());
        for (int i = 0; i < direction.size(); ++i) direction[i] = std::sin(trial + 7.3 * i);
        level.project(0.0, moved, direction, std::numeric_limits<double>::infinity());
        const double speed = direction.cwiseAbs().maxCoeff();
        if (speed <= limit) return rows; // nothing can move
        moved = q + part * extent / speed * direction;
        level.project(0.0, moved, direction, std::numeric_limits<double>::infinity());
        VectorXd phi, phi_t;
        MatrixXd phi_q;
        system.constraint_rows(system.inputs(0.0), moved, phi, phi_q, phi_t);
        for (int row : rows)
            if (std::abs(phi[row]) > limit)
                refuse(system.row_source(row), "the start is a singular pose: row " + system.row_name(row) +
                                                   " depends linearly on the rows before it");
    }
    return rows;
}

#include "newton.hpp"

namespace {

void add_to(MatrixXd &matrix, const Entries &entries, double factor) {
    for (const auto &entry : entries) matrix(entry.row(), entry.col()) += factor * entry.value();
}

} // namespace

SparseMatrix newton_matrix(const System &system, double c, const Inputs &inputs, const VectorXd &q, const VectorXd &v,
                           const Memory &memory, const VectorXd &lambda) {
    const int n = system.coordinates(), m = system.constraints(), x = 2 * (n + m), size = x + system.states();
    Entries stiffness, damping, rate, all;
    system.force_derivatives(inputs, q, v, memory, stiffness, damping);
    system.constraint_derivatives(inputs, q, v, lambda, stiffness, rate);
    for (int column = 0; column < n; ++column)
        for (SparseMatrix::InnerIterator entry(system.mass(), column); entry; ++entry) {
            const int row = static_cast<int>(entry.row());
            all.emplace_back(row, column, c * entry.value());
            all.emplace_back(row, n + column, -entry.value());
            all.emplace_back(n + row, n + column, c * entry.value());
        }
    for (const auto &entry : stiffness) all.emplace_back(n + entry.row(), entry.col(), entry.value());
    for (const auto &entry : damping) all.emplace_back(n + entry.row(), n + entry.col(), entry.value());
    for (const auto &entry : rate) all.emplace_back(2 * n + m + entry.row(), entry.col(), entry.value());

    VectorXd phi, phi_t;
    MatrixXd phi_q;
    system.constraint_rows(inputs, q, phi, phi_q, phi_t);
    for (int k = 0; k < m; ++k) {
        const Constraint &row = system.constraint(k);
        for (int i = 0; i < row.size; ++i) {
            const int coordinate = row.index[i];
            const double entry = phi_q(k, coordinate);
            all.emplace_back(coordinate, 2 * n + m + k, entry); // Phi_q^T mu
            all.emplace_back(n + coordinate, 2 * n + k, entry); // Phi_q^T lambda
            all.emplace_back(2 * n + k, coordinate, entry);
            all.emplace_back(2 * n + m + k, n + coordinate, entry);
        }
    }
    StateDerivatives states;
    system.state_derivatives(q, v, memory, states);
    for (const auto &entry : states.rate_by_q) all.emplace_back(x + entry.row(), entry.col(), -entry.value());
    for (const auto &entry : states.rate_by_v) all.emplace_back(x + entry.row(), n + entry.col(), -entry.value());
    for (const auto &entry : states.rate_by_state) all.emplace_back(x + entry.row(), x + entry.col(), -entry.value());
    for (const auto &entry : states.force_by_state) all.emplace_back(n + entry.row(), x + entry.col(), entry.value());
    for (int i = 0; i < system.states(); ++i) all.emplace_back(x + i, x + i, c);
    SparseMatrix matrix(size, size);
    matrix.setFromTriplets(all.begin(), all.end());
    return matrix;
}

// With W = M^-1 Phi_q^T, dv = c dq + W dmu - M^-1 b1 from the first row and nu = dlambda + c dmu the rest becomes
//
//     [ c^2 M + c C + K   Phi_q^T ] [ dq ]   [ b2 + c b1 + C (M^-1 b1 - W dmu) ]
//     [ Phi_q             0       ] [ nu ] = [ b3                              ]
//
//     (Phi_q W) dmu = b4 - c b3 + Phi_q M^-1 b1 - d(Phi_q v + Phi_t)/dq dq
//
// where K = d(f + Phi_q^T lambda)/dq and C = df/dv. In C W dmu the last term of dmu, smaller than the others by the
// step over the time scale of the motion, is left out, and so is d(Phi_q^T mu)/dq, since mu vanishes with the
// tolerance; Newton's method corrects what little they do. Then one matrix of n + m and one of m rows are factorised
// instead of one of 2 (n + m). The first block is divided by c^2 so that it tends to the acceleration-level matrix.
//
// The coordinates p of moving bodies have no mass; M^-1 means zero there. Their dq is in b3 by the second row above, and
// what the first row leaves open, s = dv - c dq, is b4 - c b3 of the rows that prescribe them: it is added to dv wherever
// that occurs. Their rows of r1 hold no more than mu, and give it at the end.
//
// The internal states are eliminated before all that: (c - dg/dx) dx = b5 + dg/dq dq + dg/dv dv. What df/dx dx holds of dq and
// dv is added to K and C.

DenseNewton::DenseNewton(const System &system) : system_(system) {}

void DenseNewton::assemble(double c, const Inputs &inputs, const VectorXd &q, const VectorXd &v,
                            const Memory &memory, const VectorXd &lambda) {
    const int n = system_.coordinates(), m = system_.constraints();
    c_ = c;
    Entries stiffness, damping, rate;
    system_.force_derivatives(inputs, q, v, memory, stiffness, damping);
    system_.constraint_rows(inputs, q, phi_, phi_q_, phi_t_);
    system_.constraint_derivatives(inputs, q, v, lambda, stiffness, rate);
    by_v_.setZero(n, n);
    rate_by_q_.setZero(m, n);
    add_to(by_v_, damping, 1.0);
    add_to(rate_by_q_, rate, 1.0);
    if (system_.states() > 0) eliminate_states(q, v, memory);
    damped_ = (by_v_.array() != 0.0).any();

    kkt_.setZero(n + m, n + m);
    add_to(kkt_, stiffness, 1.0 / (c * c));
    for (int column = 0; column < n; ++column)
        for (SparseMatrix::InnerIterator entry(system_.mass(), column); entry; ++entry)
            kkt_(entry.row(), column) += entry.value();
    if (damped_) kkt_.topLeftCorner(n, n) += by_v_ / c;
    if (system_.states() > 0) kkt_.topLeftCorner(n, n) += force_by_state_ * state_by_q_ / (c * c);
    kkt_.topRightCorner(n, m) = phi_q_.transpose();
    kkt_.bottomLeftCorner(m, n) = phi_q_;
    lu_.compute(kkt_);

    if (m == 0) return;
    system_.reduce_mass(phi_q_, w_, s_);
    projection_.compute(s_);
}

// P = c - dg/dx, P^-1 dg/dq and P^-1 dg/dv, and what they add to C.
void DenseNewton::eliminate_states(const VectorXd &q, const VectorXd &v, const Memory &memory) {
    const int n = system_.coordinates(), count = system_.states();
    StateDerivatives states;
    system_.state_derivatives(q, v, memory, states);
    state_pivot_.setConstant(count, c_);
    for (const auto &entry : states.rate_by_state) state_pivot_[entry.row()] -= entry.value();
    force_by_state_.setZero(n, count);
    state_by_q_.setZero(count, n);
    state_by_v_.setZero(count, n);
    add_to(force_by_state_, states.force_by_state, 1.0);
    add_to(state_by_q_, states.rate_by_q, 1.0);
    add_to(state_by_v_, states.rate_by_v, 1.0);
    const VectorXd inverse = state_pivot_.cwiseInverse();
    state_by_q_ = inverse.asDiagonal() * state_by_q_;
    state_by_v_ = inverse.asDiagonal() * state_by_v_;
    by_v_.noalias() += force_by_state_ * state_by_v_;
}

void DenseNewton::solve(const Eigen::Ref<const VectorXd> &b, Eigen::Ref<VectorXd> x) const {
    const int n = system_.coordinates(), count = system_.states();
    if (count == 0) return solve_motion(b, x);
    const VectorXd known = b.tail(count).cwiseQuotient(state_pivot_);
    VectorXd rest = b;
    rest.segment(n, n).noalias() -= force_by_state_ * known;
    solve_motion(rest, x);
    x.tail(count) = known + state_by_q_ * x.head(n) + state_by_v_ * x.segment(n, n);
}

void DenseNewton::solve_motion(const Eigen::Ref<const VectorXd> &b, Eigen::Ref<VectorXd> x) const {
    const int n = system_.coordinates(), m = system_.constraints();
    const auto b1 = b.segment(0, n), b2 = b.segment(n, n), b3 = b.segment(2 * n, m), b4 = b.segment(2 * n + m, m);
    const VectorXd m_b1 = system_.divided_by_mass(b1);

    VectorXd known = -m_b1; // dv - c dq as far as it does not depend on dmu
    for (const auto &p : system_.prescribed()) known[p.coordinate] = b4[p.row] - c_ * b3[p.row];
    VectorXd drift, w_mu = VectorXd::Zero(n);
    if (m > 0) {
        drift = b4 - c_ * b3 - phi_q_ * known;
        w_mu = w_ * projection_.solve(drift);
    }
    VectorXd rhs(n + m);
    rhs.head(n) = b2 + c_ * b1;
    if (damped_) rhs.head(n) -= by_v_ * (known + w_mu);
    rhs.head(n) /= c_ * c_;
    rhs.tail(m) = b3;
    const VectorXd y = lu_.solve(rhs);
    const auto dq = y.head(n);

    x.segment(0, n) = dq;
    x.segment(n, n) = c_ * dq + known;
    if (m == 0) return;
    VectorXd dmu = projection_.solve(drift - rate_by_q_ * dq);
    x.segment(n, n) += w_ * dmu;
    for (const auto &p : system_.prescribed()) {
        dmu[p.row] = 0.0;
        dmu[p.row] = b1[p.coordinate] - phi_q_.col(p.coordinate).dot(dmu);
    }
    x.segment(2 * n, m) = c_ * c_ * y.tail(m) - c_ * dmu;
    x.segment(2 * n + m, m) = dmu;
}

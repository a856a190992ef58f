#include "path_following.hpp"

#include <algorithm>
#include <cmath>

#include "decomposition.hpp"

namespace {

constexpr double pi = 3.14159265358979323846;

} // namespace

PathFollowing::PathFollowing(const Scene &ideal, const std::vector<Frame> &start) : system_(ideal) {
    VectorXd q = VectorXd::Zero(system_.coordinates()), v = q;
    for (std::size_t i = 0; i < start.size(); ++i) put_body(system_.bodies()[i], start[i], {}, {}, q, v);
    extent_ = q.maxCoeff() - q.minCoeff();
    auto theta = [&](int body) {
        const Body &b = system_.bodies()[body];
        return b.size == 3 ? b.offset + 2 : -1;
    };
    for (int j : ideal.inverse_kinematics->joints) {
        const JointDescription &joint = ideal.joints[j];
        angles_.emplace_back(theta(joint.first.body), theta(joint.second.body));
    }
    stations_.push_back({0.0, q});
    check_determined(ideal.inverse_kinematics->source);
    follow_path(ideal.duration);
}

VectorXd PathFollowing::relative_angle(int joint) const {
    VectorXd row = VectorXd::Zero(system_.coordinates());
    const auto [first, second] = angles_[static_cast<std::size_t>(joint)];
    if (first >= 0) row[first] -= 1.0;
    if (second >= 0) row[second] += 1.0;
    return row;
}

// An angle is determined if its derivative is a combination of the rows of Phi_q.
void PathFollowing::check_determined(const Source &source) const {
    VectorXd phi, phi_t;
    MatrixXd phi_q;
    system_.constraint_rows(system_.inputs(0.0), stations_.front().q, phi, phi_q, phi_t);
    const Decomposition combination(phi_q.transpose());
    for (std::size_t j = 0; j < angles_.size(); ++j) {
        const VectorXd row = relative_angle(static_cast<int>(j));
        const double rest = (phi_q.transpose() * combination.solve(row) - row).norm();
        constexpr double limit = 1e-8;
        require(rest <= limit, source, "the path does not determine the angles of the actuated joints");
    }
}

bool PathFollowing::close(double t, double reach, VectorXd &q) const {
    const Inputs inputs = system_.inputs(t);
    const VectorXd from = q;
    VectorXd phi, phi_t;
    MatrixXd phi_q;
    constexpr int most_passes = 20;
    constexpr double closure = 1e-12;
    double last = std::numeric_limits<double>::infinity();
    for (int pass = 0; pass < most_passes; ++pass) {
        system_.constraint_rows(inputs, q, phi, phi_q, phi_t);
        const double size = phi.cwiseAbs().maxCoeff();
        if (size <= closure && !(size < 0.5 * last)) return true;
        last = size;
        q -= Decomposition(phi_q).solve(phi);
        if (!((q - from).cwiseAbs().maxCoeff() <= reach)) return false;
    }
    return false;
}

void PathFollowing::follow_path(double duration) {
    const double reach = 0.02 * extent_, shortest = 1e-9 * duration;
    double step = 1e-3 * duration;
    while (stations_.back().t < duration && step > shortest) {
        Station next{std::min(stations_.back().t + step, duration), stations_.back().q};
        if (close(next.t, reach, next.q)) {
            stations_.push_back(std::move(next));
            step *= 2.0;
        } else {
            step *= 0.5;
        }
    }
}

std::vector<Prescribed> PathFollowing::at_time(double t) const {
    const auto after = std::upper_bound(stations_.begin() + 1, stations_.end(), t,
                                        [](double time, const Station &station) { return time < station.t; });
    VectorXd q = std::prev(after)->q, phi, phi_t, gamma;
    if (!close(t, extent_, q))
        throw Failure(LS_UNREACHABLE, "inverse kinematics: the mechanism cannot follow its path", t);
    const Inputs inputs = system_.inputs(t);
    MatrixXd phi_q;
    system_.constraint_rows(inputs, q, phi, phi_q, phi_t);
    const Decomposition inverse(phi_q);
    const VectorXd v = -inverse.solve(phi_t);
    system_.convective(inputs, q, v, gamma);
    const VectorXd a = -inverse.solve(gamma);
    std::vector<Prescribed> values;
    for (std::size_t j = 0; j < angles_.size(); ++j) {
        const VectorXd row = relative_angle(static_cast<int>(j));
        const double angle = row.dot(q);
        values.push_back({angle - 2.0 * pi * std::ceil((angle - pi) / (2.0 * pi)), row.dot(v), row.dot(a)});
    }
    return values;
}

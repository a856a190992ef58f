#include "assembly.hpp"

#include <cmath>

#include "closing.hpp"
#include "decomposition.hpp"
#include "placing.hpp"

namespace {

constexpr double velocity_rounding = 1e-9; // allowed contradiction of velocities, m/s and rad/s

// One row of what is known of the velocities: the rate of a coordinate.
struct GivenRate {
    int coordinate;
    double value;
    Source source;
};

std::vector<GivenRate> rates_of_states(const Scene &ideal, const System &system) {
    std::vector<GivenRate> rates;
    for (std::size_t i = 0; i < ideal.bodies.size(); ++i) {
        const std::optional<State> &state = ideal.initial.states[i];
        if (!state || !state->velocity) continue;
        const Body &body = system.bodies()[i];
        const double values[3] = {state->velocity->x, state->velocity->y, state->velocity->theta};
        for (int k = 0; k < body.size; ++k) rates.push_back({body.offset + k, values[k], state->source});
    }
    return rates;
}

// Of all velocities with Phi_q v + Phi_t = 0 and the given rates, those of least kinetic energy.
VectorXd least_velocities(const Scene &ideal, const System &system, const VectorXd &q, bool states_are_guesses) {
    VectorXd phi, phi_t;
    MatrixXd rows;
    system.constraint_rows(system.inputs(0.0), q, phi, rows, phi_t);
    VectorXd right = -phi_t;
    auto add = [&](const GivenRate &rate) {
        rows.conservativeResizeLike(MatrixXd::Zero(rows.rows() + 1, system.coordinates()));
        rows(rows.rows() - 1, rate.coordinate) = 1.0;
        right.conservativeResize(right.size() + 1);
        right[right.size() - 1] = rate.value;
    };
    std::vector<GivenRate> given;
    if (!states_are_guesses) given = rates_of_states(ideal, system);
    // the massless coordinates are all prescribed: any weight will do for them
    const VectorXd scale = VectorXd(system.mass().diagonal()).unaryExpr([](double m) {
        return m > 0.0 ? 1.0 / std::sqrt(m) : 1.0;
    });
    auto solved = [&](const Source *source) -> VectorXd {
        const VectorXd v = scale.cwiseProduct(Decomposition(rows * scale.asDiagonal()).solve(right));
        Eigen::Index worst = 0;
        if (rows.rows() == 0 || (rows * v - right).cwiseAbs().maxCoeff(&worst) <= velocity_rounding) return v;
        const std::string text = "the velocity contradicts the joints, the drives or other velocities";
        if (source) refuse(*source, text);
        const int row = static_cast<int>(worst), state = row - system.constraints();
        refuse(state < 0 ? system.row_source(row) : given[static_cast<std::size_t>(state)].source, text);
    };
    for (const GivenRate &rate : given) add(rate);
    VectorXd v = solved(nullptr);
    for (const SingleVelocity &single : ideal.initial.velocities) {
        const Eigen::Index before = Decomposition(rows * scale.asDiagonal()).rank();
        add({system.bodies()[single.body].offset + single.component, single.value, single.source});
        const bool repeats = Decomposition(rows * scale.asDiagonal()).rank() == before;
        v = solved(&single.source);
        require(!repeats, single.source, "the joints, the drives or other velocities determine this velocity already");
    }
    return v;
}

Frame frame_of(const Body &body, const VectorXd &x) {
    if (body.size == 0) return {};
    return {x[body.offset], x[body.offset + 1], body.size > 2 ? x[body.offset + 2] : 0.0};
}

} // namespace

Assembled assemble(const Scene &ideal, bool states_are_guesses) {
    const System system(ideal);
    const std::vector<Frame> placed = place_bodies(ideal);
    VectorXd q = VectorXd::Zero(system.coordinates()), v = q, freedom = VectorXd::Ones(system.coordinates());
    for (std::size_t i = 0; i < placed.size(); ++i) {
        const Body &body = system.bodies()[i];
        put_body(body, placed[i], {}, {}, q, v);
        const bool stays = body.kind == BodyKind::moving || (ideal.initial.states[i] && !states_are_guesses);
        if (stays) freedom.segment(body.offset, body.size).setZero();
    }
    // lengths count as they are, angles times the radius of gyration
    close_rows(system, VectorXd::Zero(system.constraints()), freedom.cwiseQuotient(system.levers()), q);
    v = least_velocities(ideal, system, q, states_are_guesses);

    Assembled start;
    for (const Body &body : system.bodies()) {
        start.poses.push_back(frame_of(body, q));
        start.velocities.push_back(frame_of(body, v));
    }
    check_sketch(ideal, start.poses);
    return start;
}

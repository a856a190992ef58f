// The C functions: checks of pointers, exceptions to error codes, vectors to arrays.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <new>
#include <optional>

#include "reference.h"
#include "run.hpp"
#include "static_run.hpp"
#include "sundials.hpp"

struct ls_scene {
    explicit ls_scene(Model m) : model(std::move(m)), channels(model), angles(starting_angles(model)) {
        selected = channels.selected(model.scene.patterns, model.scene.patterns_source, notes);
        if (model.rest && !model.rest->is_stable())
            notes.push_back(std::string("the equilibrium of the start is ") + (model.rest->is_unstable() ? "unstable" : "neutral") +
                            ": " + model.system.coordinate_name(model.system.moves_most(model.rest->softest())) + " moves");
        for (int i = 0; i < model.system.states(); ++i) state_names.push_back(model.system.state_name(i));
        memory = model.memory;
        energy = model.system.energies(model.q, model.v, memory).total();
    }
    ls_scene(const ls_scene &) = delete;
    ls_scene &operator=(const ls_scene &) = delete;

    const Model model;
    const Channels channels;
    const Angles angles;
    std::vector<std::size_t> selected;
    std::vector<std::string> state_names, notes;
    Memory memory; // at the start, but for the internal states: those that the caller has set
    double energy = 0.0;
};

struct ls_run {
    std::unique_ptr<Run> dynamic; // one of the two
    std::unique_ptr<StaticRun> equilibria;
    std::optional<Failure> dead;

    const Snapshot &snapshot() const { return dynamic ? dynamic->snapshot() : equilibria->snapshot(); }
    const Channels &channels() const { return dynamic ? dynamic->channels() : equilibria->channels(); }
    void advance(double t) { dynamic ? dynamic->advance(t) : equilibria->advance(t); }
};

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

void fill(ls_error *error, const Failure &failure) {
    if (!error) return;
    error->code = failure.code;
    error->flag = failure.flag;
    error->line = failure.source.line;
    error->column = failure.source.column;
    error->time = failure.time;
    std::snprintf(error->field, sizeof error->field, "%s", failure.source.field.c_str());
    std::snprintf(error->message, sizeof error->message, "%s", failure.what());
}

template <class Work>
std::int32_t guarded(ls_error *error, Work work) noexcept {
    if (error) *error = ls_error{};
    try {
        try {
            work();
            return LS_OK;
        } catch (const Failure &e) {
            fill(error, e);
            return e.code;
        } catch (const std::bad_alloc &) {
            fill(error, Failure(LS_INTERNAL, "out of memory"));
        } catch (const std::exception &e) {
            fill(error, Failure(LS_INTERNAL, e.what()));
        }
    } catch (...) { // no memory for the message
        if (error) error->code = LS_INTERNAL;
    }
    return LS_INTERNAL;
}

template <class P>
P &need(P *pointer, const char *name) {
    if (!pointer) throw Failure(LS_BAD_INPUT, std::string(name) + " is null");
    return *pointer;
}

VectorXd input(const double *x, Eigen::Index size, const char *name) {
    if (size > 0) need(x, name);
    VectorXd copy = Eigen::Map<const VectorXd>(x, size);
    if (!copy.allFinite()) throw Failure(LS_NOT_FINITE, std::string(name) + " is not finite");
    return copy;
}

void output(const VectorXd &x, double *target, const char *name) {
    if (x.size() > 0) std::copy(x.data(), x.data() + x.size(), &need(target, name));
}

void output(const MatrixXd &x, double *target, const char *name) {
    if (x.size() > 0) Eigen::Map<RowMajor>(&need(target, name), x.rows(), x.cols()) = x;
}

void output(const Entries &entries, int rows, int columns, double *target, const char *name) {
    if (rows == 0 || columns == 0) return;
    Eigen::Map<RowMajor> matrix(&need(target, name), rows, columns);
    matrix.setZero();
    for (const auto &entry : entries) matrix(entry.row(), entry.col()) += entry.value();
}

// A state given by the caller.
struct GivenState {
    double t;
    VectorXd q, v;
    Memory memory;

    GivenState(const ls_scene &scene, double time, const double *qs, const double *vs, const double *z)
        : t(time), q(input(qs, scene.model.system.coordinates(), "q")),
          v(input(vs, scene.model.system.coordinates(), "v")), memory(scene.memory) {
        memory.turn = spring_turns(scene.model.system, continued(scene.model.system, scene.angles, q));
        require(std::isfinite(t), "t is not finite");
        memory.impact_velocity = input(z, memory.impact_velocity.size(), "z");
    }
};

ls_rest described(const Stability &stability, const System &system) {
    if (!stability.can_move()) return {0.0, 1, -1};
    return {stability.least(), stability.is_stable() ? 1 : stability.is_unstable() ? -1 : 0,
            system.moves_most(stability.softest())};
}

int elongations(const System &system) { return system.states() - system.bristles(); }

const StaticRun &static_run(const ls_run *run) {
    const std::unique_ptr<StaticRun> &equilibria = need(run, "run").equilibria;
    require(equilibria != nullptr, "the run is no static analysis");
    return *equilibria;
}

ls_run *new_run(const ls_scene *scene, double t, const double *q, const double *v, bool from_start,
                const ls_tolerances *tolerances, ls_error *error) noexcept {
    ls_run *result = nullptr;
    guarded(error, [&] {
        const Model &model = need(scene, "scene").model;
        auto run = std::make_unique<ls_run>();
        if (model.scene.is_static) {
            require(from_start, "a static analysis can only begin at the start of its scene");
            run->equilibria = std::make_unique<StaticRun>(model);
        } else {
            const int n = model.system.coordinates();
            require(std::isfinite(t), "t is not finite");
            Memory memory = from_start ? model.memory : model.system.memory();
            if (!from_start) memory.state.tail(elongations(model.system)) = scene->memory.state.tail(elongations(model.system));
            run->dynamic = std::make_unique<Run>(model, t, from_start ? model.q : input(q, n, "q"),
                                                 from_start ? model.v : input(v, n, "v"), memory,
                                                 need(tolerances, "tolerances"));
        }
        result = run.release();
    });
    return result;
}

} // namespace

ls_scene *ls_scene_read(const char *text, const char *const *overrides, std::size_t count, ls_error *error) {
    ls_scene *scene = nullptr;
    guarded(error, [&] {
        std::vector<std::string> assignments;
        if (count > 0) need(overrides, "overrides");
        for (std::size_t i = 0; i < count; ++i) assignments.emplace_back(&need(overrides[i], "an override"));
        scene = new ls_scene(make_model(read_scene(&need(text, "text"), assignments)));
    });
    return scene;
}

void ls_scene_free(ls_scene *scene) { delete scene; }

void ls_scene_describe(const ls_scene *scene, ls_description *description) {
    if (!scene || !description) return;
    const Scene &s = scene->model.scene;
    *description = {s.title.c_str(), s.is_static ? 1 : 0, 0, s.duration, s.interval, scene->energy};
}

std::size_t ls_scene_count(const ls_scene *scene, std::int32_t list) {
    if (!scene) return 0;
    const System &system = scene->model.system;
    switch (list) {
    case LS_COORDINATE: return static_cast<std::size_t>(system.coordinates());
    case LS_CONSTRAINT: return static_cast<std::size_t>(system.constraints());
    case LS_JOINT: return system.joints().size();
    case LS_CHANNEL: return scene->channels.names().size();
    case LS_SELECTED: return scene->selected.size();
    case LS_REDUNDANT: return scene->model.redundant.size();
    case LS_STATE: return scene->state_names.size();
    case LS_NOTE: return scene->notes.size();
    default: return 0;
    }
}

const char *ls_scene_name(const ls_scene *scene, std::int32_t list, std::size_t index) {
    if (index >= ls_scene_count(scene, list)) return nullptr;
    const System &system = scene->model.system;
    switch (list) {
    case LS_COORDINATE: return system.coordinate_name(static_cast<int>(index)).c_str();
    case LS_CONSTRAINT: return system.row_name(static_cast<int>(index)).c_str();
    case LS_JOINT: return system.joints()[index].name.c_str();
    case LS_CHANNEL: return scene->channels.names()[index].c_str();
    case LS_SELECTED: return scene->channels.names()[scene->selected[index]].c_str();
    case LS_STATE: return scene->state_names[index].c_str();
    case LS_NOTE: return scene->notes[index].c_str();
    default: return scene->model.redundant[index].c_str();
    }
}

std::size_t ls_scene_selected(const ls_scene *scene, std::size_t index) {
    return scene && index < scene->selected.size() ? scene->selected[index] : 0;
}

std::int32_t ls_scene_start(const ls_scene *scene, double *q, double *v, ls_error *error) {
    return guarded(error, [&] {
        const Model &model = need(scene, "scene").model;
        output(model.q, q, "q");
        output(model.v, v, "v");
    });
}

std::int32_t ls_scene_start_contacts(const ls_scene *scene, double *z, ls_error *error) {
    return guarded(error, [&] { output(need(scene, "scene").model.memory.impact_velocity, z, "z"); });
}

std::int32_t ls_scene_rest(const ls_scene *scene, ls_rest *rest, ls_error *error) {
    return guarded(error, [&] {
        const Model &model = need(scene, "scene").model;
        require(model.rest.has_value(), "the scene does not start in equilibrium");
        need(rest, "rest") = described(*model.rest, model.system);
    });
}

std::int32_t ls_scene_set_states(ls_scene *scene, const double *states, ls_error *error) {
    return guarded(error, [&] {
        VectorXd &target = need(scene, "scene").memory.state;
        target = input(states, target.size(), "states");
    });
}

std::int32_t ls_scene_states(const ls_scene *scene, double *states, ls_error *error) {
    return guarded(error, [&] { output(need(scene, "scene").memory.state, states, "states"); });
}

std::int32_t ls_scene_state_rates(const ls_scene *scene, double t, const double *q, const double *v, const double *z,
                                  double *rates, double *by_q, double *by_v, double *by_states, ls_error *error) {
    return guarded(error, [&] {
        const GivenState state(need(scene, "scene"), t, q, v, z);
        const System &system = scene->model.system;
        VectorXd values;
        system.state_rates(state.q, state.v, state.memory, values);
        if (rates) output(values, rates, "rates");
        if (!by_q && !by_v && !by_states) return;
        StateDerivatives d;
        system.state_derivatives(state.q, state.v, state.memory, d);
        if (by_q) output(d.rate_by_q, system.states(), system.coordinates(), by_q, "by_q");
        if (by_v) output(d.rate_by_v, system.states(), system.coordinates(), by_v, "by_v");
        if (by_states) output(d.rate_by_state, system.states(), system.states(), by_states, "by_states");
    });
}

std::int32_t ls_scene_force_by_states(const ls_scene *scene, double t, const double *q, const double *v, const double *z,
                                      double *by_states, ls_error *error) {
    return guarded(error, [&] {
        const GivenState state(need(scene, "scene"), t, q, v, z);
        const System &system = scene->model.system;
        StateDerivatives d;
        system.state_derivatives(state.q, state.v, state.memory, d);
        output(d.force_by_state, system.coordinates(), system.states(), by_states, "by_states");
    });
}

std::int32_t ls_scene_mass(const ls_scene *scene, double *mass, ls_error *error) {
    return guarded(error, [&] { output(MatrixXd(need(scene, "scene").model.system.mass()), mass, "mass"); });
}

std::int32_t ls_scene_force(const ls_scene *scene, double t, const double *q, const double *v, const double *z,
                            double *force, double *by_q, double *by_v, ls_error *error) {
    return guarded(error, [&] {
        const GivenState state(need(scene, "scene"), t, q, v, z);
        const System &system = scene->model.system;
        const Inputs inputs = system.inputs(t);
        VectorXd f;
        system.force(inputs, state.q, state.v, state.memory, f);
        output(f, force, "force");
        if (!by_q && !by_v) return;
        Entries k, c;
        system.force_derivatives(inputs, state.q, state.v, state.memory, k, c);
        if (by_q) output(k, system.coordinates(), system.coordinates(), by_q, "by_q");
        if (by_v) output(c, system.coordinates(), system.coordinates(), by_v, "by_v");
    });
}

std::int32_t ls_scene_constraint_rows(const ls_scene *scene, double t, const double *q, double *phi, double *phi_q,
                                      double *phi_t, ls_error *error) {
    return guarded(error, [&] {
        const System &system = need(scene, "scene").model.system;
        require(std::isfinite(t), "t is not finite");
        VectorXd values, by_t;
        MatrixXd by_q;
        system.constraint_rows(system.inputs(t), input(q, system.coordinates(), "q"), values, by_q, by_t);
        output(values, phi, "phi");
        output(by_q, phi_q, "phi_q");
        output(by_t, phi_t, "phi_t");
    });
}

std::int32_t ls_scene_acceleration(const ls_scene *scene, double t, const double *q, const double *v, const double *z,
                                   double *a, double *lambda, ls_error *error) {
    return guarded(error, [&] {
        const GivenState state(need(scene, "scene"), t, q, v, z);
        Acceleration level(scene->model.system);
        level.solve(t, state.q, state.v, state.memory, true);
        output(level.a, a, "a");
        output(level.lambda, lambda, "lambda");
    });
}

std::int32_t ls_scene_channels(const ls_scene *scene, double t, const double *q, const double *v, const double *z,
                               double *values, ls_error *error) {
    return guarded(error, [&] {
        const GivenState state(need(scene, "scene"), t, q, v, z);
        const System &system = scene->model.system;
        Snapshot s;
        s.t = t;
        s.q = state.q;
        s.v = state.v;
        s.angles = continued(system, scene->angles, s.q);
        s.memory = state.memory;
        s.initial_energy = scene->energy;
        Acceleration level(system);
        level.solve(t, s.q, s.v, s.memory, true);
        s.a = level.a;
        s.lambda = level.lambda;
        s.inputs = level.inputs;
        scene->channels.evaluate(s, &need(values, "values"));
    });
}

ls_run *ls_run_new(const ls_scene *scene, const ls_tolerances *tolerances, ls_error *error) {
    return new_run(scene, 0.0, nullptr, nullptr, true, tolerances, error);
}

ls_run *ls_run_from(const ls_scene *scene, double t, const double *q, const double *v, const ls_tolerances *tolerances,
                    ls_error *error) {
    return new_run(scene, t, q, v, false, tolerances, error);
}

void ls_run_free(ls_run *run) { delete run; }

std::int32_t ls_run_advance(ls_run *run, double t, double *values, ls_error *error) {
    return guarded(error, [&] {
        ls_run &r = need(run, "run");
        double *target = &need(values, "values");
        if (r.dead) throw *r.dead;
        try {
            r.advance(t);
            r.channels().evaluate(r.snapshot(), target);
        } catch (const Failure &e) {
            r.dead = e;
            throw;
        } catch (const std::exception &e) {
            r.dead = Failure(LS_INTERNAL, e.what());
            throw;
        }
    });
}

std::int32_t ls_run_state(const ls_run *run, double *q, double *v, double *a, double *lambda, double *z,
                          ls_error *error) {
    return guarded(error, [&] {
        const Snapshot &s = need(run, "run").snapshot();
        auto put = [](const VectorXd &x, double *target) {
            if (target) std::copy(x.data(), x.data() + x.size(), target);
        };
        put(s.q, q);
        put(s.v, v);
        put(s.a, a);
        put(s.lambda, lambda);
        put(s.memory.impact_velocity, z);
    });
}

std::int32_t ls_run_states(const ls_run *run, double *states, ls_error *error) {
    return guarded(error, [&] { output(need(run, "run").snapshot().memory.state, states, "states"); });
}

std::size_t ls_run_event_count(const ls_run *run) { return run && run->dynamic ? run->dynamic->events().size() : 0; }

std::int32_t ls_run_event(const ls_run *run, std::size_t index, ls_event *event) {
    if (!event || index >= ls_run_event_count(run)) return LS_BAD_INPUT;
    *event = run->dynamic->events()[index];
    return LS_OK;
}

std::size_t ls_run_critical_count(const ls_run *run) {
    return run && run->equilibria ? run->equilibria->critical_points().size() : 0;
}

std::int32_t ls_run_critical_point(const ls_run *run, std::size_t index, ls_critical_point *point) {
    if (!point || index >= ls_run_critical_count(run)) return LS_BAD_INPUT;
    const CriticalPoint &c = run->equilibria->critical_points()[index];
    *point = {c.t, c.t / run->equilibria->full_load(), c.limit ? 1 : 0, c.coordinate};
    return LS_OK;
}

std::int32_t ls_run_rest(const ls_run *run, ls_rest *rest, ls_error *error) {
    return guarded(error, [&] {
        const StaticRun &equilibria = static_run(run);
        need(rest, "rest") = described(equilibria.stability(), equilibria.system());
    });
}

std::size_t ls_run_unstable_count(const ls_run *run) {
    return run && run->equilibria ? run->equilibria->unstable().size() : 0;
}

std::int32_t ls_run_unstable(const ls_run *run, std::size_t index, double *values, ls_error *error) {
    return guarded(error, [&] {
        const StaticRun &equilibria = static_run(run);
        require(index < equilibria.unstable().size(), "there is no such step");
        equilibria.channels().evaluate(equilibria.unstable()[index], &need(values, "values"));
    });
}

void ls_run_statistics(const ls_run *run, ls_statistics *statistics) {
    if (!run || !statistics) return;
    *statistics = run->dynamic ? run->dynamic->statistics() : ls_statistics{run->equilibria->steps(), 0, 0, 0, 0, 0, 0};
}

const char *ls_sundials_version(void) {
    try {
        return ida::linked_version();
    } catch (...) {
        return "unknown";
    }
}

// The C functions: checks of pointers, exceptions to error codes, vectors to arrays.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <new>
#include <optional>

#include "contact.hpp"
#include "element.hpp"
#include "failure.hpp"
#include "reference.h"
#include "run.hpp"
#include "sundials.hpp"
#include "system.hpp"

struct ls_system {
    System system;
};

struct ls_run {
    Run run;
    std::optional<Failure> dead;
};

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

void fill(ls_error *error, int code, int flag, double time, const char *message) {
    if (!error) return;
    error->code = code;
    error->flag = flag;
    error->time = time;
    std::snprintf(error->message, sizeof error->message, "%s", message);
}

template <class Work>
std::int32_t guarded(ls_error *error, Work work) noexcept {
    fill(error, LS_OK, 0, 0.0, "");
    try {
        work();
        return LS_OK;
    } catch (const Failure &e) {
        fill(error, e.code, e.flag, e.time, e.what());
        return e.code;
    } catch (const std::bad_alloc &) {
        fill(error, LS_INTERNAL, 0, 0.0, "out of memory");
    } catch (const std::exception &e) {
        fill(error, LS_INTERNAL, 0, 0.0, e.what());
    } catch (...) {
        fill(error, LS_INTERNAL, 0, 0.0, "unknown exception");
    }
    return LS_INTERNAL;
}

template <class P>
P &need(P *pointer, const char *name) {
    if (!pointer) throw Failure(LS_BAD_INPUT, std::string(name) + " is null");
    return *pointer;
}

VectorXd input(const double *x, int size, const char *name) {
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

void require_positive(double x, const char *name) {
    require(std::isfinite(x) && x > 0.0, std::string(name) + " must be positive");
}

} // namespace

const char *ls_sundials_version(void) {
    try {
        return ida::linked_version();
    } catch (...) {
        return "unknown";
    }
}

std::int32_t ls_element_mass(double mass, double length, double *matrix, ls_error *error) {
    return guarded(error, [&] {
        require_positive(mass, "mass");
        require_positive(length, "length");
        output(MatrixXd(element_mass(mass, length)), matrix, "matrix");
    });
}

std::int32_t ls_element_elastic(double axial_stiffness, double bending_stiffness, double length, const double *q,
                                double *energy, double *force, double *tangent, ls_error *error) {
    return guarded(error, [&] {
        require(std::isfinite(axial_stiffness) && axial_stiffness >= 0.0, "axial_stiffness must not be negative");
        require(std::isfinite(bending_stiffness) && bending_stiffness >= 0.0, "bending_stiffness must not be negative");
        require_positive(length, "length");
        const CableElement element{axial_stiffness, bending_stiffness, length};
        const VectorXd u = input(q, 8, "q");
        if (energy) {
            const ElasticEnergy e = element_energy(element, u.data());
            energy[0] = e.axial;
            energy[1] = e.bending;
        }
        if (force) output(VectorXd(element_force(element, u.data())), force, "force");
        if (tangent) output(MatrixXd(element_tangent(element, u.data())), tangent, "tangent");
    });
}

std::int32_t ls_contact_stiffness(const ls_contact *contact, double *stiffness, ls_error *error) {
    return guarded(error, [&] {
        need(stiffness, "stiffness") = make_contact_law(need(contact, "contact"), "contact").stiffness;
    });
}

std::int32_t ls_contact_normal(const ls_contact *contact, double delta, double rate, double impact_velocity,
                               double *force, double *by_delta, double *by_rate, std::int32_t *clamped,
                               ls_error *error) {
    return guarded(error, [&] {
        const ContactLaw law = make_contact_law(need(contact, "contact"), "contact");
        require(std::isfinite(delta) && std::isfinite(rate), "delta and rate must be finite");
        require_positive(impact_velocity, "impact_velocity");
        Dual<double, 2> d(delta), r(rate), f;
        d.slope[0] = 1.0;
        r.slope[1] = 1.0;
        if (delta > 0.0) f = normal_force(law, d, r, impact_velocity);
        if (force) *force = f.value;
        if (by_delta) *by_delta = f.slope[0];
        if (by_rate) *by_rate = f.slope[1];
        if (clamped) *clamped = delta > 0.0 && bracket(law, rate, impact_velocity) < 0.0;
    });
}

std::int32_t ls_contact_friction(const ls_contact *contact, double slip, double normal, double *force, double *by_slip,
                                 double *by_normal, ls_error *error) {
    return guarded(error, [&] {
        const ContactLaw law = make_contact_law(need(contact, "contact"), "contact");
        require(std::isfinite(slip) && std::isfinite(normal), "slip and normal must be finite");
        Dual<double, 2> s(slip), n(normal), f;
        s.slope[0] = 1.0;
        n.slope[1] = 1.0;
        if (law.friction) f = -friction_resistance(law, s, n);
        if (force) *force = f.value;
        if (by_slip) *by_slip = f.slope[0];
        if (by_normal) *by_normal = f.slope[1];
    });
}

ls_system *ls_system_new(const ls_mechanism *mechanism, ls_error *error) {
    std::unique_ptr<ls_system> system;
    guarded(error, [&] { system.reset(new ls_system{System(need(mechanism, "mechanism"))}); });
    return system.release();
}

void ls_system_free(ls_system *system) { delete system; }

std::int32_t ls_system_coordinates(const ls_system *s) { return s ? s->system.coordinates() : 0; }
std::int32_t ls_system_constraints(const ls_system *s) { return s ? s->system.constraints() : 0; }

std::int32_t ls_system_cranks(const ls_system *system, double t, double *angles, ls_error *error) {
    return guarded(error, [&] {
        double *out = angles;
        for (const Prescribed &c : need(system, "system").system.crank_angles(t)) {
            need(angles, "angles");
            *out++ = c.value;
            *out++ = c.rate;
            *out++ = c.acceleration;
        }
    });
}

std::int32_t ls_system_start(const ls_system *system, double t, double *q, double *v, ls_error *error) {
    return guarded(error, [&] {
        VectorXd qs, vs;
        need(system, "system").system.start(t, qs, vs);
        output(qs, q, "q");
        output(vs, v, "v");
    });
}

std::int32_t ls_system_mass(const ls_system *system, const double *q, double *mass, ls_error *error) {
    return guarded(error, [&] {
        const System &s = need(system, "system").system;
        input(q, s.coordinates(), "q"); // M does not depend on it, but a caller's mistake should not pass
        output(s.mass(), mass, "mass");
    });
}

std::int32_t ls_system_force(const ls_system *system, double t, const double *q, const double *v, const double *z,
                             double *force, double *by_q, double *by_v, ls_error *error) {
    return guarded(error, [&] {
        const System &s = need(system, "system").system;
        const VectorXd qs = input(q, s.coordinates(), "q"), vs = input(v, s.coordinates(), "v"),
                       zs = input(z, s.joints(), "z");
        require(std::isfinite(t), "t is not finite");
        const std::vector<Prescribed> functions = s.functions(t);
        VectorXd f;
        s.force(functions, qs, vs, zs, f);
        output(f, force, "force");
        if (!by_q && !by_v) return;
        MatrixXd k, c;
        s.force_derivatives(functions, qs, vs, zs, k, c);
        if (by_q) output(k, by_q, "by_q");
        if (by_v) output(c, by_v, "by_v");
    });
}

std::int32_t ls_system_constraint_rows(const ls_system *system, double t, const double *q, double *phi, double *phi_q,
                                       double *phi_t, ls_error *error) {
    return guarded(error, [&] {
        const System &s = need(system, "system").system;
        require(std::isfinite(t), "t is not finite");
        VectorXd values, by_t;
        MatrixXd by_q;
        s.constraint_rows(s.inputs(t), input(q, s.coordinates(), "q"), values, by_q, by_t);
        output(values, phi, "phi");
        output(by_q, phi_q, "phi_q");
        output(by_t, phi_t, "phi_t");
    });
}

ls_run *ls_run_new(const ls_system *system, double t, const double *q, const double *v, const ls_tolerances *tolerances,
                   ls_error *error) {
    std::unique_ptr<ls_run> run;
    guarded(error, [&] {
        const System &s = need(system, "system").system;
        run.reset(new ls_run{Run(s, t, input(q, s.coordinates(), "q"), input(v, s.coordinates(), "v"),
                                 need(tolerances, "tolerances")),
                             std::nullopt});
    });
    return run.release();
}

void ls_run_free(ls_run *run) { delete run; }

std::int32_t ls_run_advance(ls_run *run, double t, ls_row *row, ls_error *error) {
    return guarded(error, [&] {
        ls_run &r = need(run, "run");
        ls_row &target = need(row, "row");
        if (r.dead) throw *r.dead;
        try {
            r.run.advance(t, target);
        } catch (const Failure &e) {
            r.dead = e;
            throw;
        } catch (const std::exception &e) {
            r.dead = Failure(LS_INTERNAL, e.what());
            throw;
        }
    });
}

std::int64_t ls_run_event_count(const ls_run *run) {
    return run ? static_cast<std::int64_t>(run->run.events().size()) : 0;
}

std::int32_t ls_run_event(const ls_run *run, std::int64_t index, ls_event *event) {
    if (!run || !event || index < 0 || index >= ls_run_event_count(run)) return LS_BAD_INPUT;
    *event = run->run.events()[static_cast<std::size_t>(index)];
    return LS_OK;
}

void ls_run_statistics(const ls_run *run, ls_statistics *statistics) {
    if (!run || !statistics) return;
    *statistics = run->run.statistics();
}

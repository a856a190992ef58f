#include "integrate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <stdexcept>
#include <vector>

#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "../../reference-cpp/src/sundials.hpp"

namespace {

// The equations, the tolerances of a run, and what solves for the condensed unknowns.
struct Problem {
    const li_equations &equations;
    const li_run &run;
    SUNLinearSolver condensed_solver = nullptr;
    N_Vector b = nullptr, x = nullptr;
};

Problem &problem(void *data) { return *static_cast<Problem *>(data); }

li_vector all(N_Vector v) { return {N_VGetArrayPointer(v), N_VGetLength(v)}; }

int residual(double t, N_Vector y, N_Vector yp, N_Vector r, void *data) {
    const li_equations &e = problem(data).equations;
    return e.residual(e.data, t, all(y), all(yp), all(r));
}

int jacobian(double t, double c, N_Vector y, N_Vector yp, N_Vector, SUNMatrix matrix, void *data, N_Vector, N_Vector,
             N_Vector) {
    const li_equations &e = problem(data).equations;
    const int64_t size = e.unknowns + e.multipliers;
    if (SUNMatGetID(matrix) == SUNMATRIX_SPARSE) {
        std::copy(e.columns, e.columns + size + 1, SM_INDEXPTRS_S(matrix));
        std::copy(e.rows, e.rows + e.columns[size], SM_INDEXVALS_S(matrix));
        return e.jacobian(e.data, t, c, all(y), all(yp), {SM_DATA_S(matrix), e.columns[size]});
    }
    std::vector<double> entries(e.columns[size]);
    const int flag = e.jacobian(e.data, t, c, all(y), all(yp), {entries.data(), e.columns[size]});
    for (int64_t column = 0; column < size; ++column)
        for (int64_t k = e.columns[column]; k < e.columns[column + 1]; ++k)
            SM_ELEMENT_D(matrix, e.rows[k], column) = entries[k];
    return flag;
}

int gaps(double t, N_Vector y, N_Vector, double *values, void *data) {
    const li_equations &e = problem(data).equations;
    return e.gaps(e.data, t, all(y), {values, e.contacts});
}

// Multipliers have no weight: neither the error test nor Newton's convergence test looks at them.
int weights(N_Vector y, N_Vector w, void *data) {
    const li_run &run = problem(data).run;
    const int n = problem(data).equations.unknowns, m = problem(data).equations.multipliers;
    const double *at = N_VGetArrayPointer(y);
    double *weight = N_VGetArrayPointer(w);
    for (int i = 0; i < 2 * n; ++i)
        weight[i] = 1.0 / (run.relative * std::abs(at[i]) + (i < n ? run.position : run.velocity));
    std::fill(weight + 2 * n, weight + 2 * n + m, 0.0);
    return 0;
}

SUNLinearSolver_Type solver_type(SUNLinearSolver) { return SUNLINEARSOLVER_DIRECT; }

int initialize(SUNLinearSolver solver) { return SUNLinSolInitialize(problem(solver->content).condensed_solver); }

int factorise(SUNLinearSolver solver, SUNMatrix matrix) {
    return SUNLinSolSetup(problem(solver->content).condensed_solver, matrix);
}

int solve(SUNLinearSolver solver, SUNMatrix matrix, N_Vector x, N_Vector b, double tolerance) {
    const Problem &p = problem(solver->content);
    const li_equations &e = p.equations;
    e.condense(e.data, all(b), all(p.b));
    const int flag = SUNLinSolSolve(p.condensed_solver, matrix, p.x, p.b, tolerance);
    e.expand(e.data, all(b), all(p.x), all(x));
    return flag;
}

void check(int flag, const char *call) {
    if (flag < 0) throw std::runtime_error(std::string(call) + ": flag " + std::to_string(flag));
}

// False where it takes too long.
bool integrate(const li_equations &e, const li_run &run, double *start, double *slope, li_counts &counts) {
    const std::clock_t began = std::clock();
    const int condensed = e.unknowns + e.multipliers, size = e.unknowns + condensed;
    ida::ErrorText errors;
    ida::Context context(&errors);
    const ida::Vector y(N_VMake_Serial(size, start, context)), yp(N_VMake_Serial(size, slope, context));
    const ida::Integrator integrator(context);
    check(ida::route_errors(integrator, &errors), "IDASetErrHandlerFn");
    check(IDAInit(integrator, residual, 0.0, y.get(), yp.get()), "IDAInit");
    Problem problem{e, run};
    check(IDASetUserData(integrator, &problem), "IDASetUserData");
    check(IDAWFtolerances(integrator, weights), "IDAWFtolerances");
    check(IDASetMaxOrd(integrator, run.max_order), "IDASetMaxOrd");
    check(IDASetNonlinConvCoef(integrator, run.newton), "IDASetNonlinConvCoef");
    check(IDASetMaxNumSteps(integrator, 10000000), "IDASetMaxNumSteps");
    const ida::Vector b(N_VNew_Serial(condensed, context)), x(N_VNew_Serial(condensed, context));
    const ida::Matrix matrix(run.dense ? SUNDenseMatrix(condensed, condensed, context)
                                       : SUNSparseMatrix(condensed, condensed, e.columns[condensed], CSC_MAT, context));
    const ida::LinearSolver inner(run.dense ? SUNLinSol_Dense(x.get(), matrix.get(), context)
                                            : SUNLinSol_KLU(x.get(), matrix.get(), context));
    problem.condensed_solver = inner.get(), problem.b = b.get(), problem.x = x.get();
    const ida::LinearSolver solver(SUNLinSolNewEmpty(context));
    solver->ops->gettype = solver_type;
    solver->ops->initialize = initialize;
    solver->ops->setup = factorise;
    solver->ops->solve = solve;
    solver->content = &problem;
    check(IDASetLinearSolver(integrator, solver.get(), matrix.get()), "IDASetLinearSolver");
    check(IDASetJacFn(integrator, jacobian), "IDASetJacFn");
    if (e.contacts > 0) {
        check(IDARootInit(integrator, e.contacts, gaps), "IDARootInit");
        check(IDASetNoInactiveRootWarn(integrator), "IDASetNoInactiveRootWarn");
    }
    e.row(e.data, all(y.get()));
    const auto count = [&] {
        long steps = 0, residuals = 0, jacobians = 0;
        IDAGetNumSteps(integrator, &steps);
        IDAGetNumResEvals(integrator, &residuals);
        IDAGetNumJacEvals(integrator, &jacobians);
        counts.steps += steps, counts.residuals += residuals, counts.jacobians += jacobians;
    };
    const long rows = static_cast<long>(run.duration / run.interval + 0.5);
    for (long row = 1; row <= rows;) {
        if (static_cast<double>(std::clock() - began) > run.longest * CLOCKS_PER_SEC) return false;
        double t = 0.0;
        const int flag = IDASolve(integrator, row * run.interval, &t, y.get(), yp.get(), IDA_NORMAL);
        if (flag < 0 && !errors.text.empty()) throw std::runtime_error(errors.text);
        check(flag, "IDASolve");
        if (flag == IDA_ROOT_RETURN) {
            count();
            ++counts.changes;
            if (e.change(e.data, t, all(y.get()), all(yp.get())) != 0) throw std::runtime_error("a contact cannot change");
            check(IDAReInit(integrator, t, y.get(), yp.get()), "IDAReInit");
            continue;
        }
        e.row(e.data, all(y.get()));
        ++row;
    }
    count();
    return true;
}

} // namespace

int32_t li_integrate(const li_equations *equations, const li_run *run, double *y, double *yp, li_counts *counts,
                     char *message, int32_t length) {
    try {
        *counts = li_counts{};
        return integrate(*equations, *run, y, yp, *counts) ? 0 : 1;
    } catch (const std::exception &e) {
        std::snprintf(message, static_cast<std::size_t>(length), "%s", e.what());
        return -1;
    }
}

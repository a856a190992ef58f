#include "integrate.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "../../reference-cpp/src/sundials.hpp"

namespace {

const li_equations &equations(void *data) { return *static_cast<const li_equations *>(data); }

int residual(double t, N_Vector y, N_Vector yp, N_Vector r, void *data) {
    const li_equations &e = equations(data);
    return e.residual(e.data, t, N_VGetArrayPointer(y), N_VGetArrayPointer(yp), N_VGetArrayPointer(r));
}

int jacobian(double t, double c, N_Vector y, N_Vector yp, N_Vector, SUNMatrix matrix, void *data, N_Vector, N_Vector,
             N_Vector) {
    const li_equations &e = equations(data);
    const int64_t size = SM_COLUMNS_S(matrix);
    std::copy(e.columns, e.columns + size + 1, SM_INDEXPTRS_S(matrix));
    std::copy(e.rows, e.rows + e.columns[size], SM_INDEXVALS_S(matrix));
    return e.jacobian(e.data, t, c, N_VGetArrayPointer(y), N_VGetArrayPointer(yp), SM_DATA_S(matrix));
}

int gaps(double t, N_Vector y, N_Vector, double *values, void *data) {
    const li_equations &e = equations(data);
    return e.gaps(e.data, t, N_VGetArrayPointer(y), values);
}

void check(int flag, const char *call) {
    if (flag < 0) throw std::runtime_error(std::string(call) + ": flag " + std::to_string(flag));
}

void integrate(const li_equations &e, const li_run &run, double *start, double *slope, li_counts &counts) {
    const int n = e.unknowns, size = 2 * n + e.multipliers;
    ida::ErrorText errors;
    ida::Context context(&errors);
    const ida::Vector y(N_VMake_Serial(size, start, context)), yp(N_VMake_Serial(size, slope, context));
    const ida::Vector tolerances(N_VNew_Serial(size, context)), kinds(N_VNew_Serial(size, context));
    for (int i = 0; i < size; ++i) {
        N_VGetArrayPointer(tolerances.get())[i] = i < n ? run.position : run.velocity;
        N_VGetArrayPointer(kinds.get())[i] = i < 2 * n ? 1.0 : 0.0;
    }
    const ida::Integrator integrator(context);
    check(ida::route_errors(integrator, &errors), "IDASetErrHandlerFn");
    check(IDAInit(integrator, residual, 0.0, y.get(), yp.get()), "IDAInit");
    check(IDASetUserData(integrator, const_cast<li_equations *>(&e)), "IDASetUserData");
    check(IDASVtolerances(integrator, 0.0, tolerances.get()), "IDASVtolerances");
    check(IDASetId(integrator, kinds.get()), "IDASetId");
    check(IDASetSuppressAlg(integrator, SUNTRUE), "IDASetSuppressAlg");
    check(IDASetMaxNumSteps(integrator, 10000000), "IDASetMaxNumSteps");
    const ida::Matrix matrix(SUNSparseMatrix(size, size, e.columns[size], CSC_MAT, context));
    const ida::LinearSolver solver(SUNLinSol_KLU(y.get(), matrix.get(), context));
    check(IDASetLinearSolver(integrator, solver.get(), matrix.get()), "IDASetLinearSolver");
    check(IDASetJacFn(integrator, jacobian), "IDASetJacFn");
    if (e.contacts > 0) {
        check(IDARootInit(integrator, e.contacts, gaps), "IDARootInit");
        check(IDASetNoInactiveRootWarn(integrator), "IDASetNoInactiveRootWarn");
    }
    e.row(e.data, 0.0, start);
    const auto count = [&] {
        long steps = 0, residuals = 0, jacobians = 0;
        IDAGetNumSteps(integrator, &steps);
        IDAGetNumResEvals(integrator, &residuals);
        IDAGetNumJacEvals(integrator, &jacobians);
        counts.steps += steps, counts.residuals += residuals, counts.jacobians += jacobians;
    };
    const long rows = static_cast<long>(run.duration / run.interval + 0.5);
    for (long row = 1; row <= rows;) {
        double t = 0.0;
        const int flag = IDASolve(integrator, row * run.interval, &t, y.get(), yp.get(), IDA_NORMAL);
        if (flag < 0 && !errors.text.empty()) throw std::runtime_error(errors.text);
        check(flag, "IDASolve");
        if (flag == IDA_ROOT_RETURN) {
            count();
            ++counts.changes;
            if (e.change(e.data, t, start, slope) != 0) throw std::runtime_error("a contact cannot change");
            check(IDAReInit(integrator, t, y.get(), yp.get()), "IDAReInit");
            continue;
        }
        e.row(e.data, t, start);
        ++row;
    }
    count();
}

} // namespace

int32_t li_integrate(const li_equations *equations, const li_run *run, double *y, double *yp, li_counts *counts,
                     char *message, int32_t length) {
    try {
        *counts = li_counts{};
        integrate(*equations, *run, y, yp, *counts);
        return 0;
    } catch (const std::exception &e) {
        std::snprintf(message, static_cast<std::size_t>(length), "%s", e.what());
        return -1;
    }
}

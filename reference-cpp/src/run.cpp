// A run and its connection to IDA: set-up and callbacks.
#include "run.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>

#include "run_vectors.hpp"

namespace {

// Constraints make Newton's method slow with the matrix of another step length; IDA would tolerate more.
constexpr double refresh_threshold = 0.1;

SUNLinearSolver_Type solver_type(SUNLinearSolver) { return SUNLINEARSOLVER_DIRECT; }
SUNLinearSolver_ID solver_id(SUNLinearSolver) { return SUNLINEARSOLVER_CUSTOM; }
int solver_ready(SUNLinearSolver) { return 0; }
int solver_set_up(SUNLinearSolver, SUNMatrix) { return 0; } // the matrix arrives factorised from `jacobian`
SUNMatrix_ID matrix_id(SUNMatrix) { return SUNMATRIX_CUSTOM; }
int matrix_zero(SUNMatrix) { return 0; }

template <class Handle>
Handle allocated(Handle handle) {
    if (!handle) throw std::bad_alloc();
    return handle;
}

} // namespace

Run::Run(const Model &model, double t, const VectorXd &q, const VectorXd &v, const Memory &memory,
         const ls_tolerances &tolerances)
    : model_(model), system_(model_.system), channels_(model_), tolerances_(tolerances), n_(system_.coordinates()),
      m_(system_.constraints()), x_(system_.states()), before_(t), t_(t), target_(t), q_(q), v_(v), memory_(memory),
      angles_(continued(system_, starting_angles(model_), q)), watch_before_(system_.loose_joints().size()),
      clamped_(system_.loose_joints().size(), 0), deepest_(system_.loose_joints().size(), 0.0),
      acceleration_(system_), newton_(system_), inputs_time_(std::numeric_limits<double>::quiet_NaN()),
      context_(&errors_), y_(allocated(N_VNew_Serial(unknowns(), context_))), yp_(allocated(N_VClone(y_.get()))),
      scratch_(allocated(N_VClone(y_.get()))), ida_(context_) {
    constexpr double consistent = 1e-6;
    if (!q.allFinite() || !v.allFinite()) throw Failure(LS_NOT_FINITE, "the initial state is not finite", t);
    acceleration_.project(t, q_, v_, consistent);
    system_.check_angles(acceleration_.inputs, q_);
    memory_.turn = spring_turns(system_, angles_);
    initial_energy_ = system_.energies(q_, v_, memory_).total();
    for (std::size_t i = 0; i < deepest_.size(); ++i) {
        const int k = system_.loose_joints()[i];
        if (closed(k)) deepest_[i] = system_.gap(k, q_.data(), v_.data()).delta();
    }
    set_up(tolerances);
}

void Run::set_up(const ls_tolerances &tol) {
    require(std::isfinite(tol.relative) && tol.relative >= 0.0, "tolerances: relative must not be negative");
    require(std::isfinite(tol.position) && tol.position > 0.0, "tolerances: position must be positive");
    require(std::isfinite(tol.velocity) && tol.velocity > 0.0, "tolerances: velocity must be positive");
    require(std::isfinite(tol.max_step) && tol.max_step >= 0.0, "tolerances: max_step must not be negative");
    require(std::isfinite(tol.newton) && tol.newton > 0.0, "tolerances: newton must be positive");
    require(tol.max_order >= 1 && tol.max_order <= 5, "tolerances: max_order must be 1 to 5");
    require(tol.max_steps > 0, "tolerances: max_steps must be positive");

    require(tol.linear_solver == LS_DENSE || tol.linear_solver == LS_SPARSE, "tolerances: unknown linear_solver");

    N_VConst(0.0, y_.get());
    N_VConst(0.0, yp_.get());
    check(ida::route_errors(ida_, &errors_));
    check(IDAInit(ida_, residual, t_, y_.get(), yp_.get()));
    check(IDASetUserData(ida_, this));
    check(IDAWFtolerances(ida_, weights));
    if (tol.linear_solver == LS_SPARSE)
        set_up_sparse();
    else
        set_up_dense();
    check(IDASetLinearSolver(ida_, solver_.get(), matrix_.get()));
    check(IDASetJacFn(ida_, jacobian));
    check(IDASetMaxOrd(ida_, tol.max_order));
    if (tol.max_step > 0.0) check(IDASetMaxStep(ida_, tol.max_step));
    check(IDASetNonlinConvCoef(ida_, tol.newton));
    check(ida::set_refresh_threshold(ida_, refresh_threshold));
    if (!system_.loose_joints().empty()) {
        check(IDARootInit(ida_, static_cast<int>(system_.loose_joints().size()), roots));
        check(IDASetNoInactiveRootWarn(ida_));
    }
}

// A matrix that IDA only hands through, and a solver that uses `newton_`.
void Run::set_up_dense() {
    matrix_.reset(allocated(SUNMatNewEmpty(context_)));
    matrix_->ops->getid = matrix_id;
    matrix_->ops->zero = matrix_zero;
    solver_.reset(allocated(SUNLinSolNewEmpty(context_)));
    solver_->ops->gettype = solver_type;
    solver_->ops->getid = solver_id;
    solver_->ops->initialize = solver_ready;
    solver_->ops->setup = solver_set_up;
    solver_->ops->solve = solve_linear;
    solver_->content = this;
}

void Run::set_up_sparse() {
    const int size = unknowns();
    const VectorXd lambda = VectorXd::Zero(m_);
    const auto entries = newton_matrix(system_, 1.0, inputs(t_), q_, v_, memory_, lambda).nonZeros();
    matrix_.reset(allocated(SUNSparseMatrix(size, size, entries, CSC_MAT, context_)));
    solver_.reset(allocated(SUNLinSol_KLU(y_.get(), matrix_.get(), context_)));
}

void Run::fill_sparse(const SparseMatrix &matrix) {
    SUNMatrix target = matrix_.get();
    if (SM_NNZ_S(target) < matrix.nonZeros()) check(SUNSparseMatrix_Reallocate(target, matrix.nonZeros()));
    std::copy(matrix.outerIndexPtr(), matrix.outerIndexPtr() + matrix.outerSize() + 1, SM_INDEXPTRS_S(target));
    std::copy(matrix.innerIndexPtr(), matrix.innerIndexPtr() + matrix.nonZeros(), SM_INDEXVALS_S(target));
    std::copy(matrix.valuePtr(), matrix.valuePtr() + matrix.nonZeros(), SM_DATA_S(target));
}

// Throws for a failure of IDA, preferring what went wrong in a callback to IDA's report that a callback failed.
void Run::check(int flag) {
    if (flag >= 0) return;
    if (failure_) throw *failure_;
    const std::unique_ptr<char, decltype(&std::free)> name(IDAGetReturnFlagName(flag), &std::free);
    throw Failure(LS_IDA, errors_.text.empty() ? name.get() : errors_.text, t_, flag);
}

// No exception may pass through IDA. Positive: IDA tries a smaller step; negative: it gives up.
template <class Work>
int Run::guarded(Work work) {
    try {
        work();
        return 0;
    } catch (const Failure &e) {
        failure_ = e;
        // IDA steps past the time asked for: out of reach there, a smaller step may still do
        const bool beyond = e.code == LS_UNREACHABLE && e.time > target_;
        return e.code == LS_NOT_FINITE || beyond ? 1 : -1;
    } catch (const std::exception &e) {
        failure_ = Failure(LS_INTERNAL, e.what(), t_);
        return -1;
    }
}

const Inputs &Run::inputs(double t) {
    if (t != inputs_time_) {
        inputs_ = system_.inputs(t);
        inputs_time_ = t;
    }
    return inputs_;
}

const Memory &Run::memory_at(const double *y) {
    if (x_ == 0) return memory_;
    memory_at_ = memory_;
    memory_at_.state = part(y, 2 * (n_ + m_), x_);
    return memory_at_;
}

int Run::residual(double t, N_Vector yy, N_Vector yyp, N_Vector rr, void *user) {
    Run &run = *static_cast<Run *>(user);
    return run.guarded([&] {
        const int n = run.n_, m = run.m_;
        const double *y = N_VGetArrayPointer(yy), *yp = N_VGetArrayPointer(yyp);
        double *r = N_VGetArrayPointer(rr);
        run.qs_ = part(y, 0, n);
        run.vs_ = part(y, n, n);
        const auto lambda = part(y, 2 * n, m), mu = part(y, 2 * n + m, m);
        const System &s = run.system_;
        const Inputs &inputs = run.inputs(t);
        s.constraint_rows(inputs, run.qs_, run.phi_, run.phi_q_, run.phi_t_);
        const Memory &memory = run.memory_at(y);
        s.force(inputs, run.qs_, run.vs_, memory, run.f_);
        auto r1 = part(r, 0, n), r2 = part(r, n, n);
        r1.noalias() = s.mass() * (part(yp, 0, n) - run.vs_);
        r1.noalias() += run.phi_q_.transpose() * mu;
        r2.noalias() = s.mass() * part(yp, n, n);
        r2 += run.f_;
        r2.noalias() += run.phi_q_.transpose() * lambda;
        part(r, 2 * n, m) = run.phi_;
        part(r, 2 * n + m, m) = run.phi_t_ + run.phi_q_ * run.vs_;
        VectorXd rates;
        s.state_rates(run.qs_, run.vs_, memory, rates);
        part(r, 2 * (n + m), run.x_) = part(yp, 2 * (n + m), run.x_) - rates;
        if (!part(r, 0, run.unknowns()).allFinite())
            throw Failure(LS_NOT_FINITE, "the residual of the equations of motion is not finite", t);
    });
}

int Run::jacobian(double t, double c, N_Vector yy, N_Vector, N_Vector, SUNMatrix, void *user, N_Vector, N_Vector,
                  N_Vector) {
    Run &run = *static_cast<Run *>(user);
    return run.guarded([&] {
        const double *y = N_VGetArrayPointer(yy);
        const VectorXd q = part(y, 0, run.n_), v = part(y, run.n_, run.n_), lambda = part(y, 2 * run.n_, run.m_);
        const Memory &memory = run.memory_at(y);
        if (run.tolerances_.linear_solver == LS_SPARSE)
            run.fill_sparse(newton_matrix(run.system_, c, run.inputs(t), q, v, memory, lambda));
        else
            run.newton_.assemble(c, run.inputs(t), q, v, memory, lambda);
    });
}

int Run::solve_linear(SUNLinearSolver solver, SUNMatrix, N_Vector x, N_Vector b, double) {
    Run &run = *static_cast<Run *>(solver->content);
    return run.guarded([&] {
        const int size = run.unknowns();
        run.newton_.solve(part(static_cast<const double *>(N_VGetArrayPointer(b)), 0, size),
                          part(N_VGetArrayPointer(x), 0, size));
    });
}

// Multipliers have no weight: neither the error test nor Newton's convergence test looks at them.
int Run::weights(N_Vector yy, N_Vector ww, void *user) {
    const Run &run = *static_cast<Run *>(user);
    const double *y = N_VGetArrayPointer(yy);
    double *w = N_VGetArrayPointer(ww);
    const VectorXd &levers = run.system_.levers();
    const ls_tolerances &tol = run.tolerances_;
    for (int i = 0; i < run.n_; ++i) {
        w[i] = 1.0 / (tol.relative * std::abs(y[i]) + tol.position / levers[i]);
        w[run.n_ + i] = 1.0 / (tol.relative * std::abs(y[run.n_ + i]) + tol.velocity / levers[i]);
    }
    const int x = 2 * (run.n_ + run.m_);
    std::fill(w + 2 * run.n_, w + x, 0.0);
    for (int i = x; i < run.unknowns(); ++i) w[i] = 1.0 / (tol.relative * std::abs(y[i]) + tol.position);
    return 0;
}

// The gap of each loose joint: contact closes and opens where it vanishes.
int Run::roots(double, N_Vector yy, N_Vector, double *g, void *user) {
    const Run &run = *static_cast<Run *>(user);
    const double *y = N_VGetArrayPointer(yy);
    for (int k : run.system_.loose_joints()) *g++ = run.watch(k, y).gap;
    return 0;
}

Run::Watch Run::watch(int joint, const double *y) const {
    const Gap g = system_.gap(joint, y, y + n_);
    const double c = g.clearance;
    return {(dot(g.e, g.e) - c * c) / (2.0 * c), dot(g.e, g.e_dot) / c};
}

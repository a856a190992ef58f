// Everything that differs between SUNDIALS 6 and 7, and owners for its objects.
#pragma once

#include <cstring>
#include <ida/ida.h>
#include <ida/ida_ls.h>
#include <memory>
#include <new>
#include <nvector/nvector_serial.h>
#include <string>
#include <sundials/sundials_config.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_types.h>
#include <sundials/sundials_version.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>

namespace ida {

// Receives the text of errors; SUNDIALS must print nothing by itself.
struct ErrorText {
    std::string text;
};

#if SUNDIALS_VERSION_MAJOR >= 7

inline void on_error(int, const char *function, const char *, const char *message, SUNErrCode code, void *data,
                     SUNContext) noexcept {
    try {
        static_cast<ErrorText *>(data)->text =
            std::string(function ? function : "SUNDIALS") + ": " + (message ? message : SUNGetErrMsg(code));
    } catch (...) { // out of memory: the return value of the failing call still tells
    }
}

inline bool create_context(SUNContext *context, ErrorText *errors) {
    if (SUNContext_Create(SUN_COMM_NULL, context) != 0) return false;
    // warnings go to the logger: without one they are dropped
    return SUNContext_SetLogger(*context, nullptr) == 0 && SUNContext_ClearErrHandlers(*context) == 0 &&
           SUNContext_PushErrHandler(*context, on_error, errors) == 0;
}

inline int route_errors(void *, ErrorText *) { return 0; } // done by the context

#else

inline void on_error(int code, const char *, const char *function, char *message, void *data) noexcept {
    if (code == IDA_WARNING) return;
    try {
        static_cast<ErrorText *>(data)->text = std::string(function) + ": " + message;
    } catch (...) {
    }
}

inline bool create_context(SUNContext *context, ErrorText *) { return SUNContext_Create(nullptr, context) == 0; }

inline int route_errors(void *ida, ErrorText *errors) { return IDASetErrHandlerFn(ida, on_error, errors); }

#endif

// Change of c, relative, above which the matrix is set up again; an early SUNDIALS 6 keeps IDA's own 0.25.
#if SUNDIALS_VERSION_MAJOR >= 7 || SUNDIALS_VERSION_MINOR >= 4
inline int set_refresh_threshold(void *ida, double change) { return IDASetDeltaCjLSetup(ida, change); }
#else
inline int set_refresh_threshold(void *, double) { return 0; }
#endif

// Asked from the library, not from the header.
inline const char *linked_version() {
    static const std::string text = [] {
        char buffer[32] = "";
        return std::string(SUNDIALSGetVersion(buffer, sizeof buffer) == 0 ? buffer : "unknown");
    }();
    return text.c_str();
}

class Context {
public:
    explicit Context(ErrorText *errors) {
        if (!create_context(&context_, errors)) throw std::bad_alloc();
    }
    ~Context() { SUNContext_Free(&context_); }
    Context(const Context &) = delete;
    Context &operator=(const Context &) = delete;
    operator SUNContext() const { return context_; }

private:
    SUNContext context_ = nullptr;
};

struct Delete {
    void operator()(N_Vector v) const { N_VDestroy(v); }
    void operator()(SUNLinearSolver s) const {
        if (s->ops->free)
            SUNLinSolFree(s);
        else
            SUNLinSolFreeEmpty(s);
    }
    void operator()(SUNMatrix m) const {
        if (m->ops->destroy)
            SUNMatDestroy(m);
        else
            SUNMatFreeEmpty(m);
    }
};
template <class Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Delete>;

using Vector = Owned<N_Vector>;
using LinearSolver = Owned<SUNLinearSolver>;
using Matrix = Owned<SUNMatrix>;

class Integrator {
public:
    explicit Integrator(SUNContext context) : memory_(IDACreate(context)) {
        if (!memory_) throw std::bad_alloc();
    }
    ~Integrator() { IDAFree(&memory_); }
    Integrator(const Integrator &) = delete;
    Integrator &operator=(const Integrator &) = delete;
    operator void *() const { return memory_; }

private:
    void *memory_;
};

} // namespace ida

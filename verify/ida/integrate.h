/* IDA on equations that the caller evaluates: y = (q, v, lambda), with the constraints on the acceleration level. The matrix is
   that of (q, lambda), from which the caller has eliminated v. */
#ifndef LOOSELINK_INTEGRATE_H
#define LOOSELINK_INTEGRATE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    double *values;
    int64_t length;
} li_vector;

/* Every function returns 0, or 1 where a smaller step may help. It writes what it is asked for into the last vector, `change` into both. */
typedef struct {
    void *data;
    int32_t unknowns, multipliers, contacts;
    /* the pattern of the condensed matrix, column by column */
    const int64_t *columns, *rows;
    /* F(t, y, y') */
    int32_t (*residual)(void *data, double t, li_vector y, li_vector yp, li_vector r);
    /* the entries of dF/dy + c dF/dy', condensed */
    int32_t (*jacobian)(void *data, double t, double c, li_vector y, li_vector yp, li_vector entries);
    /* with the last matrix: the right-hand side b condensed, and x of all unknowns from the condensed one */
    void (*condense)(void *data, li_vector b, li_vector condensed);
    void (*expand)(void *data, li_vector b, li_vector condensed, li_vector x);
    /* the penetration of every contact */
    int32_t (*gaps)(void *data, double t, li_vector y, li_vector gaps);
    /* a contact has changed: closes or opens it, and makes y and y' consistent */
    int32_t (*change)(void *data, double t, li_vector y, li_vector yp);
    /* the state at a multiple of the interval */
    void (*row)(void *data, li_vector y);
} li_equations;

typedef struct {
    /* largest local error: relative, and added to that of a position [m] and of a velocity [m/s] */
    double relative, position, velocity;
    double duration, interval;
    /* processor time after which it is given up [s] */
    double longest;
    /* share of an error test up to which Newton's method iterates */
    double newton;
    /* of BDF, 1 to 5 */
    int32_t max_order;
    /* 0: KLU, 1: a dense matrix */
    int32_t dense;
} li_run;

typedef struct {
    int64_t steps, residuals, jacobians, changes;
} li_counts;

/* From y and y' at t = 0. Returns 0, 1 where it is given up, or -1 with the text of IDA. */
int32_t li_integrate(const li_equations *equations, const li_run *run, double *y, double *yp, li_counts *counts,
                     char *message, int32_t length);

#ifdef __cplusplus
}
#endif

#endif

/* C interface of the reference implementation: it reads a scene, assembles its equations, finds its start and integrates.
 *
 * A scene is the text of a file in the language of docs/scene.md. SI units, radians, doubles; matrices are row-major.
 * The equations are those of EQUATIONS.md,
 *
 *     M a + f(t, q, v, x; z) + Phi_q^T lambda = 0        Phi(t, q) = 0        x' = g(t, q, v, x; z)
 *
 * with n coordinates, m constraint rows, one impact velocity z a joint and s internal states x. The impact velocity is that of
 * eq. 24 while the contact of a joint with clearance is closed, 0 while it is open and for every other joint.
 *
 * Internal states by name, those of joints in the order of the scene first, then those of forces:
 *
 *     JOINT.bristle                  deflection of the bristles, m, of a joint whose contact has the friction of LuGre or the
 *                                    elasto-plastic one; it has the sign of the slip
 *     FORCE.elongation               elongation of the damper of a Maxwell element, m
 *
 * Bristles rest (x' = 0) and are without force while their contact is open; a run sets them to 0 where it closes and where it
 * opens. A run keeps all states as unknowns. Functions at a given state take them from ls_scene_set_states. (Lists, functions
 * and names of elongations alone are gone: LS_STATE stands where LS_ELONGATION was and gives names of states instead of names
 * of elements, ls_scene_set_states and ls_scene_state_rates stand for ls_scene_set_elongations and ls_scene_elongation_rates.)
 *
 * Coordinates by name, the bodies in the order of the file:
 *
 *     rigid link      BODY.start.x, .start.y, .end.x, .end.y                                  (eqs. 1, 3, 4)
 *     flexible link   BODY.nodeI.x, .nodeI.y, .nodeI.slope_x, .nodeI.slope_y, I = 0 at start  (eqs. 6-8)
 *     rigid body      BODY.x, .y of the centre of mass, .theta
 *     point mass      BODY.x, .y
 *     moving body     BODY.x, .y, .theta of its frame; without mass, every coordinate prescribed
 *
 * Constraint rows by name. r and d are place and direction of a side, 1 is the bearing, guide or first side, 2 the other.
 * d is (1, 0) of the ground, (cos theta, sin theta) of a frame, the chord over its length of a rigid link and the slope r' of a
 * flexible one. R(alpha) turns counter-clockwise.
 *
 *     BODY.length                    (|chord|^2 - l^2) / (2 l) of a rigid link; multiplier: axial force, tension positive
 *     JOINT.length                   (|r_2 - r_1|^2 - l^2) / (2 l) of a rod; multiplier: its force, tension positive
 *     BODY.x, .y, .theta             coordinate minus path, of a moving body
 *     JOINT.x, .y                    r_1 - r_2; multiplier: force on side 2
 *     JOINT.line                     R(direction) d_1 x (r_2 - r_1)
 *     JOINT.rotation                 R(angle) d_1 x d_2; couple on side 2: -multiplier (R(angle) d_1 . d_2)
 *     JOINT.slope_x, .slope_y        d_2 - R(angle) d_1
 *     DRIVE.angle, DRIVE.JOINT       R(phi(t)) d_1 x d_2, of a drive of an angle and of an actuated joint
 *     DRIVE.x, DRIVE.y               component of the place of a point minus its function
 *
 * Rows that repeat others throughout the motion are left out and listed as LS_REDUNDANT.
 *
 * A function that returns int32_t returns an `ls_code`: 0 on success. A function that returns a pointer returns null on failure.
 * Both describe a failure in *error, which may be null. There are no globals, nothing is printed, and no exception leaves the
 * library. Arrays belong to the caller; texts live as long as their scene.
 */
#ifndef LOOSELINK_REFERENCE_H
#define LOOSELINK_REFERENCE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum {
    LS_OK = 0,
    LS_BAD_INPUT = 1,   /* the scene or an argument makes no sense */
    LS_UNREACHABLE = 2, /* the inverse kinematics has no solution at `time` */
    LS_IDA = 3,         /* SUNDIALS failed; `flag` is its return value, the message is its own */
    LS_NOT_FINITE = 4,  /* a value is not finite, or Newton's method of the statics does not converge */
    LS_INTERNAL = 5,    /* anything else (out of memory, ...) */
    LS_LIMIT = 6        /* a static analysis with `at_limit = "stop"` has come to a critical point; `time` is its t */
} ls_code;

/* Texts are zero-terminated. `field` is the path of the key in the scene, "" if the failure has no place there; a line of 0
 * means that the value comes from an override or that there is no place. */
typedef struct {
    int32_t code;
    int32_t flag;
    int32_t line, column;
    double time;
    char field[128];
    char message[640];
} ls_error;

/* ---- the scene ------------------------------------------------------------------------------------------------- */

typedef struct ls_scene ls_scene;

/* Reads `text`, after the overrides "path.of.a.key=value" in TOML syntax, and assembles the start. Null on failure. */
ls_scene *ls_scene_read(const char *text, const char *const *overrides, size_t count, ls_error *error);
void ls_scene_free(ls_scene *scene);

typedef struct {
    const char *title;
    int32_t is_static;    /* t is then a measure of the load */
    int32_t reserved;
    double duration;      /* s */
    double interval;      /* of the rows, s */
    double initial_energy; /* J */
} ls_description;
void ls_scene_describe(const ls_scene *scene, ls_description *description);

typedef enum {
    LS_COORDINATE = 0, /* n: of q */
    LS_CONSTRAINT = 1, /* m: of Phi */
    LS_JOINT = 2,      /* of z */
    LS_CHANNEL = 3,    /* all channels of the scene, t first */
    LS_SELECTED = 4,   /* those that `output.channels` selects, in its order, t first */
    LS_REDUNDANT = 5,  /* constraint rows left out */
    LS_STATE = 6,      /* s: of x */
    LS_NOTE = 7        /* facts about the scene that are no errors, in words */
} ls_list;
size_t ls_scene_count(const ls_scene *scene, int32_t list);
const char *ls_scene_name(const ls_scene *scene, int32_t list, size_t index); /* null beyond the end */
/* Place of a selected channel among all channels. */
size_t ls_scene_selected(const ls_scene *scene, size_t index);

/* The start (q, v: n each), t = 0. */
int32_t ls_scene_start(const ls_scene *scene, double *q, double *v, ls_error *error);

/* The impact velocities at the start (z: joints): those of contacts that begin closed, with `initial.journals = "pressed"` or
 * because a given state presses them in, else 0. No event tells of their onset. */
int32_t ls_scene_start_contacts(const ls_scene *scene, double *z, ls_error *error);

/* An equilibrium. */
typedef struct {
    double eigenvalue;  /* the smallest mu of K x + Phi_q^T nu = mu M x, Phi_q x = 0, 1/s2; 0 if nothing can move */
    int32_t stability;  /* 1 stable (or nothing can move), 0 neutral within rounding, -1 unstable */
    int32_t coordinate; /* that moves most in the motion of that eigenvalue; -1 if nothing can move */
} ls_rest;
/* The start of a scene with `initial.equilibrium`; an error of any other. */
int32_t ls_scene_rest(const ls_scene *scene, ls_rest *rest, ls_error *error);

/* ---- the equations at a given state ---------------------------------------------------------------------------- */

/* The internal states (s) at which the functions below and ls_run_from take the scene from now on, and what they are at present.
 * Before the first call of ls_scene_set_states they are those at t = 0: bristles are straight, elongations those of the scene.
 * ls_run_new always starts from those at t = 0. */
int32_t ls_scene_set_states(ls_scene *scene, const double *states, ls_error *error);
int32_t ls_scene_states(const ls_scene *scene, double *states, ls_error *error);

/* The rates x' = g (s), and dg/dq, dg/dv (s x n each) and dg/dx (s x s); each may be null. z: one number a joint. */
int32_t ls_scene_state_rates(const ls_scene *scene, double t, const double *q, const double *v, const double *z,
                             double *rates, double *by_q, double *by_v, double *by_states, ls_error *error);

/* M (n x n). */
int32_t ls_scene_mass(const ls_scene *scene, double *mass, ls_error *error);

/* f (n), and df/dq and df/dv (n x n each; either may be null). z: one number a joint. Torsion springs are taken within half a
 * turn of their angle at the start. */
int32_t ls_scene_force(const ls_scene *scene, double t, const double *q, const double *v, const double *z,
                       double *force, double *by_q, double *by_v, ls_error *error);

/* df/dx (n x s). */
int32_t ls_scene_force_by_states(const ls_scene *scene, double t, const double *q, const double *v, const double *z,
                                 double *by_states, ls_error *error);

/* Phi (m), Phi_q (m x n), Phi_t (m). */
int32_t ls_scene_constraint_rows(const ls_scene *scene, double t, const double *q,
                                 double *phi, double *phi_q, double *phi_t, ls_error *error);

/* a (n) and lambda (m) of the equations of motion with d2Phi/dt2 = 0. */
int32_t ls_scene_acceleration(const ls_scene *scene, double t, const double *q, const double *v, const double *z,
                              double *a, double *lambda, ls_error *error);

/* All channels. Angles are those nearest to the start; `energy.work` and the like are 0. */
int32_t ls_scene_channels(const ls_scene *scene, double t, const double *q, const double *v, const double *z,
                          double *values, ls_error *error);

/* ---- time ------------------------------------------------------------------------------------------------------ */

typedef enum {
    LS_DENSE = 0,
    LS_SPARSE = 1 /* KLU; for fine meshes */
} ls_linear_solver;

/* The error of a step in q is weighted with relative |q| + position, in v with relative |v| + velocity, in internal states with
 * relative |x| + position. */
typedef struct {
    double relative;
    double position;       /* m; angles and slopes: divided by a length of the body */
    double velocity;       /* m/s, likewise */
    double max_step;       /* s; 0: none */
    double newton;         /* share of an error test up to which Newton's method iterates; IDA's own is 0.33 */
    int32_t max_order;     /* of BDF, 1 to 5 */
    int32_t linear_solver;
    int64_t max_steps;     /* between two calls of ls_run_advance; reaching it is an error of IDA's kind */
} ls_tolerances;

typedef struct ls_run ls_run;

/* Starts at t = 0 from the start of the scene, or at t from (q, v) with all contacts open, bristles straight and the elongations
 * of ls_scene_set_states. The run keeps its own copy of what it needs. A static scene starts from its own start only and uses no
 * tolerance. Null on failure. */
ls_run *ls_run_new(const ls_scene *scene, const ls_tolerances *tolerances, ls_error *error);
ls_run *ls_run_from(const ls_scene *scene, double t, const double *q, const double *v, const ls_tolerances *tolerances,
                    ls_error *error);
void ls_run_free(ls_run *run);

/* Goes on to t, which must not decrease, and fills `values` with all channels there. After a failure the run is dead: every
 * further call returns the same error. Accelerations and reactions are those of the acceleration level at (t, q, v). */
int32_t ls_run_advance(ls_run *run, double t, double *values, ls_error *error);

/* The state after the last `ls_run_advance`: q, v, a (n), lambda (m), z (joints). Each may be null. */
int32_t ls_run_state(const ls_run *run, double *q, double *v, double *a, double *lambda, double *z, ls_error *error);

/* The internal states (s) there. */
int32_t ls_run_states(const ls_run *run, double *states, ls_error *error);

typedef struct {
    double time;
    double velocity;   /* onset: rate of the penetration, before the floor; loss: the same, negative */
    double eccentricity_x, eccentricity_y; /* journal minus bearing; of a loose guide its part across the guide */
    double deepest;    /* loss: largest penetration since the onset; onset: 0 */
    int32_t joint;
    int32_t onset;     /* 1 onset, 0 loss */
} ls_event;

/* Onsets and losses of contact so far. */
size_t ls_run_event_count(const ls_run *run);
int32_t ls_run_event(const ls_run *run, size_t index, ls_event *event);

/* Static analyses. ls_run_advance comes to the first equilibrium at t along the path; with `at_limit = "follow"` the path may
 * lead over unstable equilibria under other loads, smaller and negative ones too. */

/* A zero of an eigenvalue on the path: a limit point, at which the load has an extreme, or a bifurcation. */
typedef struct {
    double t;
    double part;        /* of the full load, t / duration */
    int32_t is_limit;   /* 1 limit point, 0 bifurcation */
    int32_t coordinate; /* that moves most in the motion without resistance */
} ls_critical_point;
size_t ls_run_critical_count(const ls_run *run); /* those passed so far, and one that has ended the run */
int32_t ls_run_critical_point(const ls_run *run, size_t index, ls_critical_point *point);

/* The equilibrium after the last `ls_run_advance`. */
int32_t ls_run_rest(const ls_run *run, ls_rest *rest, ls_error *error);

/* The steps along unstable paths so far, in order: all channels of one, t among them. */
size_t ls_run_unstable_count(const ls_run *run);
int32_t ls_run_unstable(const ls_run *run, size_t index, double *values, ls_error *error);

/* residuals, jacobians: evaluations; clamps: times that a contact force began to be held at zero */
typedef struct {
    int64_t steps, residuals, jacobians, error_failures, convergence_failures, restarts, clamps;
} ls_statistics;
void ls_run_statistics(const ls_run *run, ls_statistics *statistics);

/* Version of SUNDIALS the library is linked with, for example "6.4.1". */
const char *ls_sundials_version(void);

#ifdef __cplusplus
}
#endif

#endif

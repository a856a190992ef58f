/* C interface of the reference implementation.
 *
 * SI units, radians, doubles; matrices are row-major. Planar vectors are (x, y).
 * Every function that can fail returns 0 on success or an `ls_code` and fills *error (which may be null).
 * There are no globals, and no exception leaves the library. Arrays belong to the caller unless said otherwise.
 *
 * The equations are those of EQUATIONS.md:
 *
 *     M a + f(q, v; z) + Phi_q^T lambda = 0,     Phi(t, q) = 0.
 *
 * Coordinates of the bodies, one body behind the other in the order of the list:
 *
 *     ground         none
 *     rigid link     start x, start y, end x, end y                                (eqs. 1, 3, 4)
 *     flexible link  for each of the elements + 1 nodes: r_x, r_y, r'_x, r'_y      (eqs. 6-8)
 *     rigid body     x, y of the centre of mass, theta
 *
 * Constraints, in this order:
 *
 *     for each rigid link:   (|d|^2 - l^2) / (2 l),  d = end - start     multiplier: axial force, tension positive
 *     for each ideal joint, in the order of the joints, two rows: r_bearing - r_journal
 *                                                                        multiplier: force on the journal side
 *     for each leg of the drive: the angle of its crank                  multiplier: - torque on the crank (N m), see ls_leg
 *
 * where the row of a drive is ((B - A) x (cos phi(t), sin phi(t))) / l taken with the sign that makes its derivative
 * by the angle of the crank +1 at Phi = 0.
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
    LS_BAD_INPUT = 1,   /* the description makes no sense; the message names the item */
    LS_UNREACHABLE = 2, /* the inverse kinematics has no solution; the message names the leg, `time` is set */
    LS_IDA = 3,         /* SUNDIALS failed; `flag` is its return value, the message is its own */
    LS_NOT_FINITE = 4,  /* a value is not finite; the message names it */
    LS_INTERNAL = 5     /* anything else (out of memory, ...) */
} ls_code;

typedef struct {
    int32_t code;
    int32_t flag;
    double time;
    char message[496]; /* zero-terminated */
} ls_error;

typedef enum { LS_GROUND = 0, LS_RIGID_LINK = 1, LS_FLEXIBLE_LINK = 2, LS_RIGID_BODY = 3 } ls_body_kind;

/* A body as the scene describes it; derived numbers (mass, EA, EI, inertia) are computed by the library.
 * A field that the kind does not use is 0. */
typedef struct {
    int32_t kind;
    int32_t elements;          /* flexible link */
    double length;             /* links */
    double width;              /* links: height of the section in the plane of motion (bending) */
    double height;             /* links: extent out of the plane */
    double density;            /* links, plates */
    double youngs_modulus;     /* flexible link */
    double plate_circumradius; /* rigid body: full equilateral triangular plate when > 0 ... */
    double plate_thickness;
    double mass;               /* ... otherwise mass and central inertia as given */
    double inertia;
} ls_body;

/* A point of a body. Ground: global position. Rigid body: from the centre of mass, in axes that turn with it.
 * Links: x = 0 is the start, x = length the end, nothing else; y = 0. */
typedef struct {
    int32_t body;
    int32_t reserved;
    double x, y;
} ls_point;

typedef enum { LS_LANKARANI_NIKRAVESH = 0, LS_HUNT_CROSSLEY = 1, LS_FLORES = 2 } ls_normal_kind;
typedef enum { LS_NO_FRICTION = 0, LS_AMBROSIO = 1 } ls_friction_kind;
typedef enum { LS_SLIP_PAPER = 0, LS_SLIP_MATERIAL = 1 } ls_slip_kind;

/* Contact in a loose joint: F = K delta^n (1 + chi delta_rate / impact_velocity), never below zero, with
 * chi = 3 (1 - c_e^2) / 4 (Lankarani-Nikravesh), 3 (1 - c_e) / 2 (Hunt-Crossley), 8 (1 - c_e) / (5 c_e) (Flores). */
typedef struct {
    int32_t normal;
    int32_t friction;
    int32_t slip;
    int32_t reserved;
    double bearing_radius;
    double clearance;           /* R_i - R_j */
    double stiffness;           /* K when > 0, otherwise K of eq. 25 from radii and materials */
    double bearing_modulus, bearing_poisson;
    double journal_modulus, journal_poisson;
    double exponent;
    double restitution;
    double impact_velocity_floor;
    double friction_coefficient;
    double friction_v0, friction_v1;
} ls_contact;

/* A revolute joint, ideal when contact < 0, otherwise with the play of contacts[contact]. */
typedef struct {
    ls_point bearing, journal;
    int32_t contact;
    int32_t reserved;
} ls_joint;

/* A leg A-B-C of a driven parallel mechanism, named by its joints: A carries the crank (its journal side) on ground,
 * B the passive link (journal side) on the crank, C is between the passive link (journal side) and the driven body.
 * elbow is the sign of (B - A) x (C - B). The crank's angle phi(t) is that of the ideal rigid mechanism whose driven
 * body follows the path exactly; the torque is what the drive exerts on the crank, positive counterclockwise. */
typedef struct {
    int32_t joint_a, joint_b, joint_c;
    int32_t elbow;
} ls_leg;

/* Eq. 27: the centre of the driven body is centre + radius (cos, sin)(2 pi frequency t + phase), its angle theta. */
typedef struct {
    int32_t body;
    int32_t reserved;
    double centre_x, centre_y, radius, frequency, phase, theta;
} ls_path;

typedef struct {
    const ls_body *bodies;
    const ls_joint *joints;
    const ls_contact *contacts;
    const ls_leg *legs; /* none: nothing is driven */
    int32_t n_bodies, n_joints, n_contacts, n_legs;
    ls_path path;       /* used when there are legs */
} ls_mechanism;

/* ---- parts, for comparison one by one ------------------------------------------------------------------------ */

/* Version of SUNDIALS the library is linked with, for example "6.4.1". */
const char *ls_sundials_version(void);

/* Mass matrix (8 x 8, eq. 10) of one cable element: mass m of the element, length l. */
int32_t ls_element_mass(double mass, double length, double *matrix, ls_error *error);

/* Elastic energy (axial, bending: energy[2]), force dU/dq (8) and tangent d2U/dq2 (8 x 8) of one cable element (eq. 11). */
int32_t ls_element_elastic(double axial_stiffness, double bending_stiffness, double length, const double *q,
                           double *energy, double *force, double *tangent, ls_error *error);

/* K of the contact: eq. 25 or the number given. */
int32_t ls_contact_stiffness(const ls_contact *contact, double *stiffness, ls_error *error);

/* Normal force at penetration delta > 0, and its derivatives by delta and its rate. *clamped: 1 where the law would pull. */
int32_t ls_contact_normal(const ls_contact *contact, double delta, double rate, double impact_velocity,
                          double *force, double *by_delta, double *by_rate, int32_t *clamped, ls_error *error);

/* Friction force along the direction of slip, -c_f c_d F_n sign(v_t) of eq. 26, and its derivatives. */
int32_t ls_contact_friction(const ls_contact *contact, double slip, double normal,
                            double *force, double *by_slip, double *by_normal, ls_error *error);

/* ---- the assembled mechanism ----------------------------------------------------------------------------------- */

typedef struct ls_system ls_system;

ls_system *ls_system_new(const ls_mechanism *mechanism, ls_error *error); /* copies; null on failure */
void ls_system_free(ls_system *system);

int32_t ls_system_coordinates(const ls_system *system);
int32_t ls_system_constraints(const ls_system *system);

/* Angles of the cranks at time t with first and second derivatives: 3 numbers (phi, rate, acceleration) a leg. */
int32_t ls_system_cranks(const ls_system *system, double t, double *angles, ls_error *error);

/* The start of the paper: positions and velocities of the ideal rigid mechanism at time t, journals concentric, flexible
 * links straight and moving rigidly. Needs legs. */
int32_t ls_system_start(const ls_system *system, double t, double *q, double *v, ls_error *error);

/* M (n x n) at q. */
int32_t ls_system_mass(const ls_system *system, const double *q, double *mass, ls_error *error);

/* f (n): elastic, contact and friction forces and velocity terms with the sign of the left-hand side, and its derivatives
 * by q and v (n x n each; either may be null). z: one number a joint, the impact velocity, 0 while open or ideal. */
int32_t ls_system_force(const ls_system *system, const double *q, const double *v, const double *z,
                        double *force, double *by_q, double *by_v, ls_error *error);

/* Phi (m), Phi_q (m x n) and Phi_t (m) at (t, q). */
int32_t ls_system_constraint_rows(const ls_system *system, double t, const double *q,
                                  double *phi, double *phi_q, double *phi_t, ls_error *error);

/* ---- time ------------------------------------------------------------------------------------------------------ */

typedef struct {
    double relative;          /* tolerance of IDA */
    double position;          /* absolute tolerances: m (angles and slopes: divided by a length of the body) */
    double velocity;          /* m/s */
    double max_step;          /* 0: none */
    int32_t max_order;        /* of BDF, 1 to 5 */
    int32_t reserved;
    int64_t max_steps;        /* between two calls of ls_run_advance; reaching it is an error of IDA's kind */
} ls_tolerances;

/* The state at one instant. The pointers are filled by the library with arrays that live until the next call on the
 * same run. a, joint_force and torque come from the acceleration-level equations
 * M a + f + Phi_q^T lambda = 0, d2Phi/dt2 = 0 solved at (t, q, v), not from IDA's derivatives. */
typedef struct {
    double t;
    const double *q, *v, *a, *lambda;
    const double *joint_force;     /* 2 a joint: force of the bearing side on the journal side */
    const double *penetration;     /* 1 a joint: |e| - c, 0 for an ideal joint */
    const double *impact_velocity; /* 1 a joint: z */
    const double *torque;          /* 1 a leg */
    double kinetic, axial, bending, contact;                 /* energies; contact: K delta^(n+1)/(n+1) while closed */
    double work;                                             /* done by the drives since the start */
    double contact_dissipated, clamp, friction_dissipated;   /* EQUATIONS.md, energy ledger */
} ls_row;

typedef struct {
    double time;
    double velocity;   /* onset: d(delta)/dt, before the floor; loss: d(delta)/dt */
    double eccentricity_x, eccentricity_y; /* e = r_journal - r_bearing */
    int32_t joint;
    int32_t onset;     /* 1 onset, 0 loss */
} ls_event;

typedef struct {
    int64_t steps, residuals, jacobians, error_failures, convergence_failures, restarts, clamps;
} ls_statistics;

typedef struct ls_run ls_run;

/* Starts at t with (q, v), all contacts open. The run keeps its own copy of what it needs of the system. */
ls_run *ls_run_new(const ls_system *system, double t, const double *q, const double *v,
                   const ls_tolerances *tolerances, ls_error *error);
void ls_run_free(ls_run *run);

/* Integrates to t (located events on the way) and describes the state there. After a failure the run is dead: every
 * further call returns the same error. */
int32_t ls_run_advance(ls_run *run, double t, ls_row *row, ls_error *error);

/* Events so far. */
int64_t ls_run_event_count(const ls_run *run);
int32_t ls_run_event(const ls_run *run, int64_t index, ls_event *event);

void ls_run_statistics(const ls_run *run, ls_statistics *statistics);

#ifdef __cplusplus
}
#endif

#endif

/* C interface of the reference implementation.
 *
 * SI units, radians, doubles; matrices are row-major. Planar vectors are (x, y).
 * Every function that can fail returns 0 on success or an `ls_code` and fills *error (which may be null).
 * There are no globals, and no exception leaves the library. Arrays belong to the caller unless said otherwise.
 *
 * The equations are those of EQUATIONS.md:
 *
 *     M a + f(t, q, v; z) + Phi_q^T lambda = 0,     Phi(t, q) = 0.
 *
 * Coordinates of the bodies, one body behind the other in the order of the list:
 *
 *     ground         none
 *     rigid link     start x, start y, end x, end y                                (eqs. 1, 3, 4)
 *     flexible link  for each of the elements + 1 nodes: r_x, r_y, r'_x, r'_y      (eqs. 6-8)
 *     rigid body     x, y of the centre of mass, theta
 *     point mass     x, y
 *     moving body    x, y, theta of its frame; no mass, every coordinate prescribed
 *
 * The direction d of a body at a point, and its length l where nothing is deformed: of the ground (1, 0), of a rigid or
 * moving body (cos theta, sin theta), of a flexible link the slope r' at the node, all with l = 1; of a rigid link
 * end - start with its length. A point mass has none. R(alpha) turns counterclockwise by alpha. Indices 1 and 2 are the
 * bearing and the journal side of a joint.
 *
 * Constraints, in this order:
 *
 *     for each body: of a rigid link  (|d|^2 - l^2) / (2 l)              multiplier: axial force, tension positive
 *                    of a moving body x - x(t), y - y(t), theta - theta(t): three rows
 *     for each joint, in the order of the joints,
 *         revolute, ideal   two rows: r_1 - r_2                          multiplier: force on the journal side
 *         prismatic         u x (r_2 - r_1),  u = R(direction) d_1 / l_1
 *                           when locked also ((R(angle) d_1) x d_2) / (l_1 l_2)
 *         weld              two rows: r_1 - r_2
 *                           holding the direction: ((R(angle) d_1) x d_2) / (l_1 l_2)
 *                           holding the slope, two rows: d_2 / l_2 - R(angle) d_1 / l_1
 *     for each leg of the drive: the angle of its crank                  multiplier: - torque on the crank (N m), see ls_leg
 *     for each motion: of an angle       ((R(phi(t)) d_1) x d_2) / (l_1 l_2)
 *                      of a coordinate   n . r - f(t)
 *
 * where the row of a leg is ((B - A) x (cos phi(t), sin phi(t))) / l taken with the sign that makes its derivative
 * by the angle of the crank +1 at Phi = 0. Rows must be independent; a redundant set is a failure with its name.
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

typedef enum {
    LS_POLYNOMIAL = 0, /* c0 + c1 t + ... + c5 t^5 */
    LS_HARMONIC = 1,       /* c0 + c1 sin(2 pi c2 t + c3) */
    LS_RAMP = 2,           /* c0 up to t = c2, linear to c1 within c3, then c1; loads only */
    LS_SMOOTH_STEP = 3,    /* c0 + (c1 - c0)(10 u^3 - 15 u^4 + 6 u^5), u = (t - c2)/c3 kept in [0, 1] */
    LS_SPIN_UP = 4         /* T = c2: c0 + c1/T (t^2/2 + (T/2 pi)^2 (cos(2 pi t/T) - 1)) for t < T, rate c1 from then on */
} ls_function_kind;

/* A function of time. */
typedef struct {
    int32_t kind;
    int32_t reserved;
    double c[6];
} ls_function;

typedef enum {
    LS_GROUND = 0,
    LS_RIGID_LINK = 1,
    LS_FLEXIBLE_LINK = 2,
    LS_RIGID_BODY = 3,
    LS_POINT_MASS = 4,
    LS_MOVING_BODY = 5
} ls_body_kind;

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
    double mass;               /* ... otherwise mass and central inertia as given; point mass */
    double inertia;
    double strain_damping;     /* flexible link: retardation time tau of the strain-rate damping, s */
    double mass_damping;       /* flexible link: alpha of the damping alpha M v, 1/s */
    int32_t function;          /* moving body: x, y, theta are functions[function], [function + 1], [function + 2] */
    int32_t reserved;
} ls_body;

/* A point of a body. Ground: global position. Rigid body: from the centre of mass, in axes that turn with it. Moving body:
 * in its frame. Point mass: x = y = 0. Links: the distance x from the start, y = 0; of a rigid link 0 or its length, of a
 * flexible one any node. */
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

typedef enum { LS_REVOLUTE = 0, LS_PRISMATIC = 1, LS_WELD = 2 } ls_joint_kind;

/* A joint. Revolute: ideal when contact < 0, otherwise with the play of contacts[contact]. Prismatic: the bearing side
 * carries the line through its point, the journal side slides. Two points of one joint belong to different bodies. */
typedef struct {
    ls_point bearing, journal;
    int32_t contact;
    int32_t kind;
    int32_t hold_rotation; /* prismatic: 1 when the relative angle is held */
    int32_t hold_slope;    /* weld: 1 when both components of d_2 are held, 0 for its direction alone */
    double direction;      /* prismatic: angle of the line relative to d_1 */
    double angle;          /* prismatic that holds rotation, weld: angle of d_2 relative to d_1 */
} ls_joint;

/* A spring and damper along the line of two points: pull k (L - L_0) + c dL/dt. With L_0 = 0 and no damping the points may
 * meet: the force is then k times the vector between them. */
typedef struct {
    ls_point from, to;
    double stiffness, damping, rest_length;
} ls_spring;

/* A torsional spring and damper in a revolute joint: torque k (phi - phi_0) + c dphi/dt on the bearing side and its opposite
 * on the journal side, phi the angle of d_2 relative to d_1. Full turns are not counted: phi is taken within half a turn of
 * phi_0. */
typedef struct {
    int32_t joint;
    int32_t reserved;
    double stiffness, damping, rest_angle;
} ls_torsion_spring;

typedef enum { LS_DEAD_FORCE = 0, LS_FOLLOWER_FORCE = 1, LS_TORQUE = 2 } ls_load_kind;

/* An applied load. Forces have the components functions[x], functions[y] in the axes of the ground (dead) or in axes that
 * turn with the direction of the body at the point, without its stretch (follower). A torque functions[x] acts on the body
 * of `point`, at that node of a flexible link, and its opposite on that of `reaction` (body < 0: the ground). */
typedef struct {
    int32_t kind;
    int32_t x, y;
    int32_t reserved;
    ls_point point, reaction;
} ls_load;

typedef enum { LS_ANGLE = 0, LS_COORDINATE = 1 } ls_motion_kind;

/* A prescribed motion: the angle of d_2 relative to d_1 in a revolute joint, ideal or loose, or the coordinate n . r of a
 * point is functions[function]. */
typedef struct {
    int32_t kind;
    int32_t function;
    int32_t joint;    /* angle */
    int32_t reserved;
    ls_point point;   /* coordinate */
    double nx, ny;    /* coordinate: unit vector n */
} ls_motion;

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
    const ls_leg *legs; /* none: no body follows a path by inverse kinematics */
    const ls_function *functions;
    const ls_spring *springs;
    const ls_torsion_spring *torsion_springs;
    const ls_load *loads;
    const ls_motion *motions;
    int32_t n_bodies, n_joints, n_contacts, n_legs;
    int32_t n_functions, n_springs, n_torsion_springs, n_loads, n_motions;
    int32_t reserved;
    ls_path path;       /* used when there are legs */
    double gravity_x, gravity_y; /* m/s2 */
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
 * links straight and moving rigidly. Needs legs, and refuses a mechanism with anything that the legs do not determine. */
int32_t ls_system_start(const ls_system *system, double t, double *q, double *v, ls_error *error);

/* M (n x n) at q. */
int32_t ls_system_mass(const ls_system *system, const double *q, double *mass, ls_error *error);

/* f (n) at (t, q, v): elastic, damping, spring, contact and friction forces, loads, weight and velocity terms with the sign
 * of the left-hand side, and its derivatives by q and v (n x n each; either may be null). z: one number a joint, the impact
 * velocity, 0 while open or ideal. */
int32_t ls_system_force(const ls_system *system, double t, const double *q, const double *v, const double *z,
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
    const double *joint_couple;    /* 1 a joint: couple of the bearing side on the journal side that holds rotation or slope,
                                      work-conjugate to the rotation of d_2; 0 of other joints */
    const double *penetration;     /* 1 a joint: |e| - c, 0 for an ideal joint */
    const double *impact_velocity; /* 1 a joint: z */
    const double *torque;          /* 1 a leg */
    const double *motion_force;    /* 1 a motion: torque on the journal side, force on the point along n */
    double kinetic, axial, bending, contact;                 /* energies; contact: K delta^(n+1)/(n+1) while closed */
    double gravity, springs;                                 /* potential of the weight, zero at the origin; of springs */
    double work;                                             /* done by loads and all that is prescribed since the start */
    double contact_dissipated, clamp, friction_dissipated;   /* EQUATIONS.md, energy ledger */
    double damping_dissipated;                               /* by dampers and damping of links */
} ls_row;

typedef struct {
    double time;
    double velocity;   /* onset: d(delta)/dt, before the floor; loss: d(delta)/dt */
    double eccentricity_x, eccentricity_y; /* e = r_journal - r_bearing */
    double deepest;    /* loss: largest penetration since the onset, located on the interpolant; onset: 0 */
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

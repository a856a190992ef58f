//! Closed-form kinematics and inverse dynamics of the rigid ideal 3-RRR, by another way than the solver's: laws of
//! cosines, velocities along and across the links, Newton-Euler with twelve joint forces.

use nalgebra::{DMatrix, DVector, Vector2};

type V = Vector2<f64>;

pub const L1: f64 = 0.245;
pub const L2: f64 = 0.242;
pub const L3: f64 = 0.112;
pub const L4: f64 = 0.4;
const DENSITY: f64 = 2700.0;
const CRANK_AREA: f64 = 0.015 * 0.03;
const LINK_AREA: f64 = 0.005 * 0.03;

/// Angular position of A_i and, at theta = 0, of C_i.
pub fn angle(leg: usize) -> f64 {
    [210.0_f64, 330.0, 90.0][leg].to_radians()
}

fn unit(angle: f64) -> V {
    V::new(angle.cos(), angle.sin())
}

fn perp(v: V) -> V {
    V::new(-v.y, v.x)
}

/// One leg at one instant: crank and link vectors with their angular rates.
struct Leg {
    crank: V,
    link: V,
    /// angle, speed, acceleration of the crank
    drive: [f64; 3],
    link_alpha: f64,
    link_omega: f64,
}

/// Motion of C_i on a platform that translates: position, velocity, acceleration.
fn leg(i: usize, c: [V; 3]) -> Leg {
    let a = L4 * unit(angle(i));
    let reach = c[0] - a;
    let r = reach.norm();
    // equal elbows: the crank is turned counterclockwise from the line A C, so that AB x BC < 0
    let elbow = ((L1 * L1 + r * r - L2 * L2) / (2.0 * L1 * r)).acos();
    let phi = reach.y.atan2(reach.x) + elbow;
    let crank = L1 * unit(phi);
    let link = reach - crank;
    // C' = omega1 perp(crank) + omega2 perp(link): project on the other member's direction
    let omega1 = c[1].dot(&link) / perp(crank).dot(&link);
    let omega2 = c[1].dot(&crank) / perp(link).dot(&crank);
    let rest = c[2] + omega1 * omega1 * crank + omega2 * omega2 * link;
    let alpha1 = rest.dot(&link) / perp(crank).dot(&link);
    let alpha2 = rest.dot(&crank) / perp(link).dot(&crank);
    Leg {
        crank,
        link,
        drive: [phi, omega1, alpha1],
        link_alpha: alpha2,
        link_omega: omega2,
    }
}

/// What the inverse dynamics gives at one instant.
pub struct Instant {
    /// Crank angle, speed and torque of each leg.
    pub drives: [[f64; 3]; 3],
    /// Force of the bearing side on the journal side in A_i, B_i, C_i.
    pub a: [V; 3],
    pub b: [V; 3],
    pub c: [V; 3],
}

/// Inverse dynamics on the circle of eq. 27.
pub fn inverse_dynamics(t: f64) -> Instant {
    let w = 2.0 * std::f64::consts::PI;
    let centre = [
        0.1 * unit(w * t),
        0.1 * w * perp(unit(w * t)),
        -0.1 * w * w * unit(w * t),
    ];
    let crank_mass = DENSITY * CRANK_AREA * L1;
    let link_mass = DENSITY * LINK_AREA * L2;
    let platform_mass = DENSITY * 0.75 * 3.0_f64.sqrt() * L3 * L3 * 0.01;

    // unknown: force of the crank on the link in B_i, force of the platform on the link in C_i
    let (mut matrix, mut right) = (DMatrix::zeros(12, 12), DVector::zeros(12));
    let mut legs = Vec::new();
    for i in 0..3 {
        let arm = L3 * unit(angle(i));
        let leg = leg(i, [centre[0] + arm, centre[1], centre[2]]);
        let (b, c, row) = (4 * i, 4 * i + 2, 3 * i);
        let pin = leg.drive[2] * perp(leg.crank) - leg.drive[1].powi(2) * leg.crank;
        let middle =
            pin + 0.5 * (leg.link_alpha * perp(leg.link) - leg.link_omega.powi(2) * leg.link);
        for d in 0..2 {
            matrix[(row + d, b + d)] = 1.0;
            matrix[(row + d, c + d)] = 1.0;
            right[row + d] = link_mass * middle[d];
            // platform: minus the forces on the links
            matrix[(9 + d, c + d)] = -1.0;
            right[9 + d] = platform_mass * centre[2][d];
        }
        // moments about the middle of the link, then about the centre of the platform (which does not turn)
        let half = 0.5 * leg.link;
        matrix[(row + 2, b)] = half.y;
        matrix[(row + 2, b + 1)] = -half.x;
        matrix[(row + 2, c)] = -half.y;
        matrix[(row + 2, c + 1)] = half.x;
        right[row + 2] = link_mass * L2 * L2 / 12.0 * leg.link_alpha;
        matrix[(11, c)] = arm.y;
        matrix[(11, c + 1)] = -arm.x;
        legs.push(leg);
    }
    let forces = matrix.lu().solve(&right).expect("the pose is not singular");
    let force = |k: usize| V::new(forces[k], forces[k + 1]);
    let mut instant = Instant {
        drives: [[0.0; 3]; 3],
        a: [V::zeros(); 3],
        b: [V::zeros(); 3],
        c: [V::zeros(); 3],
    };
    for (i, leg) in legs.iter().enumerate() {
        let (on_link, from_platform) = (force(4 * i), force(4 * i + 2));
        let middle = 0.5 * (leg.drive[2] * perp(leg.crank) - leg.drive[1].powi(2) * leg.crank);
        let inertia = crank_mass * L1 * L1 / 3.0;
        let torque = inertia * leg.drive[2] + leg.crank.x * on_link.y - leg.crank.y * on_link.x;
        instant.drives[i] = [leg.drive[0], leg.drive[1], torque];
        instant.b[i] = on_link;
        instant.c[i] = from_platform;
        instant.a[i] = crank_mass * middle + on_link;
    }
    instant
}

/// Rows of J in dl = J (dx, dy, dtheta), l_i = |C_i - B_i|, at the pose of time t.
pub fn jacobian(t: f64) -> nalgebra::Matrix3<f64> {
    let centre = 0.1 * unit(2.0 * std::f64::consts::PI * t);
    nalgebra::Matrix3::from_fn(|i, k| {
        let arm = L3 * unit(angle(i));
        let leg = leg(i, [centre + arm, V::zeros(), V::zeros()]);
        let direction = leg.link / L2;
        [direction.x, direction.y, direction.dot(&perp(arm))][k]
    })
}

/// Position of the pin B_i at time t.
pub fn pin(i: usize, t: f64) -> V {
    let centre = 0.1 * unit(2.0 * std::f64::consts::PI * t);
    let arm = L3 * unit(angle(i));
    L4 * unit(angle(i)) + leg(i, [centre + arm, V::zeros(), V::zeros()]).crank
}

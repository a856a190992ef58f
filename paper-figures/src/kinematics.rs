//! Closed-form kinematics of the ideal 3-RRR and the exact bound it puts on the platform error of a loose mechanism.
//!
//! Leg i closes with ||C_i - B_i|| = l2, where B_i(t) is the driven crank pin and C_i = (x, y) + R(theta) c_i. A change
//! dl_i of that length moves the platform by J (dx, dy, dtheta) = dl with the rows
//!
//! ```text
//! J_i = (u_x, u_y, r_x u_y - r_y u_x),   u = (C_i - B_i) / l2,   r = R(theta) c_i
//! ```
//!
//! By the triangle inequality | ||C_i - B_i|| - l2 | <= |e_B| + |e_C| for rigid links, hence
//! |e_x| <= sum_i |J^-1|_{xi} (|e_B| + |e_C|)_i to first order in the eccentricities e.

use looselink::motion::Circle;
use looselink::scene::{Scene, Sketched};
use miette::{Result, miette};
use nalgebra::{Matrix3, Rotation2, Vector2};
use std::any::Any;
use std::f64::consts::TAU;

/// A point or vector in the plane \[m\].
type Vector = Vector2<f64>;

/// Dimensions of a 3-RRR and the circle its platform is meant to follow.
#[derive(Debug, Clone)]
pub struct MechanismGeometry {
    /// A_i \[m\].
    pub base: [Vector; 3],
    /// C_i in the frame of the platform \[m\].
    pub platform: [Vector; 3],
    /// l1 \[m\].
    pub crank: f64,
    /// l2 \[m\].
    pub link: f64,
    /// Side of the line A_i C_i on which B_i lies: the sign of (C - A) x (B - A).
    pub elbow: [f64; 3],
    /// Radius of the path \[m\].
    pub radius: f64,
    /// Revolutions a second \[Hz\].
    pub frequency: f64,
    /// Radial clearance of the joint B1 \[m\]; zero when it is ideal.
    pub clearance: f64,
}

impl MechanismGeometry {
    /// Reads the geometry of a scene with the names of the paper (A1, B1, C1, crank1, link1, platform).
    ///
    /// # Errors
    /// When the scene is not such a mechanism, or its path is no circle about the origin that starts on the x axis.
    pub fn of(scene: &Scene) -> Result<MechanismGeometry> {
        let found = MechanismGeometry::find(scene);
        found.ok_or_else(|| miette!("the scene is not the mechanism of the paper on its circle"))
    }

    fn find(scene: &Scene) -> Option<MechanismGeometry> {
        let path: &dyn Any = &*scene.drives.first()?.path;
        let circle: &Circle = path.downcast_ref()?;
        if circle.center != [0.0, 0.0] || circle.phase != 0.0 || circle.theta != 0.0 {
            return None;
        }
        let length = |name: &str| scene.bodies[scene.body(name)?].kind.length();
        // the end of a joint on a body, in the frame of that body
        let end_on = |joint: String, body: &str| -> Option<Vector> {
            let (joint, body) = (&scene.joints[scene.joint(&joint)?], scene.body(body)?);
            let mut ends = [joint.bearing, joint.journal].into_iter();
            let end = ends.find(|end| end.body == body)?;
            Some(scene.bodies[body].kind.points()[end.point].at)
        };
        let (mut base, mut platform) = ([Vector::zeros(); 3], [Vector::zeros(); 3]);
        let mut elbow = [0.0; 3];
        for i in 0..3 {
            base[i] = end_on(format!("A{}", i + 1), "ground")?;
            platform[i] = end_on(format!("C{}", i + 1), "platform")?;
            let pin = Sketched::Joint(scene.joint(&format!("B{}", i + 1))?);
            let pin = scene.initial.sketch.iter().find(|p| p.what == pin)?.at - base[i];
            let corner = Vector::new(circle.radius, 0.0) + platform[i] - base[i];
            elbow[i] = corner.perp(&pin).signum();
        }
        let contact = scene.joints[scene.joint("B1")?].contact();
        Some(MechanismGeometry {
            base,
            platform,
            crank: length("crank1")?,
            link: length("link1")?,
            elbow,
            radius: circle.radius,
            frequency: circle.rate / TAU,
            clearance: contact.map_or(0.0, |contact| contact.clearance),
        })
    }

    /// Pose (x, y, theta) of the ideal platform.
    pub fn pose(&self, t: f64) -> [f64; 3] {
        let (sin, cos) = (TAU * self.frequency * t).sin_cos();
        [self.radius * cos, self.radius * sin, 0.0]
    }

    /// Velocity along x of the ideal platform \[m/s\].
    pub fn velocity_x(&self, t: f64) -> f64 {
        -TAU * self.frequency * self.pose(t)[1]
    }

    /// Acceleration along x of the ideal platform \[m/s2\].
    pub fn acceleration_x(&self, t: f64) -> f64 {
        -(TAU * self.frequency).powi(2) * self.pose(t)[0]
    }

    /// C_i at a pose.
    fn corner(&self, leg: usize, pose: [f64; 3]) -> Vector {
        Vector::new(pose[0], pose[1]) + self.arm(leg, pose)
    }

    /// B_i of the ideal mechanism at a pose; NaN where the leg does not reach.
    pub fn pin(&self, leg: usize, pose: [f64; 3]) -> Vector {
        let a = self.base[leg];
        let d = self.corner(leg, pose) - a;
        let distance = d.norm();
        let along = (d.norm_squared() + self.crank.powi(2) - self.link.powi(2)) / (2.0 * distance);
        let aside = self.elbow[leg] * (self.crank.powi(2) - along * along).sqrt();
        a + (d * along + Vector::new(-d.y, d.x) * aside) / distance
    }

    /// The velocity Jacobian J of the three lengths by (x, y, theta), with the pins held.
    fn jacobian(&self, pose: [f64; 3]) -> Matrix3<f64> {
        Matrix3::from_fn(|leg, column| {
            let u = (self.corner(leg, pose) - self.pin(leg, pose)) / self.link;
            [u.x, u.y, self.arm(leg, pose).perp(&u)][column]
        })
    }

    /// sum_i |J^-1|_{xi} slack_i at time t \[m\]; infinite where J is singular.
    pub fn bound_x(&self, t: f64, slack: [f64; 3]) -> f64 {
        let Some(inverse) = self.jacobian(self.pose(t)).try_inverse() else {
            return f64::INFINITY;
        };
        (0..3).map(|i| inverse[(0, i)].abs() * slack[i]).sum()
    }

    /// The largest bound over one revolution for equal slacks, on 3600 poses \[m\].
    pub fn largest_bound_x(&self, slack: f64) -> f64 {
        let period = 1.0 / self.frequency;
        (0..3600)
            .map(|k| self.bound_x(period * f64::from(k) / 3600.0, [slack; 3]))
            .fold(0.0, f64::max)
    }

    fn arm(&self, leg: usize, pose: [f64; 3]) -> Vector {
        Rotation2::new(pose[2]) * self.platform[leg]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mechanism of Table 1 with a circumradius `fixed` of the fixed platform.
    fn table_1(fixed: f64, elbow: [f64; 3]) -> MechanismGeometry {
        let angles = [210.0_f64, 330.0, 90.0].map(f64::to_radians);
        let at = |radius: f64| angles.map(|a| Vector::new(a.cos(), a.sin()) * radius);
        MechanismGeometry {
            base: at(fixed),
            platform: at(0.112),
            crank: 0.245,
            link: 0.242,
            elbow,
            radius: 0.1,
            frequency: 1.0,
            clearance: 2e-5,
        }
    }

    #[test]
    fn legs_close_over_the_whole_path() {
        let g = table_1(0.4, [1.0; 3]);
        for k in 0..100 {
            let pose = g.pose(f64::from(k) / 100.0);
            for leg in 0..3 {
                let (b, c) = (g.pin(leg, pose), g.corner(leg, pose));
                // round-off of lengths below 1 m
                assert!(
                    ((b - c).norm() - g.link).abs() < 1e-14
                        && ((b - g.base[leg]).norm() - g.crank).abs() < 1e-14
                );
            }
        }
    }

    #[test]
    fn jacobian_is_the_derivative_of_the_leg_lengths() {
        let g = table_1(0.4, [1.0, -1.0, 1.0]);
        for pose in [[0.1, 0.0, 0.0], [-0.03, 0.09, 0.2], [0.02, -0.1, -0.4]] {
            let jacobian = g.jacobian(pose);
            for leg in 0..3 {
                let pin = g.pin(leg, pose);
                let length = |q: [f64; 3]| (g.corner(leg, q) - pin).norm();
                for k in 0..3 {
                    let step = 1e-6;
                    let (mut up, mut down) = (pose, pose);
                    up[k] += step;
                    down[k] -= step;
                    let difference = (length(up) - length(down)) / (2.0 * step);
                    // central difference: round-off 1e-16 / 1e-6 and truncation 1e-12 / 0.24^2
                    assert!((jacobian[(leg, k)] - difference).abs() < 1e-9, "{leg} {k}");
                    assert!(jacobian[(leg, k)] != 0.0);
                }
            }
        }
    }

    #[test]
    fn bounds_of_the_three_readings_of_the_geometry() {
        let equal = table_1(0.4, [-1.0; 3]).largest_bound_x(4e-5);
        let mirrored = table_1(0.4, [1.0; 3]).largest_bound_x(4e-5);
        let side = table_1(0.4 / 3f64.sqrt(), [-1.0; 3]).largest_bound_x(4e-5);
        let mixed = table_1(0.4, [1.0, -1.0, -1.0]).largest_bound_x(4e-5);
        // equal elbows stay below the 0.2 mm of the paper, the two other readings do not
        assert!(equal.max(mirrored) < 0.075e-3 && side > 2e-4 && mixed > 1e-3);
    }
}

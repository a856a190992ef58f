//! Ambrosio's modified Coulomb friction (eq. 26).

use super::{FrictionLaw, TangentialForce};

/// T = c_f d(|v_t|) F_n sign(v_t), d = 0 below v0, 1 above v1, linear between.
///
/// Eq. 26 is printed for v_t >= 0; with |v_t| and the sign it is odd, as friction has to be.
#[derive(Debug, Clone, Copy)]
pub struct Ambrosio {
    /// c_f.
    pub coefficient: f64,
    /// Slip where friction sets in \[m/s\].
    pub v0: f64,
    /// Slip where friction is full \[m/s\].
    pub v1: f64,
}

impl FrictionLaw for Ambrosio {
    fn force(&self, slip: f64, normal: f64) -> TangentialForce {
        let ramp = ((slip.abs() - self.v0) / (self.v1 - self.v0)).clamp(0.0, 1.0);
        let sliding = slip.abs() > self.v0 && slip.abs() < self.v1;
        let by_slip = if sliding {
            self.coefficient * normal / (self.v1 - self.v0)
        } else {
            0.0
        };
        let by_normal = self.coefficient * ramp * slip.signum();
        TangentialForce {
            value: by_normal * normal,
            by_slip,
            by_normal,
        }
    }

    fn creeps(&self, slip: f64) -> bool {
        slip != 0.0 && slip.abs() < self.v1
    }
}

//! Vectors of the plane: those of nalgebra, and what it does not have. nalgebra's `a.perp(&b)` is the out-of-plane component of a x b.

use nalgebra::{Complex, UnitComplex, Vector2};
use std::cell::Cell;
use std::f64::consts::TAU;

/// A vector of the plane.
pub type Vec2 = Vector2<f64>;

/// A rotation of the plane by an angle.
pub type Rotation = UnitComplex<f64>;

/// a turned by +90 degrees, exactly.
#[inline]
pub fn quarter_turn(a: Vec2) -> Vec2 {
    Vec2::new(-a.y, a.x)
}

/// The full turns nearest to an angle \[rad\].
#[inline]
pub fn full_turns(angle: f64) -> f64 {
    TAU * (angle / TAU).round()
}

/// Angles whose cosine and sine are kept.
const KEPT: usize = 16;

thread_local! {
    /// Angles with their cosines and sines.
    static TURNS: [Cell<[f64; 3]>; KEPT] = const { [const { Cell::new([f64::NAN; 3]) }; KEPT] };
}

/// Cosine and sine. All terms at a rigid body ask for those of its angle, several times in an evaluation, so the last few are kept:
/// computing them takes five times as long as finding them.
#[inline]
fn cosine_sine(angle: f64) -> [f64; 2] {
    let bits = angle.to_bits();
    // multiplication by 2^64 over the golden ratio spreads neighbouring angles over all places
    let place = bits.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> (64 - KEPT.ilog2());
    TURNS.with(|turns| {
        let kept = &turns[place as usize];
        let [known, cosine, sine] = kept.get();
        if known.to_bits() == bits {
            return [cosine, sine];
        }
        let (sine, cosine) = angle.sin_cos();
        kept.set([angle, cosine, sine]);
        [cosine, sine]
    })
}

/// The unit vector at an angle from the x axis.
#[inline]
pub fn unit(angle: f64) -> Vec2 {
    cosine_sine(angle).into()
}

/// The rotation by an angle.
#[inline]
pub fn rotation(angle: f64) -> Rotation {
    let [cosine, sine] = cosine_sine(angle);
    Rotation::new_unchecked(Complex::new(cosine, sine))
}

/// The entries `i` and `i + 1` of x.
#[inline]
pub fn pair(x: &[f64], i: usize) -> Vec2 {
    Vec2::new(x[i], x[i + 1])
}

//! Friction laws, one a file: a tangential force from slip and normal force, some with an internal state.

mod ambrosio;
mod bristle;
mod coulomb_stribeck;
mod elasto_plastic;
mod lugre;

pub use ambrosio::Ambrosio;
pub use bristle::Bristle;
pub use coulomb_stribeck::{CoulombStribeck, Stribeck};
pub use elasto_plastic::ElastoPlastic;
pub use lugre::LuGre;

use crate::document::{Fields, Key, Kind, SceneError};
use crate::system::InternalState;
use std::any::Any;
use std::fmt::Debug;
use std::sync::Arc;

/// A tangential force with its slopes.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct TangentialForce {
    /// Force against the slip \[N\], of the sign of the slip.
    pub value: f64,
    /// d(value)/d(slip) \[N s/m\].
    pub by_slip: f64,
    /// d(value)/d(normal force).
    pub by_normal: f64,
    /// d(value)/d(internal state).
    pub by_state: f64,
    /// How the internal state changes.
    pub rate: StateRate,
}

/// The rate of an internal state with its slopes.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct StateRate {
    /// The rate \[1/s of the state\].
    pub value: f64,
    /// d(value)/d(slip).
    pub by_slip: f64,
    /// d(value)/d(state) \[1/s\].
    pub by_state: f64,
}

/// A friction law. Its state, if it has one, is zero where the surfaces begin to touch.
pub trait FrictionLaw: Any + Debug + Send + Sync {
    /// Its internal state.
    fn state(&self) -> Option<InternalState> {
        None
    }
    /// The force with its slopes, for a slip \[m/s\], a normal force \[N\] and an internal state.
    fn force(&self, slip: f64, normal: f64, state: f64) -> TangentialForce;
    /// The energy that the state stores over the normal force \[m\], and its derivative by the state.
    fn stored(&self, _state: f64) -> [f64; 2] {
        [0.0; 2]
    }
    /// True for a slip at which a body that should stick slides, because the law has no other way to hold it.
    fn creeps(&self, _slip: f64) -> bool {
        false
    }
    /// True for a slip \[m/s\] at which the law may give energy, whatever its state.
    fn may_give_energy(&self, _slip: f64) -> bool {
        false
    }
    /// The key of its largest coefficient of friction, and the coefficient.
    fn largest_coefficient(&self) -> (&'static str, f64);
    /// Its parameters in words.
    fn describe(&self) -> String;
}

impl dyn FrictionLaw {
    /// The law as one of this kind, if it is one.
    pub fn get<T: FrictionLaw>(&self) -> Option<&T> {
        (self as &dyn Any).downcast_ref()
    }
}

/// A kind of friction law; none is read where it would not act.
pub type FrictionKind = Kind<fn(&Fields) -> Result<Option<Arc<dyn FrictionLaw>>, SceneError>>;

/// The kinds that a scene can name.
pub static FRICTIONS: [&FrictionKind; 4] = [
    &ambrosio::KIND,
    &coulomb_stribeck::KIND,
    &lugre::KIND,
    &elasto_plastic::KIND,
];

/// The key that all kinds have.
pub const SLIP: Key =
    Key::word("slip", &["paper", "material"], "which slip velocity enters").or("`\"material\"`");

//! What a scene can name.

use crate::contact::normal::{LAWS, NormalLawKind};
use crate::stepper::{SCHEMES, Scheme};

/// The kinds that a scene can name. A user of the library adds kinds of his own and reads scenes with
/// [`crate::scene::Scene::load_with`].
#[derive(Debug, Clone)]
pub struct Registry {
    /// Normal contact laws.
    pub laws: Vec<&'static NormalLawKind>,
    /// Integration schemes.
    pub schemes: Vec<&'static Scheme>,
}

impl Registry {
    /// Everything that the library has.
    pub fn standard() -> Registry {
        Registry {
            laws: LAWS.to_vec(),
            schemes: SCHEMES.to_vec(),
        }
    }

    /// The same with a normal contact law.
    #[must_use]
    pub fn with_law(mut self, law: &'static NormalLawKind) -> Registry {
        self.laws.push(law);
        self
    }

    /// The same with an integration scheme.
    #[must_use]
    pub fn with_scheme(mut self, scheme: &'static Scheme) -> Registry {
        self.schemes.push(scheme);
        self
    }
}

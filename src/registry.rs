//! What a scene can name.

use crate::body::{self, BodyKind};
use crate::contact::friction::{FRICTIONS, FrictionKind};
use crate::contact::normal::{LAWS, NormalLawKind};
use crate::interaction::{FORCES, ForceKind, JOINTS, JointKind, contact};
use crate::motion::{FUNCTIONS, FunctionKind};
use crate::stepper::{SCHEMES, Scheme};
use crate::table::{FORMATS, Format};

/// The kinds that a scene can name. A user of the library adds kinds of his own and reads scenes with
/// [`crate::scene::Scene::load_with`].
#[derive(Debug, Clone)]
pub struct Registry {
    /// Bodies.
    pub bodies: Vec<&'static BodyKind>,
    /// Joints.
    pub joints: Vec<&'static JointKind>,
    /// Springs and loads.
    pub forces: Vec<&'static ForceKind>,
    /// Functions of time.
    pub functions: Vec<&'static FunctionKind>,
    /// Normal contact laws.
    pub laws: Vec<&'static NormalLawKind>,
    /// Friction laws.
    pub frictions: Vec<&'static FrictionKind>,
    /// Integration schemes.
    pub schemes: Vec<&'static Scheme>,
    /// Formats of tables.
    pub formats: Vec<&'static Format>,
}

impl Registry {
    /// Everything that the library has.
    pub fn standard() -> Registry {
        Registry {
            bodies: body::KINDS.to_vec(),
            joints: JOINTS.to_vec(),
            forces: FORCES.to_vec(),
            functions: FUNCTIONS.to_vec(),
            laws: LAWS.to_vec(),
            frictions: FRICTIONS.to_vec(),
            schemes: SCHEMES.to_vec(),
            formats: FORMATS.to_vec(),
        }
    }

    /// The same with a kind of body.
    #[must_use]
    pub fn with_body(mut self, kind: &'static BodyKind) -> Registry {
        self.bodies.push(kind);
        self
    }

    /// The same with a kind of joint.
    #[must_use]
    pub fn with_joint(mut self, kind: &'static JointKind) -> Registry {
        self.joints.push(kind);
        self
    }

    /// The same with a kind of force.
    #[must_use]
    pub fn with_force(mut self, kind: &'static ForceKind) -> Registry {
        self.forces.push(kind);
        self
    }

    /// The same with a kind of function of time.
    #[must_use]
    pub fn with_function(mut self, kind: &'static FunctionKind) -> Registry {
        self.functions.push(kind);
        self
    }

    /// The same with a normal contact law.
    ///
    /// # Panics
    /// A key of the law has the name of one that every contact or another law has.
    #[must_use]
    pub fn with_law(mut self, law: &'static NormalLawKind) -> Registry {
        let known = self.laws.iter().flat_map(|law| law.keys);
        for key in known.chain(&contact::KEYS) {
            let taken = law.keys.iter().any(|own| own.name == key.name);
            assert!(!taken, "`{}` of {} is taken", key.name, law.name);
        }
        self.laws.push(law);
        self
    }

    /// The same with a friction law.
    #[must_use]
    pub fn with_friction(mut self, kind: &'static FrictionKind) -> Registry {
        self.frictions.push(kind);
        self
    }

    /// The same with an integration scheme.
    #[must_use]
    pub fn with_scheme(mut self, scheme: &'static Scheme) -> Registry {
        self.schemes.push(scheme);
        self
    }

    /// The same with a format of tables.
    #[must_use]
    pub fn with_format(mut self, format: &'static Format) -> Registry {
        self.formats.push(format);
        self
    }
}

//! The variants of a scene: each effect added to the rigid ideal mechanism, each removed from the full scene.

use super::effects::{Effect, effects};
use looselink::scene::{Scene, SceneError};

/// What a variant is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// The scene without any of its effects.
    Ideal,
    /// The rigid ideal mechanism with this effect and the one it needs.
    Added(Effect),
    /// The scene as it is.
    Full,
    /// The scene without this effect and those that need it.
    Removed(Effect),
}

/// A scene with some of its effects.
#[derive(Debug, Clone)]
pub struct Variant {
    /// What it is for.
    pub role: Role,
    /// The effects it has.
    pub effects: Vec<Effect>,
    /// The effects that the full scene has and this one has not.
    pub removed: Vec<Effect>,
    /// The scene, or why there is none.
    pub scene: Result<Scene, SceneError>,
}

/// All variants of a scene: the rigid ideal mechanism, what is added to it, the full scene, what is removed from it.
pub fn variants(scene: &Scene) -> Vec<Variant> {
    let present = effects(scene);
    let added = present.iter().map(|effect| Role::Added(*effect));
    let removed = present.iter().map(|effect| Role::Removed(*effect));
    std::iter::once(Role::Ideal)
        .chain(added)
        .chain([Role::Full])
        .chain(removed)
        .map(|role| Variant::new(scene, &present, role))
        .collect()
}

impl Variant {
    fn new(scene: &Scene, present: &[Effect], role: Role) -> Variant {
        let keeps = |effect: &Effect| match role {
            Role::Ideal => false,
            Role::Added(added) => *effect == added || added.needs() == Some(*effect),
            Role::Full => true,
            Role::Removed(removed) => *effect != removed && effect.needs() != Some(removed),
        };
        let (effects, removed): (Vec<Effect>, Vec<Effect>) = present.iter().partition(|e| keeps(e));
        // what an effect needs stands before it, so that an effect may be gone when its turn comes
        let without = |scene: Scene, effect: &Effect| match effect.is_in(&scene) {
            true => effect.removed_from(&scene),
            false => Ok(scene),
        };
        Variant {
            role,
            scene: removed.iter().try_fold(scene.clone(), without),
            effects,
            removed,
        }
    }

    /// Its name in tables: what is added, with what it needs, or what is removed, with what goes with it.
    pub fn name(&self) -> String {
        let (effect, all, joined) = match self.role {
            Role::Ideal | Role::Full => return self.short_name(),
            Role::Added(effect) => (effect, &self.effects, "on"),
            Role::Removed(effect) => (effect, &self.removed, "and"),
        };
        let others = all.iter().filter(|e| **e != effect);
        let others: Vec<&str> = others.map(|e| e.name()).collect();
        match others.is_empty() {
            true => self.short_name(),
            false => format!("{} ({joined} {})", self.short_name(), others.join(", ")),
        }
    }

    /// The same without what is needed or goes with it.
    pub fn short_name(&self) -> String {
        match self.role {
            Role::Ideal => "rigid ideal mechanism".to_owned(),
            Role::Full => "full scene".to_owned(),
            Role::Added(effect) => format!("+ {}", effect.name()),
            Role::Removed(effect) => format!("− {}", effect.name()),
        }
    }
}

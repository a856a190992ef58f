//! The variants of a scene: each effect added to the rigid ideal mechanism, each removed from the full scene.

use super::effects::{SceneEffect, effects};
use looselink::scene::{Scene, SceneError};

/// What a variant is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VariantRole {
    /// The scene without any of its effects.
    Ideal,
    /// The rigid ideal mechanism with this effect and the one it needs.
    Added(SceneEffect),
    /// The scene as it is.
    Full,
    /// The scene without this effect and those that need it.
    Removed(SceneEffect),
}

/// A scene with some of its effects.
#[derive(Debug, Clone)]
pub struct Variant {
    /// What it is for.
    pub role: VariantRole,
    /// The effects it has.
    pub effects: Vec<SceneEffect>,
    /// The effects that the full scene has and this one has not.
    pub removed: Vec<SceneEffect>,
    /// The scene, or why there is none.
    pub scene: Result<Scene, SceneError>,
}

/// All variants of a scene: the rigid ideal mechanism, what is added to it, the full scene, what is removed from it.
pub fn variants(scene: &Scene) -> Vec<Variant> {
    let present = effects(scene);
    let added = present.iter().map(|effect| VariantRole::Added(*effect));
    let removed = present.iter().map(|effect| VariantRole::Removed(*effect));
    std::iter::once(VariantRole::Ideal)
        .chain(added)
        .chain([VariantRole::Full])
        .chain(removed)
        .map(|role| Variant::new(scene, &present, role))
        .collect()
}

impl Variant {
    fn new(scene: &Scene, present: &[SceneEffect], role: VariantRole) -> Variant {
        let keeps = |effect: &SceneEffect| match role {
            VariantRole::Ideal => false,
            VariantRole::Added(added) => *effect == added || added.needs() == Some(*effect),
            VariantRole::Full => true,
            VariantRole::Removed(removed) => *effect != removed && effect.needs() != Some(removed),
        };
        let (effects, removed): (Vec<SceneEffect>, Vec<SceneEffect>) =
            present.iter().partition(|e| keeps(e));
        // what an effect needs stands before it, so that an effect may be gone when its turn comes
        let without = |scene: Scene, effect: &SceneEffect| match effect.is_in(&scene) {
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
            VariantRole::Ideal | VariantRole::Full => return self.short_name(),
            VariantRole::Added(effect) => (effect, &self.effects, "on"),
            VariantRole::Removed(effect) => (effect, &self.removed, "and"),
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
            VariantRole::Ideal => "rigid ideal mechanism".to_owned(),
            VariantRole::Full => "full scene".to_owned(),
            VariantRole::Added(effect) => format!("+ {}", effect.name()),
            VariantRole::Removed(effect) => format!("− {}", effect.name()),
        }
    }
}

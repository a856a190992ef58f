//! Text and overrides → scene, or a fault that can be shown.
#![cfg_attr(fuzzing, no_main)]

fuzz::target!("scene", fuzz::scenes, fuzz::scene, 4);

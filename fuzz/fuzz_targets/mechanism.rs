//! Scene → compiled mechanism, or a fault that can be shown.
#![cfg_attr(fuzzing, no_main)]

fuzz::target!("mechanism", fuzz::scenes, fuzz::mechanism, 8);

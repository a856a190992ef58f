//! Text → study → the scenes of its runs.
#![cfg_attr(fuzzing, no_main)]

fuzz::target!("study", fuzz::studies, fuzz::study, 4);

//! Hostile input, random mechanisms that found a fault, warnings: nothing may be wrong in silence.

mod input;
mod regressions;
mod warnings;

//! Hard cases, random mechanisms, hostile input, killed processes: nothing may be wrong in silence, and nothing may be lost.

mod cases;
mod input;
mod maps;
mod process;
mod random;
mod regressions;
mod warnings;

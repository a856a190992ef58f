//! Hard cases, maps and random mechanisms: nothing may be wrong in silence.

mod cases;
mod maps;
mod random;

//! The second implementation as a rival in studies.

pub mod ida;

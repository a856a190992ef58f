//! IDA as a rival in studies.

pub mod ida;
pub mod settings;

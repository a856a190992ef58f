//! What is compared, one file each. Every function returns rows that the tests assert and the report prints.

pub mod classes;
pub mod equations;
pub mod flexible;
pub mod impacts;
pub mod machines;
pub mod rigid;
pub mod scenes;
pub mod statistics;

//! Looselink against an independent implementation of the same equations.
//!
//! `reference-cpp` is a C++ program written from the equations alone. [`mod@reference`] wraps its C interface,
//! [`description`] reads a scene for it; the folder `compare` has one file for each thing that is compared. What `cargo
//! test` asserts and what the report prints are the same rows.
#![deny(unsafe_code)]
#![allow(
    missing_docs,
    reason = "fields mirror the C header, which documents them"
)]

pub mod channels;
pub mod check;
pub mod compare;
pub mod description;
pub mod embedding;
pub mod faults;
#[allow(unsafe_code, reason = "the only file that has any")]
mod ffi;
pub mod figures;
pub mod reference;
pub mod report;
pub mod trajectory;

//! Looselink against an independent implementation of the same equations.
//!
//! `reference-cpp` is a C++ program written from the paper, the equations and the description of the scene language.
//! [`mod@reference`] wraps its C interface; the folder `compare` has one file for each thing that is compared. The tests assert
//! the rows that the report prints.
#![deny(unsafe_code)]
#![allow(
    missing_docs,
    reason = "fields mirror the C header, which documents them"
)]

pub mod check;
pub mod compare;
pub mod embedding;
#[allow(unsafe_code, reason = "declarations of the library")]
mod ffi;
pub mod figures;
#[allow(unsafe_code, reason = "hands the equations to a library in C")]
pub mod ida_of_system;
#[allow(unsafe_code, reason = "the only file that calls the library")]
pub mod reference;
pub mod trajectory;

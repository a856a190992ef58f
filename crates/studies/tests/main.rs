//! Tests of the studies.

mod ablation;
mod precision;
#[expect(dead_code, reason = "the tests of the solver use the rest")]
#[path = "../../../tests/support.rs"]
mod support;
mod sweep;

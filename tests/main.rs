//! All integration tests, in one binary.

mod bathe;
mod contact;
mod differencing;
mod ideal;
mod joints;
mod link;
mod loose;
mod rrr;
mod support;
mod system;

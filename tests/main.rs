//! All integration tests, in one binary.

mod bad_input;
mod bad_mechanism;
mod balance;
mod bathe;
mod chain;
mod command_line;
mod contact;
mod differencing;
mod documents;
mod good_input;
mod hostile_input;
mod ideal;
mod joints;
mod language;
mod library;
mod link;
mod loose;
mod malformed;
mod mechanisms;
mod overrides;
mod published;
mod rrr;
mod support;
mod system;
mod terms;

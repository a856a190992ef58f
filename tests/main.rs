//! All integration tests, in one binary.

mod accuracy;
mod architecture;
mod bad_input;
mod bad_mechanism;
mod balance;
mod bits;
mod couples;
mod documents;
mod drift;
mod good_input;
mod hostile_input;
mod ideal;
mod language;
mod library;
mod loose;
mod malformed;
mod mechanisms;
mod methods;
mod overrides;
mod published;
mod registry;
mod rrr;
mod stability;
mod start;
mod support;
mod system;

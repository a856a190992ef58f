//! What the kernels are held to, in a binary of its own: links, contacts, constraints, forces, schemes. Mutation testing
//! runs it thousands of times, so it stays within seconds.

mod chain;
mod contact;
mod differencing;
mod friction;
mod joints;
mod link;
mod midpoint;
mod rounding;
#[path = "published/spectra.rs"]
mod spectra;
mod steppers;
mod terms;

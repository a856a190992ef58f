//! What the report shows, asserted: the same rows.

mod faults;
mod interface;
mod parts;
mod trajectories;

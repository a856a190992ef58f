//! What the report shows, asserted: the same rows.

mod faults;
mod ida;
mod interface;
mod parts;
mod trajectories;

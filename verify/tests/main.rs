//! What the report shows, asserted: the same rows.

mod ida;
mod interface;
mod parts;
mod trajectories;

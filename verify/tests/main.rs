//! What the report shows, asserted: the same rows.

mod ida;
mod interface;
mod means;
mod parts;
mod trajectories;

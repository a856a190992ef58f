//! Tests of the campaigns and of what they leave.

mod size;
mod stability;

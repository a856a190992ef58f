//! A changed token outdates the records that depend on it, by name; a changed comment none; pages say which.

mod format;
mod pages;
mod support;

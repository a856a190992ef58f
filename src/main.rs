//! The command line of Looselink.

fn main() {}

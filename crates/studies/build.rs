//! Tells the program which compiler made it, for reports of measured times.

use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let compiler = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    let version = Command::new(compiler).arg("--version").output();
    let version = version.ok().and_then(|o| String::from_utf8(o.stdout).ok());
    let version = version.unwrap_or_else(|| "unknown compiler".to_owned());
    println!("cargo::rustc-env=LOOSELINK_COMPILER={}", version.trim());
}

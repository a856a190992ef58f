//! Studies of a scene: how much processor time each accuracy costs ([`precision`]), and what each effect contributes and
//! costs ([`ablation`]).
#![forbid(unsafe_code)]

pub mod ablation;
pub mod machine;
pub mod precision;

/// Warnings of several runs as a part of a page in Markdown; empty where no run warns.
pub(crate) fn warning_list(warnings: &[String]) -> String {
    let lines = warnings.iter().map(|warning| format!("* {warning}\n"));
    match warnings.is_empty() {
        true => String::new(),
        false => format!("\nWarnings:\n\n{}", lines.collect::<String>()),
    }
}

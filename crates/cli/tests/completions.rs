//! Scripts that shells complete commands with.

use crate::command_line::{expect, looselink};

#[test]
fn every_shell_has_completions() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let output = looselink(&["completions", shell]);
        expect(&output, 0, "");
        let script = String::from_utf8_lossy(&output.stdout);
        for word in ["inspect", "accuracy"] {
            assert!(script.contains(word), "{shell}: {word}");
        }
    }
}

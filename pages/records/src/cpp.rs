//! The tokens of C++ code, without comments and white space.
//!
//! A scanner of its own: it has to tell comments from literals and nothing else, where a parser of C++ would be a library
//! larger than the project.

/// Tokens of a source file, each followed by a zero byte: words and numbers, literals, single signs. A directive of the
/// preprocessor ends with an empty token, because its line does.
pub fn tokens(text: &str) -> Vec<u8> {
    let mut out = Vec::new();
    let mut rest = text;
    let mut in_directive = false;
    while let Some(first) = rest.chars().next() {
        let length = if let Some(comment) = rest.strip_prefix("//") {
            2 + comment.find('\n').unwrap_or(comment.len())
        } else if let Some(comment) = rest.strip_prefix("/*") {
            2 + comment.find("*/").map_or(comment.len(), |end| end + 2)
        } else if rest.starts_with("\\\n") {
            2
        } else if first.is_whitespace() {
            if first == '\n' && std::mem::take(&mut in_directive) {
                out.push(0);
            }
            first.len_utf8()
        } else {
            let length = token(rest);
            in_directive |= first == '#';
            out.extend_from_slice(&rest.as_bytes()[..length]);
            out.push(0);
            length
        };
        rest = &rest[length..];
    }
    if in_directive {
        out.push(0);
    }
    out
}

/// Length of the token at the start.
fn token(text: &str) -> usize {
    // 1'000'000 is a number
    let is_number = text.starts_with(|c: char| c.is_ascii_digit());
    let goes_on = |c: char| c.is_alphanumeric() || c == '_' || is_number && c == '\'';
    let word = text.find(|c| !goes_on(c)).unwrap_or(text.len());
    let (prefix, rest) = text.split_at(word);
    match rest.chars().next() {
        Some('"') if prefix.ends_with('R') => word + raw(rest),
        Some(quote @ ('"' | '\'')) => word + quoted(rest, quote),
        Some(sign) if word == 0 => sign.len_utf8(),
        _ => word,
    }
}

/// Length of a literal up to the quote that ends it.
fn quoted(text: &str, quote: char) -> usize {
    let mut escaped = false;
    for (i, c) in text.char_indices().skip(1) {
        if c == quote && !escaped {
            return i + 1;
        }
        escaped = c == '\\' && !escaped;
    }
    text.len()
}

/// Length of `"name(...)name"`.
fn raw(text: &str) -> usize {
    let Some(open) = text.find('(') else {
        return text.len();
    };
    let end = format!("){}\"", &text[1..open]);
    text.find(&end).map_or(text.len(), |at| at + end.len())
}

#[cfg(test)]
mod tests {
    use super::tokens;

    #[test]
    fn comments_and_white_space_do_not_count() {
        let code = "double f(double x) { return 2.0 * x; } // twice\n";
        let other = "/* a\n * \"b */\ndouble f( double x )\n{\n    return 2.0*x;\n}\n";
        assert_eq!(tokens(code), tokens(other));
        assert_eq!(tokens("#define A \\\n  b\nc"), tokens("#define A b\nc"));
    }

    #[test]
    fn every_token_counts() {
        let code = "auto s = \"a // b\"; int n = 1'000;";
        for other in [
            "auto s = \"a // c\"; int n = 1'000;",
            "auto s = \"a  // b\"; int n = 1'000;",
            "auto s = \"a // b\"; int n = 1'001;",
            "auto s = \"a // b\"; intn = 1'000;",
            "auto s = \"a // b\"; int n = 1'000",
        ] {
            assert_ne!(tokens(code), tokens(other), "{other}");
        }
        assert_ne!(tokens("#define A b\nc"), tokens("#define A b c"));
    }

    #[test]
    fn a_literal_ends_where_it_ends() {
        for literal in ["\"\\\\\"", "\"\\\"\"", "'\"'", "L'\\''", "R\"x(\" // )x\""] {
            let with = |tail: &str| tokens(&format!("a = {literal}; {tail}"));
            assert_eq!(with("// gone"), with(""), "{literal}");
            assert_ne!(with("b"), with("c"), "{literal}");
        }
    }
}

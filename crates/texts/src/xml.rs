//! XML, SVG among it, and HTML.

use crate::harmless;

/// A text between tags or within the quotation marks of an attribute.
pub fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in harmless(text).chars() {
        match c {
            '&' => escaped += "&amp;",
            '<' => escaped += "&lt;",
            '>' => escaped += "&gt;",
            '"' => escaped += "&quot;",
            '\'' => escaped += "&apos;",
            c => escaped.push(c),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// A parser reads back what was written, between tags and in attributes.
        #[test]
        fn texts_are_read_back(text in any::<String>()) {
            let escaped = escaped(&text);
            let document = format!("<a b=\"{escaped}\">{escaped}</a>");
            let parsed = roxmltree::Document::parse(&document).unwrap();
            let root = parsed.root_element();
            prop_assert_eq!(root.text().unwrap_or_default(), harmless(&text));
            // an attribute is one line
            let line = harmless(&text).replace(['\n', '\t'], " ");
            prop_assert_eq!(root.attribute("b"), Some(&*line));
        }
    }
}

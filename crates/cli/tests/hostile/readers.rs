//! Files as programs read them that are not ours.

use html5gum::{DefaultEmitter, Token, Tokenizer};
use markdown::mdast::{InlineCode, Node, Text};
use markdown::{ParseOptions, to_mdast};
use std::fs;
use std::path::Path;

/// A text without blanks and the marks of code spans: where pictures and pages break lines is theirs.
pub fn squeezed(text: &str) -> String {
    let kept = text.chars().filter(|c| !c.is_whitespace() && *c != '`');
    kept.collect()
}

/// All texts of a picture, without blanks, which has no other elements than those that are drawn.
pub fn svg(path: &Path) -> String {
    let picture = fs::read_to_string(path).unwrap();
    let parsed = roxmltree::Document::parse(&picture);
    let parsed = parsed.unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let drawn = [
        "svg", "rect", "path", "polygon", "circle", "g", "text", "style",
    ];
    let elements = parsed.descendants().filter(|node| node.is_element());
    for element in elements {
        assert!(drawn.contains(&element.tag_name().name()), "{element:?}");
        assert!(element.attributes().all(|a| !a.name().starts_with("on")));
    }
    let is_shown = |node: &roxmltree::Node| node.is_text();
    let texts = parsed.descendants().filter(is_shown);
    squeezed(&texts.filter_map(|node| node.text()).collect::<String>())
}

/// The names of all elements of a page, and its data.
pub fn html(path: &Path) -> (Vec<String>, serde_json::Value) {
    let page = fs::read_to_string(path).unwrap();
    let (mut elements, mut data, mut is_data) = (Vec::new(), String::new(), false);
    let mut emitter = DefaultEmitter::default();
    // scripts and styles have no entities
    emitter.naively_switch_states(true);
    for Ok(token) in Tokenizer::new_with_emitter(&page, emitter) {
        match token {
            Token::StartTag(tag) => {
                let id = tag.attributes.get(&b"id"[..]);
                is_data = id.is_some_and(|id| ***id == *b"data");
                elements.push(String::from_utf8_lossy(&tag.name).into_owned());
            }
            Token::String(text) if is_data => data += &String::from_utf8_lossy(&text),
            Token::EndTag(_) => is_data = false,
            _ => {}
        }
    }
    (elements, serde_json::from_str(&data).unwrap())
}

/// The records of a table, all of one length, as texts.
pub fn csv(path: &Path) -> Vec<Vec<String>> {
    let reader = csv::ReaderBuilder::new().has_headers(false).from_path(path);
    let records = reader.unwrap().into_records();
    let cells = |record: csv::StringRecord| {
        for cell in record.iter().filter(|cell| cell.parse::<f64>().is_err()) {
            let begin = cell.trim_start();
            assert!(!begin.starts_with(['=', '+', '-', '@']), "{cell}");
            assert!(!cell.starts_with(['\t', '\r', '\n']), "{cell}");
        }
        let cells = record.iter().map(texts::csv::text_of);
        cells.map(str::to_owned).collect()
    };
    records.map(|record| cells(record.unwrap())).collect()
}

/// JSON.
pub fn json(path: &Path) -> serde_json::Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

/// The headings and cells of a page, without blanks; it has no HTML, no link, and one picture of its own.
pub fn markdown(path: &Path) -> Vec<String> {
    let page = fs::read_to_string(path).unwrap();
    let parsed = to_mdast(&page, &ParseOptions::gfm()).unwrap();
    let mut blocks = Vec::new();
    seen(&parsed, &mut blocks);
    blocks.iter().map(|block| squeezed(block)).collect()
}

fn seen(node: &Node, blocks: &mut Vec<String>) {
    match node {
        Node::Heading(_) | Node::TableCell(_) | Node::Paragraph(_) => blocks.push(String::new()),
        Node::Root(_) | Node::Table(_) | Node::TableRow(_) | Node::List(_) | Node::ListItem(_) => {}
        Node::Text(Text { value, .. }) | Node::InlineCode(InlineCode { value, .. }) => {
            *blocks.last_mut().unwrap() += value;
        }
        Node::Image(image) => {
            assert!(["sweep.svg", "precision.svg", "ablation.svg"].contains(&&*image.url));
        }
        other => panic!("{other:?}"),
    }
    for part in node.children().into_iter().flatten() {
        seen(part, blocks);
    }
}

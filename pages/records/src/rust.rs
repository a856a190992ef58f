//! The tokens of Rust code, without what no program is made of: comments, documentation, formatting, and tests inside
//! the code.

use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};
use quote::ToTokens;
use syn::visit_mut::{self, VisitMut};
use syn::{
    Arm, Attribute, Block, Expr, ExprClosure, Generics, Item, ReturnType, Stmt, WhereClause,
};

/// Tokens of a source file, each followed by a zero byte.
///
/// Left out are comments, documentation and modules for tests, `#[cfg(test)]`. What rustfmt adds or takes away as lines grow longer or
/// receive a comment is brought to one form: commas at the end of a list, braces around one expression, the semicolon
/// after a last `return`.
///
/// # Errors
/// Text that is not Rust.
pub fn tokens(text: &str) -> syn::Result<Vec<u8>> {
    let mut file = syn::parse_file(text)?;
    OneForm.visit_file_mut(&mut file);
    let mut out = Vec::new();
    write(without_last_commas(file.into_token_stream()), &mut out);
    Ok(out)
}

fn write(stream: TokenStream, out: &mut Vec<u8>) {
    for tree in stream {
        match tree {
            TokenTree::Group(group) => {
                let [open, close] = match group.delimiter() {
                    Delimiter::Parenthesis => ["(", ")"],
                    Delimiter::Brace => ["{", "}"],
                    Delimiter::Bracket => ["[", "]"],
                    Delimiter::None => ["", ""],
                };
                token(open, out);
                write(group.stream(), out);
                token(close, out);
            }
            other => token(&other.to_string(), out),
        }
    }
}

fn token(text: &str, out: &mut Vec<u8>) {
    out.extend_from_slice(text.as_bytes());
    out.push(0);
}

struct OneForm;

impl VisitMut for OneForm {
    fn visit_file_mut(&mut self, file: &mut syn::File) {
        file.items.retain(is_program);
        visit_mut::visit_file_mut(self, file);
    }

    fn visit_item_mut(&mut self, item: &mut Item) {
        if let Item::Mod(module) = item
            && let Some((_, items)) = &mut module.content
        {
            items.retain(is_program);
        }
        visit_mut::visit_item_mut(self, item);
    }

    fn visit_attributes_mut(&mut self, attributes: &mut Vec<Attribute>) {
        attributes.retain(|a| !a.path().is_ident("doc"));
    }

    fn visit_arm_mut(&mut self, arm: &mut Arm) {
        visit_mut::visit_arm_mut(self, arm);
        unwrap(&mut arm.body);
        arm.comma = None;
    }

    fn visit_expr_closure_mut(&mut self, closure: &mut ExprClosure) {
        visit_mut::visit_expr_closure_mut(self, closure);
        if matches!(closure.output, ReturnType::Default) {
            unwrap(&mut closure.body);
        }
        closure.inputs.pop_punct();
    }

    fn visit_block_mut(&mut self, block: &mut Block) {
        visit_mut::visit_block_mut(self, block);
        if let Some(Stmt::Expr(last, semicolon)) = block.stmts.last_mut()
            && matches!(last, Expr::Return(_) | Expr::Break(_) | Expr::Continue(_))
        {
            *semicolon = None;
        }
    }

    fn visit_where_clause_mut(&mut self, clause: &mut WhereClause) {
        visit_mut::visit_where_clause_mut(self, clause);
        clause.predicates.pop_punct();
    }

    fn visit_generics_mut(&mut self, generics: &mut Generics) {
        visit_mut::visit_generics_mut(self, generics);
        generics.params.pop_punct();
    }

    fn visit_angle_bracketed_generic_arguments_mut(
        &mut self,
        arguments: &mut syn::AngleBracketedGenericArguments,
    ) {
        visit_mut::visit_angle_bracketed_generic_arguments_mut(self, arguments);
        arguments.args.pop_punct();
    }
}

/// Braces around a single expression hold nothing together.
fn unwrap(body: &mut Expr) {
    if let Expr::Block(block) = body
        && block.attrs.is_empty()
        && block.label.is_none()
        && let [Stmt::Expr(inner, None)] = &block.block.stmts[..]
    {
        *body = inner.clone();
    }
}

/// False for a module that only tests are compiled with.
fn is_program(item: &Item) -> bool {
    let Item::Mod(module) = item else {
        return true;
    };
    !module.attrs.iter().any(|attribute| {
        attribute.path().is_ident("cfg")
            && attribute
                .parse_args::<syn::Ident>()
                .is_ok_and(|condition| condition == "test")
    })
}

/// The same tokens without commas at the end of a list. `(a,)`, where the comma makes the tuple, keeps it.
fn without_last_commas(stream: TokenStream) -> TokenStream {
    let trees: Vec<TokenTree> = stream.into_iter().collect();
    let shortened = trees.iter().enumerate().map(|(i, tree)| match tree {
        TokenTree::Group(group) => {
            let mut inside: Vec<TokenTree> =
                without_last_commas(group.stream()).into_iter().collect();
            let commas = inside.iter().filter(|t| is_punct(t, ',')).count();
            let ends = inside.last().is_some_and(|t| is_punct(t, ','));
            let makes_tuple =
                group.delimiter() == Delimiter::Parenthesis && commas == 1 && !is_list(&trees[..i]);
            if ends && !makes_tuple {
                inside.pop();
            }
            TokenTree::Group(Group::new(group.delimiter(), inside.into_iter().collect()))
        }
        other => other.clone(),
    });
    shortened.collect()
}

/// Words that a tuple may follow; behind any other word parentheses hold arguments or parameters.
const BEFORE_TUPLES: [&str; 14] = [
    "as", "break", "dyn", "else", "for", "if", "impl", "in", "let", "match", "return", "where",
    "while", "yield",
];

/// True when parentheses behind these tokens hold arguments or parameters, not a tuple.
fn is_list(before: &[TokenTree]) -> bool {
    match before {
        [.., TokenTree::Ident(word)] => !BEFORE_TUPLES.iter().any(|keyword| word == keyword),
        [.., arrow, end] if is_punct(end, '>') => !is_punct(arrow, '-') && !is_punct(arrow, '='),
        [.., bang] if is_punct(bang, '!') => true,
        [.., TokenTree::Group(group)] => group.delimiter() != Delimiter::Brace,
        _ => false,
    }
}

fn is_punct(tree: &TokenTree, sign: char) -> bool {
    matches!(tree, TokenTree::Punct(p) if p.as_char() == sign)
}

#[cfg(test)]
mod tests {
    use super::tokens;

    fn same(a: &str, b: &str) -> bool {
        tokens(a).unwrap() == tokens(b).unwrap()
    }

    #[test]
    fn comments_documentation_and_tests_do_not_count() {
        let code = "fn f(x: f64) -> f64 { 2.0 * x }";
        assert!(same(
            code,
            "//! A file.\n/// Doubles. /* yes */\nfn f(x: f64) -> f64 {\n    // why\n    2.0 * x\n}\n\
             #[cfg(test)]\nmod tests { fn g() {} }"
        ));
        assert!(!same(code, "#[cfg(unix)]\nfn f(x: f64) -> f64 { 2.0 * x }"));
        assert!(!same(code, "#[inline]\nfn f(x: f64) -> f64 { 2.0 * x }"));
    }

    #[test]
    fn what_rustfmt_adds_to_long_lines_does_not_count() {
        assert!(same("fn f() { g(a) }", "fn f() { g(\n a,\n) }"));
        assert!(same("fn f() { v![a, b] }", "fn f() { v![a, b,] }"));
        assert!(same("fn f() { v!(a) }", "fn f() { v!(a,) }"));
        assert!(same(
            "fn f() { match a { b => c, d => e } }",
            "fn f() { match a { b => { c } d => { e } } }"
        ));
        assert!(same(
            "fn f() { g(|x| x + 1) }",
            "fn f() { g(|x| { x + 1 }) }"
        ));
        assert!(same(
            "fn f<A, B>() where A: C {}",
            "fn f<A, B,>() where A: C, {}"
        ));
        assert!(same(
            "fn f() { let Some(x) = y else { return }; }",
            "fn f() { let Some(x) = y else { return; }; }"
        ));
    }

    #[test]
    fn every_token_of_the_program_counts() {
        let code = "fn f(x: f64) -> (f64,) { g(x * 1e-3, \"a b\") }";
        for other in [
            "fn f(x: f64) -> (f64) { g(x * 1e-3, \"a b\") }",
            "fn f(x: f64) -> (f64,) { g(x * 1e-4, \"a b\") }",
            "fn f(x: f64) -> (f64,) { g(x + 1e-3, \"a b\") }",
            "fn f(x: f64) -> (f64,) { g(x * 1e-3, \"a  b\") }",
            "fn f(x: f64) -> (f64,) { g(x * 1e-3, \"a b\"); }",
            "fn f(x: f64) -> (f64,) { g(x * 1e-3) }",
            "fn f(x: f64) -> (f64,) { {g(x * 1e-3, \"a b\")} }",
        ] {
            assert!(!same(code, other), "{other}");
        }
        assert!(!same("fn f() { a((b,)) }", "fn f() { a((b)) }"));
        assert!(!same("fn f() { return (b,) }", "fn f() { return (b) }"));
        assert!(!same("fn f() { a && b }", "fn f() { a & b }"));
    }
}

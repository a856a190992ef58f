//! What crosses the C interface, read from its header.

const HEADER: &str = include_str!("../../reference-cpp/include/reference.h");

/// What may go in: type, name, meaning.
#[rustfmt::skip]
pub const INPUTS: [(&str, &str, &str); 13] = [
    ("const char *", "text", "the scene, as the user wrote it"),
    ("const char *const *", "overrides", "assignments `path=value`, as of `--set`"),
    ("size_t", "count", "their number"),
    ("const ls_tolerances *", "tolerances", "of IDA, its limits, and the linear solver"),
    ("double", "t", "instant of a run's next row, or of a state at which equations are compared"),
    ("const double *", "q", "coordinates of a state at which equations are compared"),
    ("const double *", "v", "its velocities"),
    ("const double *", "z", "its impact velocities"),
    ("const double *", "elongations", "elongations of its Maxwell elements"),
    ("const ls_scene *", "scene", "the scene that the reference has read"),
    ("const ls_run *", "run", "the run that it has begun"),
    ("int32_t", "list", "which names are asked for"),
    ("size_t", "index", "which name or event of them"),
];

/// The fields of `ls_tolerances`.
#[rustfmt::skip]
pub const TOLERANCES: [&str; 8] =
    ["relative", "position", "velocity", "max_step", "newton", "max_order", "linear_solver", "max_steps"];

/// A function of the header.
#[derive(Debug, PartialEq)]
pub struct HeaderFunction {
    /// Its name.
    pub name: String,
    /// Types and names of what goes in; handles count as constant.
    pub inputs: Vec<(String, String)>,
    /// Names of what comes out; "" for what is returned.
    pub results: Vec<String>,
}

/// The functions of the header.
pub fn functions() -> Vec<HeaderFunction> {
    let text = plain(HEADER);
    let declarations = text.split(';').map(str::trim);
    declarations.filter_map(function).collect()
}

/// The fields of a structure of the header.
pub fn fields(structure: &str) -> Vec<String> {
    let text = plain(HEADER);
    let end = text.find(&format!("}} {structure};"));
    let body = &text[..end.expect("a structure of the header")];
    let body = &body[body.rfind('{').map_or(0, |i| i + 1)..];
    let declarations = body.split(';').filter(|d| !d.trim().is_empty());
    let names = declarations.flat_map(|d| d.split(','));
    names.map(|n| split(n).1).collect()
}

/// The header without comments, directives and braces of C++.
fn plain(header: &str) -> String {
    let mut text = String::new();
    for (i, part) in header.split("/*").enumerate() {
        text += match i {
            0 => part,
            _ => part.split_once("*/").map_or("", |(_, code)| code),
        };
    }
    let code = |line: &&str| !line.starts_with('#') && !line.starts_with("extern \"C\"");
    text.lines().filter(code).collect::<Vec<_>>().join(" ")
}

/// Type and name of a declaration.
fn split(declaration: &str) -> (String, String) {
    let declaration = declaration.trim();
    let place = declaration.rfind([' ', '*']).map_or(0, |i| i + 1);
    let bare = declaration[place..].split('[').next().unwrap_or_default();
    (declaration[..place].trim().to_owned(), bare.to_owned())
}

fn function(declaration: &str) -> Option<HeaderFunction> {
    let (head, arguments) = declaration.split_once('(')?;
    let mut function = HeaderFunction {
        name: split(head).1,
        inputs: Vec::new(),
        results: vec![String::new()],
    };
    for argument in arguments.trim_end_matches(')').split(',') {
        let (kind, name) = split(argument);
        match &*kind {
            "" => {}
            "ls_scene *" | "ls_run *" => function.inputs.push((format!("const {kind}"), name)),
            kind if kind.ends_with('*') && !kind.starts_with("const") => {
                function.results.push(name)
            }
            _ => function.inputs.push((kind, name)),
        }
    }
    Some(function)
}

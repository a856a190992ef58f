//! `looselink new`: a commented scene to start from, and the schema that editors check it with.

use super::failure::CommandFailure;
use super::schema;
use super::templates::{TEMPLATES, Template};
use super::terminal::{print, word};
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use folder::replace;
use std::path::{Path, PathBuf};

/// The schema beside the scene, which the first line of every template names.
const SCHEMA: &str = "looselink.schema.json";

#[derive(Debug, Args)]
pub struct Arguments {
    /// What to start from.
    #[arg(value_parser = template())]
    template: &'static Template,
    /// The scene file that is written; the schema is written beside it unless it is there.
    file: PathBuf,
    /// Replace an existing file, and the schema beside it.
    #[arg(long)]
    force: bool,
}

/// A template by its name.
fn template() -> impl TypedValueParser<Value = &'static Template> {
    let value = |template: &Template| PossibleValue::new(template.name).help(template.purpose);
    PossibleValuesParser::new(TEMPLATES.iter().map(value)).map(|name| {
        let mut templates = TEMPLATES.iter();
        let named = templates.find(|template| template.name == name);
        named.expect("the parser takes no other name")
    })
}

/// Writes the scene, and the schema before it: where there is a scene, there is a schema.
pub fn new(arguments: &Arguments) -> Result<(), CommandFailure> {
    let Arguments {
        template,
        file,
        force,
    } = arguments;
    if !force && file.symlink_metadata().is_ok() {
        let message = format!("`{}` exists already", file.display());
        return Err(CommandFailure::bad_input(message)
            .and("; choose another file, or replace it with --force"));
    }
    let beside = file.with_file_name(SCHEMA);
    if *force || !beside.exists() {
        replace(&beside, schema::text().as_bytes())?;
    }
    let stem = Path::new("out").join(file.file_stem().unwrap_or_default());
    let [typed, out] = [file, &stem].map(|path| word(path));
    replace(file, template.scene(&typed, &out).as_bytes())?;
    print(format!(
        "{typed}: {}\n\n  looselink inspect {typed}\n  looselink run {typed} --out {out} --view\n",
        template.purpose
    ))
}

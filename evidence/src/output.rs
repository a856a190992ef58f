//! Pages and pictures on their way from records to files.

use miette::{IntoDiagnostic, Result, WrapErr, miette};
use minijinja::{Environment, Value, context, path_loader};
use paper_figures::environment;
use plot::Figure;
use records::{Origin, Record};
use serde::Serialize;
use serde::de::{DeserializeOwned, IgnoredAny};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The folder of the tracked pictures.
const PICTURES: &str = "evidence/pictures";

/// The records in `evidence/data`.
pub struct Data {
    root: PathBuf,
}

impl Data {
    /// Those below this root of a workspace.
    pub fn of(root: &Path) -> Data {
        let root = root.to_owned();
        Data { root }
    }

    /// Root of the workspace.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// True once the campaign has been recorded.
    pub fn has(&self, campaign: &str) -> bool {
        path(&self.root, campaign).exists()
    }

    /// When and at which commit these campaigns were recorded, the latest first.
    ///
    /// # Errors
    /// As [`Data::read`].
    pub fn recorded<'a>(&self, campaigns: impl Iterator<Item = &'a str>) -> Result<Vec<Value>> {
        let mut recorded: BTreeMap<_, BTreeSet<&str>> = BTreeMap::new();
        for name in campaigns {
            let Origin { date, commit, .. } = self.read::<IgnoredAny>(name)?.origin;
            recorded.entry((date, commit)).or_default().insert(name);
        }
        let one = |((date, commit), campaigns)| context! { date, commit, campaigns };
        Ok(recorded.into_iter().rev().map(one).collect())
    }

    /// The record of a campaign.
    ///
    /// # Errors
    /// A record that is missing or of another form.
    pub fn read<T: DeserializeOwned>(&self, campaign: &str) -> Result<Record<T>> {
        let path = path(&self.root, campaign);
        Record::read(&path).wrap_err_with(|| {
            format!("`cargo run --release -p evidence -- record {campaign}` makes it")
        })
    }
}

/// The file of a campaign.
pub fn path(root: &Path, campaign: &str) -> PathBuf {
    root.join(format!("evidence/data/{campaign}.json"))
}

/// Files that are rendered, by their path from the root of the workspace.
pub struct Output {
    templates: Environment<'static>,
    contexts: BTreeMap<String, Value>,
    /// Tracked pages and pictures.
    pub tracked: BTreeMap<String, String>,
    /// Pages of the site with the long tables, by their names.
    pub site: BTreeMap<String, String>,
    /// Pictures that nothing gives any more.
    stale: Vec<String>,
}

impl Output {
    /// Nothing rendered yet; templates are those below this root of a workspace.
    pub fn new(root: &Path) -> Output {
        let mut templates = environment();
        templates.set_loader(path_loader(root.join("evidence/templates")));
        Output {
            templates,
            contexts: BTreeMap::new(),
            tracked: BTreeMap::new(),
            site: BTreeMap::new(),
            stale: Vec::new(),
        }
    }

    /// A tracked page, made by the template `<template>` with the names in `context`. Pages that are rendered later find these
    /// names below that of the template.
    ///
    /// # Errors
    /// A template that is missing or asks for a name that is not in the context.
    pub fn page(&mut self, path: &str, template: &str, context: impl Serialize) -> Result<()> {
        let context = Value::from_serialize(context);
        let text = self.rendered(template, &context)?;
        let name = template.trim_end_matches(".md").to_owned();
        self.contexts.insert(name, context);
        keep(&mut self.tracked, path, text)
    }

    /// A tracked page about other pages: its names are those of the templates rendered so far, and `recorded`.
    ///
    /// # Errors
    /// As [`Output::page`].
    pub fn page_of_pages(&mut self, path: &str, template: &str, recorded: &[Value]) -> Result<()> {
        let text = self.rendered(
            template,
            context! { recorded, ..Value::from_serialize(&self.contexts) },
        )?;
        keep(&mut self.tracked, path, text)
    }

    /// Finds the pictures below this root that nothing gives any more, once all pages have been rendered.
    ///
    /// # Errors
    /// A folder that cannot be read.
    pub fn find_stale(&mut self, root: &Path) -> Result<()> {
        let mut folders = vec![root.join(PICTURES)];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).into_diagnostic()? {
                let path = entry.into_diagnostic()?.path();
                let name = path.strip_prefix(root).unwrap_or(&path);
                let name = name.display().to_string();
                if path.is_dir() {
                    folders.push(path);
                } else if !self.tracked.contains_key(&name) {
                    self.stale.push(name);
                }
            }
        }
        Ok(())
    }

    /// A page of the site.
    ///
    /// # Errors
    /// As [`Output::page`].
    pub fn site_page(&mut self, name: &str, template: &str, context: impl Serialize) -> Result<()> {
        let text = self.rendered(template, context)?;
        keep(&mut self.site, name, text)
    }

    /// The picture `<name>.svg` below `evidence/pictures`.
    ///
    /// # Errors
    /// A name that another picture has.
    pub fn picture(&mut self, name: &str, figure: &Figure) -> Result<()> {
        let path = format!("{PICTURES}/{name}.svg");
        keep(&mut self.tracked, &path, plot::svg(figure))
    }

    fn rendered(&self, template: &str, context: impl Serialize) -> Result<String> {
        let page = self.templates.get_template(template);
        // the message of minijinja has the line of the template and what it asked for
        let text = page.and_then(|page| page.render(context));
        text.map_err(|e| miette!("evidence/templates/{template}: {e:#}"))
    }

    /// Writes what differs from the files below this root, and deletes what nothing gives any more; the paths of those that differed.
    ///
    /// # Errors
    /// A file that cannot be written or deleted.
    pub fn write(&self, root: &Path) -> Result<Vec<String>> {
        let changed = self.differing(root);
        for path in &changed {
            let file = root.join(path);
            let folder = file.parent().unwrap_or(root);
            let done = match self.tracked.get(path) {
                Some(text) => fs::create_dir_all(folder).and_then(|()| fs::write(&file, text)),
                None => fs::remove_file(&file),
            };
            done.into_diagnostic()
                .wrap_err_with(|| format!("cannot write {path}"))?;
        }
        Ok(changed)
    }

    /// Paths of the files below this root that are not what their data give, and of the pictures that nothing gives any more.
    pub fn differing(&self, root: &Path) -> Vec<String> {
        let differs = |(path, text): &(&String, &String)| {
            !fs::read_to_string(root.join(path)).is_ok_and(|there| there == **text)
        };
        let differing = self.tracked.iter().filter(differs).map(|(path, _)| path);
        differing.chain(&self.stale).cloned().collect()
    }

    /// Writes the pages of the site.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write_site(&self, folder: &Path) -> Result<()> {
        fs::create_dir_all(folder).into_diagnostic()?;
        for (name, text) in &self.site {
            fs::write(folder.join(name), text)
                .into_diagnostic()
                .wrap_err_with(|| format!("cannot write {name}"))?;
        }
        Ok(())
    }
}

/// The sentence on every page that says which version its numbers belong to.
pub fn stamp(origin: &Origin) -> String {
    let Origin {
        version,
        commit,
        date,
        machine,
        seeds,
        seconds,
    } = origin;
    let duration = seconds.map_or(String::new(), |s| format!(", in {} min", (s / 60.0).ceil()));
    format!(
        "Measured at version {version}, commit {commit}, on {date}{duration}; seeds: {seeds}; machine: {machine}."
    )
}

fn keep(files: &mut BTreeMap<String, String>, path: &str, text: String) -> Result<()> {
    match files.insert(path.to_owned(), text) {
        None => Ok(()),
        Some(_) => Err(miette!("{path} is rendered twice")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_that_nothing_gives_are_deleted_and_others_written() {
        let root = tempfile::tempdir().unwrap();
        let stale = root.path().join(PICTURES).join("page/stale.svg");
        fs::create_dir_all(stale.parent().unwrap()).unwrap();
        fs::write(&stale, "").unwrap();
        let mut output = Output::new(root.path());
        let figure = Figure::grid(Vec::new(), 1, String::new());
        output.picture("page/kept", &figure).unwrap();
        output.find_stale(root.path()).unwrap();
        let names = ["kept", "stale"].map(|name| format!("{PICTURES}/page/{name}.svg"));
        assert_eq!(output.differing(root.path()), names);
        output.write(root.path()).unwrap();
        assert!(root.path().join(&names[0]).exists() && !stale.exists());
    }
}

//! `looselink view`

use super::failure::CommandFailure;
use super::print;
use clap::Args;
use folder::{naming, replace};
use std::fs;
use std::path::{Path, PathBuf};
use view::frames::frames;
use view::{StoredRun, ViewError, keep_page, page};

#[derive(Debug, Args)]
pub struct Arguments {
    /// The folder of a result.
    dir: PathBuf,
    /// Show another result as the ghost of this one, for example the ideal mechanism.
    #[arg(long, value_name = "DIR")]
    ghost: Option<PathBuf>,
    /// Write the page to this HTML file instead of `view.html` in the folder.
    #[arg(short, long, value_name = "FILE", value_parser = html)]
    output: Option<PathBuf>,
    /// Write SVG pictures, `frame-0000.svg` and so on, into this folder instead of the page.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["ghost", "output"])]
    frames: Option<PathBuf>,
    /// Number of pictures.
    #[arg(long, value_name = "N", default_value_t = 100, requires = "frames", value_parser = clap::value_parser!(u32).range(1..))]
    count: u32,
}

/// The page is no other file.
fn html(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path
        .extension()
        .is_some_and(|extension| extension == "html")
    {
        true => Ok(path),
        false => Err("the page needs a name that ends in .html".to_owned()),
    }
}

/// Writes the page, or the pictures.
pub fn view(arguments: &Arguments) -> Result<(), CommandFailure> {
    let Arguments { dir, .. } = arguments;
    if let Some(folder) = &arguments.frames {
        return pictures(&StoredRun::load(dir)?, folder, arguments.count as usize);
    }
    let ghost = arguments.ghost.as_deref().map(StoredRun::load).transpose();
    let path = match &arguments.output {
        Some(path) => {
            let runs = std::iter::once(StoredRun::load(dir)?).chain(ghost?);
            let runs: Vec<StoredRun> = runs.collect();
            replace(path, page(&runs).as_bytes())?;
            path.clone()
        }
        None => keep_page(dir, ghost?)?,
    };
    print(format!("open `{}` in a browser\n", path.display()))
}

/// Writes pictures into a folder that has none yet: those of another series would get into a film.
fn pictures(run: &StoredRun, folder: &Path, count: usize) -> Result<(), CommandFailure> {
    let cannot = |e| ViewError::from(naming(folder)(e));
    fs::create_dir_all(folder).map_err(cannot)?;
    for entry in fs::read_dir(folder).map_err(cannot)? {
        let name = entry.map_err(cannot)?.file_name();
        if name.to_string_lossy().starts_with("frame-") {
            let (folder, name) = (folder.display(), name.display());
            let message = format!("`{folder}` holds pictures already (`{name}`)");
            return Err(CommandFailure::bad_input(message).and("; choose another folder"));
        }
    }
    for (k, picture) in frames(run, count).iter().enumerate() {
        replace(
            &folder.join(format!("frame-{k:04}.svg")),
            picture.as_bytes(),
        )?;
    }
    print(format!("{count} pictures in `{}`\n", folder.display()))
}

//! `looselink view`

use super::failure::CommandFailure;
use super::print;
use clap::Args;
use looselink::output::naming;
use std::fs;
use std::path::{Path, PathBuf};
use view::frames::frames;
use view::{StoredRun, ViewError, page};

/// The file of the page in the folder of the result.
pub const PAGE: &str = "view.html";

#[derive(Debug, Args)]
pub struct Arguments {
    /// The folder of a result.
    dir: PathBuf,
    /// Show another result as the ghost of this one, for example the ideal mechanism.
    #[arg(long, value_name = "DIR")]
    ghost: Option<PathBuf>,
    /// Write the page to this file instead of `view.html` in the folder.
    #[arg(short, long, value_name = "FILE", conflicts_with = "frames")]
    output: Option<PathBuf>,
    /// Write SVG pictures, `frame-0000.svg` and so on, into this folder instead of the page.
    #[arg(long, value_name = "DIR")]
    frames: Option<PathBuf>,
    /// Number of pictures.
    #[arg(long, value_name = "N", default_value_t = 100, requires = "frames", value_parser = clap::value_parser!(u32).range(1..))]
    count: u32,
}

/// Writes the page, or the pictures.
pub fn view(arguments: &Arguments) -> Result<(), CommandFailure> {
    let run = StoredRun::load(&arguments.dir)?;
    if let Some(folder) = &arguments.frames {
        let pictures = frames(&run, arguments.count as usize);
        fs::create_dir_all(folder).map_err(|e| ViewError::from(naming(folder)(e)))?;
        for (k, picture) in pictures.iter().enumerate() {
            write(&folder.join(format!("frame-{k:04}.svg")), picture)?;
        }
        return print(format!(
            "{} pictures in `{}`\n",
            pictures.len(),
            folder.display()
        ));
    }
    let ghost = arguments.ghost.iter().map(|dir| StoredRun::load(dir));
    let runs = std::iter::once(Ok(run)).chain(ghost);
    let runs: Vec<StoredRun> = runs.collect::<Result<_, _>>()?;
    let own = || arguments.dir.join(PAGE);
    let path = arguments.output.clone().unwrap_or_else(own);
    write(&path, &page(&runs)?)?;
    print(format!("open `{}` in a browser\n", path.display()))
}

/// Writes the page of a result that is complete or was stopped, into its folder.
pub fn beside(dir: &Path) -> Result<PathBuf, CommandFailure> {
    let path = dir.join(PAGE);
    write(&path, &page(&[StoredRun::load(dir)?])?)?;
    Ok(path)
}

fn write(path: &Path, text: &str) -> Result<(), ViewError> {
    Ok(fs::write(path, text).map_err(naming(path))?)
}

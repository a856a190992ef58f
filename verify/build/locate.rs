//! Where Eigen and SUNDIALS are: environment first, then the usual places of Debian, Fedora and Homebrew.

use std::env;
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

/// Environment variables that name places.
pub const VARIABLES: [&str; 4] = [
    "EIGEN_INCLUDE_DIR",
    "SUNDIALS_DIR",
    "TOMLPLUSPLUS_INCLUDE_DIR",
    "SUITESPARSE_INCLUDE_DIR",
];

const PREFIXES: [&str; 4] = ["/usr", "/usr/local", "/opt/homebrew", "/opt/local"];

/// What was found.
pub struct Libraries {
    /// Folders for the compiler.
    pub includes: Vec<PathBuf>,
    /// Folder of the SUNDIALS libraries where the linker does not look by itself.
    pub folder: Option<PathBuf>,
    /// Version of Eigen, such as 3.4.0.
    pub eigen: String,
    /// Major version of SUNDIALS.
    pub sundials: u32,
}

/// What was not found.
pub struct Missing(String);

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(
            f,
            "{}\n\n\
             verify compares Looselink with a C++ program that needs Eigen 3.3 or newer, SUNDIALS 6 or 7 with KLU, and\n\
             toml++ 3.\n\
             Debian, Ubuntu:  apt-get install g++ libeigen3-dev libsundials-dev libsuitesparse-dev libtomlplusplus-dev\n\
             Fedora:          dnf install gcc-c++ eigen3-devel sundials-devel suitesparse-devel tomlplusplus-devel\n\
             macOS:           brew install eigen sundials suite-sparse tomlplusplus\n\
             Elsewhere:       EIGEN_INCLUDE_DIR is the folder that contains Eigen/Core, SUNDIALS_DIR the one that\n\
             \x20                contains include/ida/ida.h and lib/, TOMLPLUSPLUS_INCLUDE_DIR the one that contains\n\
             \x20                toml++/toml.h, SUITESPARSE_INCLUDE_DIR the one that contains klu.h\n\
             The other packages of this workspace need none of these.",
            self.0
        )
    }
}

impl Libraries {
    /// Libraries to link, in an order that a linker of archives accepts.
    pub fn names(&self) -> &'static [&'static str] {
        if self.sundials >= 7 {
            &[
                "sundials_ida",
                "sundials_sunlinsolklu",
                "sundials_sunlinsoldense",
                "sundials_sunmatrixsparse",
                "sundials_sunmatrixdense",
                "sundials_nvecserial",
                "sundials_core",
                "klu",
            ]
        } else {
            &[
                "sundials_ida",
                "sundials_sunlinsolklu",
                "sundials_sunlinsoldense",
                "sundials_sunmatrixsparse",
                "sundials_sunmatrixdense",
                "sundials_nvecserial",
                "sundials_generic",
                "klu",
            ]
        }
    }
}

/// Finds all libraries.
pub fn libraries() -> Result<Libraries, Missing> {
    let eigen = header("EIGEN_INCLUDE_DIR", "Eigen/Core", "eigen3", "Eigen")?;
    let toml = header("TOMLPLUSPLUS_INCLUDE_DIR", "toml++/toml.h", "", "toml++")?;
    let klu = header(
        "SUITESPARSE_INCLUDE_DIR",
        "klu.h",
        "suitesparse",
        "SuiteSparse's KLU",
    )?;
    let version = eigen_version(&eigen);
    let (prefix, include) = sundials()?;
    let config = include.join("sundials/sundials_config.h");
    let major = number(&config, "SUNDIALS_VERSION_MAJOR").unwrap_or(0);
    if !(6..=7).contains(&major) {
        return Err(Missing(format!(
            "SUNDIALS in {} is of version {major}; 6 or 7 is needed.",
            prefix.display()
        )));
    }
    let mut includes = vec![eigen, include, toml, klu];
    includes.extend(mpi(&config));
    Ok(Libraries {
        includes,
        folder: library_folder(&prefix),
        eigen: version,
        sundials: major,
    })
}

/// The folder that contains a header: the one that a variable names, or a usual one, or `below` in a usual one.
fn header(variable: &str, file: &str, below: &str, library: &str) -> Result<PathBuf, Missing> {
    let usual = PREFIXES.iter().map(|p| Path::new(p).join("include"));
    let places = match env::var_os(variable) {
        Some(place) => vec![PathBuf::from(place)],
        None => usual.flat_map(|p| [p.join(below), p]).collect(),
    };
    find(places, file, library)
}

/// Prefix and folder of headers.
fn sundials() -> Result<(PathBuf, PathBuf), Missing> {
    let given = env::var_os("SUNDIALS_DIR").map(PathBuf::from);
    let prefixes = given.map_or_else(
        || PREFIXES.iter().map(PathBuf::from).collect(),
        |prefix| vec![prefix],
    );
    for prefix in &prefixes {
        // Fedora puts the headers one folder deeper
        for include in ["include", "include/sundials"] {
            let include = prefix.join(include);
            if include.join("ida/ida.h").is_file() {
                return Ok((prefix.clone(), include));
            }
        }
    }
    Err(not_found(&prefixes, "include/ida/ida.h", "SUNDIALS"))
}

/// The linker knows the folders under /usr.
fn library_folder(prefix: &Path) -> Option<PathBuf> {
    if prefix == Path::new("/usr") {
        return None;
    }
    ["lib", "lib64"]
        .iter()
        .map(|lib| prefix.join(lib))
        .find(|folder| folder.is_dir())
}

/// SUNDIALS 7 with MPI includes mpi.h, although nothing here calls it.
fn mpi(config: &Path) -> Option<PathBuf> {
    let enabled = number(config, "SUNDIALS_MPI_ENABLED")? == 1;
    let places = [
        "/usr/lib/x86_64-linux-gnu/openmpi/include",
        "/usr/lib/aarch64-linux-gnu/openmpi/include",
        "/usr/include/openmpi-x86_64",
        "/usr/include/openmpi-aarch64",
        "/opt/homebrew/include",
        "/usr/local/include",
    ];
    enabled
        .then(|| places.map(PathBuf::from))?
        .into_iter()
        .find(|place| place.join("mpi.h").is_file())
}

fn eigen_version(include: &Path) -> String {
    let parts = ["WORLD", "MAJOR", "MINOR"].map(|part| {
        let macro_name = format!("EIGEN_{part}_VERSION");
        // up to 3.4 here, later in a file of its own
        ["Eigen/src/Core/util/Macros.h", "Eigen/Version"]
            .iter()
            .find_map(|file| number(&include.join(file), &macro_name))
    });
    match parts {
        [Some(world), Some(major), Some(minor)] => format!("{world}.{major}.{minor}"),
        _ => "of unknown version".to_owned(),
    }
}

/// The number that a header defines a macro as.
fn number(header: &Path, name: &str) -> Option<u32> {
    let text = fs::read_to_string(header).ok()?;
    text.lines().find_map(|line| {
        let mut words = line.split_whitespace();
        let defines = words.next() == Some("#define") && words.next() == Some(name);
        defines.then(|| words.next()?.parse().ok())?
    })
}

fn find(places: Vec<PathBuf>, file: &str, library: &str) -> Result<PathBuf, Missing> {
    match places.iter().find(|place| place.join(file).is_file()) {
        Some(place) => Ok(place.clone()),
        None => Err(not_found(&places, file, library)),
    }
}

fn not_found(places: &[PathBuf], file: &str, library: &str) -> Missing {
    let tried: Vec<String> = places.iter().map(|p| p.display().to_string()).collect();
    Missing(format!(
        "{library} is not there: no {file} in {}.",
        tried.join(", ")
    ))
}

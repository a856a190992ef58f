#!/usr/bin/env bash
# Random input to the reader of scenes, the compiler and the reader of studies, so many seconds each, from the seeds and
# from what earlier runs have kept in fuzz/corpus; writes the record evidence/data/fuzz.json, which belongs to the commit
# that is checked out. Stable Rust will do: RUSTC_BOOTSTRAP lets it instrument for coverage.
#
#   cargo install cargo-fuzz
#   fuzz/run.sh 1200 1800 600
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=("${1:-1200}" "${2:-1800}" "${3:-600}")
export RUSTC_BOOTSTRAP=1
# libraries too, which the profile of the programs leaves as they are: twice as many inputs a second
export RUSTFLAGS=-Copt-level=3

cargo fuzz --version > /dev/null 2>&1 || {
    echo "cargo-fuzz is missing: cargo install cargo-fuzz" >&2
    exit 2
}
[ -z "$(git status --porcelain)" ] || {
    echo "the record belongs to a commit: commit the changes first" >&2
    exit 2
}
commit=$(git rev-parse --short=12 HEAD)
version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -1)
processor=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1)
record=evidence/data/fuzz.json
mkdir -p fuzz/corpus fuzz/artifacts/{scene,mechanism,study}

# seconds an input, MiB of memory, bytes of an input
limits=(-timeout=5 -rss_limit_mb=1024 -max_len=16384)

# Writes the seeds and the dictionary, runs, and leaves what was counted in variables named after the target.
fuzz() {
    local target=$1 seconds=$2 log=fuzz/corpus/$1.log
    # no seed is lost to the dictionary: a run without inputs writes both
    cargo fuzz run --sanitizer none "$target" -- -runs=0 > /dev/null 2>&1
    cargo fuzz run --sanitizer none "$target" -- "${limits[@]}" -dict="fuzz/corpus/$target.dict" \
        -max_total_time="$seconds" -print_final_stats=1 > "$log" 2>&1 || true
    executed=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
    peak=$(sed -n 's/^stat::peak_rss_mb: *//p' "$log")
    slowest=$(sed -n 's/^stat::slowest_unit_time_sec: *//p' "$log")
    edges=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -1)
    took=$(sed -n 's/^Done [0-9]* runs in \([0-9]*\) second.*/\1/p' "$log")
    open=$(find "fuzz/artifacts/$target" -type f | wc -l)
}

result() {
    printf '{"target":"%s","inputs":%s,"seconds":%s,"edges_covered":%s,"slowest_input_seconds":%s,"peak_memory_mib":%s,"open_failures":%s}' \
        "$1" "${executed:-0}" "${took:-0}" "${edges:-0}" "${slowest:-0}" "${peak:-0}" "$open"
}

SECONDS=0
fuzz scene "${seconds[0]}" && scene=$(result scene)
fuzz mechanism "${seconds[1]}" && mechanism=$(result mechanism)
fuzz study "${seconds[2]}" && study=$(result study)
found=$(sed 's/.*/"&"/' fuzz/found.txt | paste -sd,)
cat > "$record.draft" << END
{"origin": {
  "version": "$version",
  "commit": "$commit",
  "date": "$(date -u +%F)",
  "machine": "$processor",
  "seeds": "none",
  "seconds": $SECONDS
},
"results": {
"command": "fuzz/run.sh ${seconds[*]}",
"engine": "libFuzzer (cargo-fuzz), mutation by line and value and by byte",
"limits": "${limits[*]}",
"targets": [
$scene,
$mechanism,
$study
],
"found_and_fixed": [$found]
}}
END
# the earlier record stays until this one is whole
mv "$record.draft" "$record"
cat "$record"

#!/usr/bin/env bash
# Random input to the reader of scenes, the compiler and the reader of studies, so many seconds each, from the seeds and
# from what earlier runs have kept in fuzz/corpus; writes pages/stability/records/fuzz.json. Stable Rust will do: RUSTC_BOOTSTRAP
# lets it instrument for coverage.
#
#   cargo install cargo-fuzz
#   fuzz/run.sh 1200 1800 600
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=("${1:-1200}" "${2:-1800}" "${3:-600}")
export RUSTC_BOOTSTRAP=1

cargo fuzz --version > /dev/null 2>&1 || {
    echo "cargo-fuzz is missing: cargo install cargo-fuzz" >&2
    exit 2
}
# what is fuzzed, for pages/records/state
digests=$(cargo run --quiet --release -p records -- --digests fuzz)
mkdir -p fuzz/corpus fuzz/artifacts/{scene,mechanism,study} pages/records/state

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

record() {
    cat << END
    {
      "target": "$1",
      "inputs": ${executed:-0},
      "seconds": ${took:-0},
      "edges_covered": ${edges:-0},
      "slowest_input_seconds": ${slowest:-0},
      "peak_memory_mib": ${peak:-0},
      "open_failures": $open
    }
END
}

fuzz scene "${seconds[0]}" && scene=$(record scene)
fuzz mechanism "${seconds[1]}" && mechanism=$(record mechanism)
fuzz study "${seconds[2]}" && study=$(record study)
found=$(sed 's/.*/    "&"/' fuzz/found.txt | paste -sd, | sed 's/,    /,\n    /g')
cat > pages/stability/records/fuzz.json.tmp << END
{
  "command": "fuzz/run.sh ${seconds[*]}",
  "engine": "libFuzzer (cargo-fuzz), mutation by line and value and by byte",
  "limits": "${limits[*]}",
  "targets": [
$scene,
$mechanism,
$study
  ],
  "found_and_fixed": [
$found
  ]
}
END
# the earlier record stays until this one is whole
mv pages/stability/records/fuzz.json.tmp pages/stability/records/fuzz.json
echo "$digests" > pages/records/state/fuzz.json
cargo run --quiet --release -p records
cat pages/stability/records/fuzz.json

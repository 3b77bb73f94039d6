#!/usr/bin/env bash
# One command from a fresh checkout to a table: sets up, builds, and runs Sightline.
#   tools/run.sh                            the default benchmark
#   tools/run.sh --scene city --frames 60   the benchmark with these flags
#   tools/run.sh shot --method hzb          any other command (see --help)
set -euo pipefail

case ${1-} in
    bench | report | view | shot | stress | scene | compare | info | completions | man | help | -h | --help | -V | --version) arguments=("$@") ;;
    *) arguments=(bench "$@") ;;
esac

tools=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
"$tools/setup.sh"
manifest=$tools/../Cargo.toml
# Built apart from the run, so that the first build, which takes minutes, shows its progress.
cargo build --release --manifest-path "$manifest" --package sightline
exec cargo run --release --quiet --manifest-path "$manifest" --package sightline -- "${arguments[@]}"

#!/usr/bin/env bash
# Builds all tests and runs them, a file of tests a process, as many side by side as there are cores: the tests of one process take turns
# with its device. What a process says is printed whole when it ends; the names of those that failed come last.
#   tools/side_by_side.sh [COMMAND...]   runs these too, first
# `tools/test.sh` chooses the device and calls this where all tests are asked for.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1

said=$(mktemp -d)
export said
trap 'rm -rf "$said"' EXIT

# A line for each file of tests: its name, a tab, and what runs it in its package's folder, as cargo does. Cargo's JSON has an artifact a line.
tests=$(cargo test --workspace --no-run --message-format=json-render-diagnostics | sed -nE \
    's|.*"manifest_path":"([^"]*/([^/"]+))/Cargo.toml".*"test":true.*"executable":"([^"]*/([^/"]+)-[0-9a-f]+)".*|\2/\4\tcd "\1" \&\& CARGO_MANIFEST_DIR="\1" "\3"|p') || exit
[[ -n $tests ]] || {
    echo "test: cargo's JSON names no test that was built" >&2
    exit 1
}

# Files that keep lavapipe's worker threads: their stages write with atomics, and only threads side by side can show a race. The others run
# without: a process has one core here, its threads mostly wait for each other, and a file takes a fifth longer.
export THREADED='^tests/(stages|engine|method_eovc|method_roc|golden)$'

run() {
    local name=${1%%$'\t'*} file=$said/$BASHPID since=$SECONDS status=0
    [[ $name =~ $THREADED ]] || export LP_NUM_THREADS=${LP_NUM_THREADS-0}
    bash -c "${1#*$'\t'}" >"$file" 2>&1 || status=$?
    {
        flock 9
        printf '\n     Running %s (%d s)\n' "$name" $((SECONDS - since))
        cat "$file"
        [[ $status -eq 0 ]] || echo "$name (exit code $status)" >>"$said/failed"
    } 9>>"$said/lock"
}
export -f run

# Files that take long begin before the others, so that none is left to run alone at the end: nothing but time hangs on this.
readonly LONG='^(tests/(stress|method|several|depth_formats|boxes|view|skins|work)|scenes/)'
{
    [[ $# -eq 0 ]] || printf '%s\n' "$@"
    grep -E "$LONG" <<<"$tests"
    grep -vE "$LONG" <<<"$tests"
    echo "cargo test --workspace --doc"
} | xargs --delimiter '\n' --max-args 1 --max-procs "$(nproc)" bash -c 'run "$1"' run ||
    echo "xargs, which did not run all of them (exit code $?)" >>"$said/failed"

[[ -e $said/failed ]] || exit 0
printf '\ntest: these failed:\n' >&2
sed 's/^/    /' "$said/failed" >&2
exit 1

#!/usr/bin/env bash
# Changes the code in small ways, one at a time (mutants), and counts the changes that tests notice. Takes hours: it is no part of CI.
#   tools/mutate.sh                           a sample of every room: 1 mutant in 16
#   tools/mutate.sh queries timers            a sample of these rooms (the names stand below)
#   SIGHTLINE_MUTANTS=0/1 tools/mutate.sh auto    all mutants of a room; K/N takes one in N, from the K-th on
#   tools/mutate.sh --score                   prints the score of each room so far
#   tools/mutate.sh --glsl [FILE...]          mutants of shaders (tests/examples/mutate_shaders.rs)
# A run that was stopped goes on where it was: mutants that were caught are not tried again. Results: target/mutants/ROOM/mutants.out, where
# missed.txt lists the changes that no test noticed. Needs cargo-mutants (`cargo install cargo-mutants`), and --glsl needs glslangValidator.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly SHARE=${SIGHTLINE_MUTANTS-0/16}
readonly RESULTS=target/mutants

# ROOM | files | packages whose tests run | arguments of `cargo test`. Tests of stages hold the CPU references, and laws hold the rest.
readonly ROOMS='
hzb|culling/src/hzb/**|sightline-culling,sightline-tests|--lib --test work --test method_hzb --test method_hzb_iterative
eovc|culling/src/eovc/*.rs|sightline-culling,sightline-tests|--lib --test work --test method_eovc
queries|culling/src/queries/*.rs|sightline-culling,sightline-tests|--lib --test work --test method_query_wait --test method_query_lag --test method_chc --test method_chcpp --test method_nohc
auto|culling/src/auto/**|sightline-culling,sightline-tests|--lib --test work --test method_auto
barriers|engine/src/barriers.rs|sightline-engine,sightline-tests|--lib --test engine
lower|engine/src/lower{.rs,/*.rs}|sightline-engine,sightline-tests|--lib --test engine
timers|engine/src/timers.rs|sightline-engine,sightline-tests|--lib --test engine
measures|tools/src/measures/**|sightline|--lib --tests
results|tools/src/results/**|sightline|--lib --tests
run|tools/src/run/**|sightline|--lib --tests
stress|tools/src/stress/**|sightline,sightline-tests|--lib --test stress --test stress_finds --test stress_catalogue
'

lines_of() {
    local file=$1
    if [[ -e $file ]]; then wc -l <"$file"; else echo 0; fi
}

# Caught is: a test failed, or did not end. Mutants that do not build count for neither side.
score() {
    local room out caught missed
    printf '%-10s %7s %7s %6s\n' room caught missed score
    for out in "$RESULTS"/*/mutants.out; do
        [[ -d $out ]] || continue
        room=$(basename "$(dirname "$out")")
        caught=$(($(lines_of "$out/caught.txt") + $(lines_of "$out/previously_caught.txt") + $(lines_of "$out/timeout.txt")))
        missed=$(lines_of "$out/missed.txt")
        ((caught + missed == 0)) || printf '%-10s %7d %7d %5d%%\n' "$room" "$caught" "$missed" $((100 * caught / (caught + missed)))
    done
}

mutate() {
    local room=$1 line files packages arguments argument status=0 flags=()
    line=$(grep "^$room|" <<<"$ROOMS") || {
        echo "mutate: no room is named '$room'; there are: $(cut -d'|' -f1 <<<"$ROOMS" | xargs)" >&2
        return 2
    }
    IFS='|' read -r _ files packages arguments <<<"$line"
    mkdir -p "$RESULTS/$room"
    # The CPU references (twin.rs) and tests are what others are held to, so they are left as they are. The copy that is mutated takes this
    # folder's build with it. Exit codes 2 and 3 say that mutants were missed or did not end, which is no failure of this script.
    # What follows `--` counts when tests run, and not when they are built: `--cargo-arg` keeps other test files from being built.
    for argument in $arguments; do flags+=("--cargo-arg=$argument"); done
    cargo mutants --workspace --file "$files" --exclude '**/tests.rs' --exclude '**/tests/**' --exclude '**/twin.rs' \
        --shard "$SHARE" --sharding round-robin --iterate --copy-target true --timeout 300 --baseline skip \
        --output "$RESULTS/$room" --test-package "$packages" "${flags[@]}" || status=$?
    ((status == 0 || status == 2 || status == 3)) || return "$status"
}

if [[ ${1-} == --score ]]; then
    score
    exit
fi
# The same driver as tools/test.sh: results do not depend on the machine.
for manifest in /usr/share/vulkan/icd.d/lvp_icd.*.json; do
    export VK_DRIVER_FILES=$manifest VK_ICD_FILENAMES=$manifest LP_NUM_THREADS=${LP_NUM_THREADS-0}
done
if [[ ${1-} == --glsl ]]; then
    exec cargo run --quiet --package sightline-tests --example mutate_shaders -- "${@:2}"
fi
cargo mutants --version >/dev/null 2>&1 || {
    echo "mutate: cargo-mutants is missing; install it with: cargo install cargo-mutants --locked" >&2
    exit 1
}
# shellcheck disable=SC2046
[[ $# -gt 0 ]] || set -- $(cut -d'|' -f1 <<<"$ROOMS")
for room in "$@"; do mutate "$room"; done
score

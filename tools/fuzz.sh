#!/usr/bin/env bash
# Fuzzes glTF import (scenes/fuzz) with libFuzzer: no panic, no overflow, no more than 1 GiB.
#   tools/fuzz.sh                  a million runs from assimp's test models and scenes/fuzz/seeds
#   tools/fuzz.sh -runs=10000      arguments go to libFuzzer
# Needs nightly Rust, cargo-fuzz (`cargo install cargo-fuzz`) and g++. Finds go to scenes/fuzz/artifacts, inputs to scenes/fuzz/corpus.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../scenes"

readonly MODELS=/usr/share/assimp/models/glTF2
command -v cargo-fuzz >/dev/null || {
    echo "fuzz: cargo-fuzz is missing; install it with: cargo install cargo-fuzz" >&2
    exit 1
}
# Small files: mutations of a large one mostly change its vertices.
mkdir -p fuzz/corpus/import
cp -n fuzz/seeds/*.gltf fuzz/corpus/import/
# Compressed files and others, made in code.
cargo run --quiet --example mutate_imports -- --write fuzz/corpus/import
if [[ -d $MODELS ]]; then
    find "$MODELS" \( -name '*.gltf' -o -name '*.glb' \) -size -64k -print0 | while IFS= read -r -d '' model; do
        cp -n "$model" "fuzz/corpus/import/$(sha256sum "$model" | cut -c1-16)"
    done
fi
[[ $# -gt 0 ]] || set -- -runs=1000000
# Overflow checks on and optimised: -O with debug assertions is cargo-fuzz's default.
exec cargo +nightly fuzz run --sanitizer none import -- -rss_limit_mb=1024 -malloc_limit_mb=1024 -max_len=65536 -timeout=20 "$@"

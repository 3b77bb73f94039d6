#!/usr/bin/env bash
# Sets up and runs all tests, on lavapipe (Mesa's CPU device), so that the results are the same everywhere.
#   tools/test.sh                         all tests
#   tools/test.sh --test tidy             arguments go to `cargo test --workspace`
#   SIGHTLINE_TEST_DEVICE=any tools/test.sh   leaves the choice of the Vulkan driver to the loader: the tests run on a GPU
set -euo pipefail

tools=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# The tests of `sightline view` open windows on a virtual display.
"$tools/setup.sh" --windows

if [[ -z ${SIGHTLINE_TEST_DEVICE-} ]]; then
    for manifest in /usr/share/vulkan/icd.d/lvp_icd.*.json /usr/local/share/vulkan/icd.d/lvp_icd.*.json; do
        if [[ -r $manifest ]]; then
            # Loaders before 1.3.207 read only the second name.
            export VK_DRIVER_FILES=$manifest VK_ICD_FILENAMES=$manifest
            break
        fi
    done
    if [[ -z ${VK_DRIVER_FILES-} ]]; then
        echo "test: lavapipe is not installed (no /usr/share/vulkan/icd.d/lvp_icd.*.json); install Mesa's Vulkan drivers," \
            "or set SIGHTLINE_TEST_DEVICE=any to test on this machine's own device" >&2
        exit 1
    fi
fi

cd "$tools/.."
exec cargo test --workspace "$@"

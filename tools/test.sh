#!/usr/bin/env bash
# Sets up and runs all tests, on lavapipe (Mesa's CPU device), so that the results are the same everywhere.
#   tools/test.sh                         all tests, those of several files side by side (tools/side_by_side.sh)
#   tools/test.sh --beside COMMAND...     all tests, and these commands beside them
#   tools/test.sh --test tidy             arguments go to `cargo test --workspace`
#   SIGHTLINE_TEST_DEVICE=swiftshader tools/test.sh   on SwiftShader, another CPU device
#   SIGHTLINE_TEST_DEVICE=any tools/test.sh   leaves the choice of the Vulkan driver to the loader: the tests run on a GPU
#   SIGHTLINE_TEST_WITHOUT=drawIndirectCount,timestamps tools/test.sh   as if the device lacked these (`sightline info`)
set -euo pipefail

tools=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

# Makes the loader see the first of these drivers that is installed, and no other.
drive_with() {
    local manifest
    for manifest in "$@"; do
        if [[ -r $manifest ]]; then
            # Loaders before 1.3.207 read only the second name.
            export VK_DRIVER_FILES=$manifest VK_ICD_FILENAMES=$manifest
            return
        fi
    done
    return 1
}

case ${SIGHTLINE_TEST_DEVICE-} in
    '')
        # The tests of `sightline view` open windows on a virtual display, those of `--capture` need RenderDoc.
        "$tools/setup.sh" --windows --captures
        drive_with /usr/share/vulkan/icd.d/lvp_icd.*.json /usr/local/share/vulkan/icd.d/lvp_icd.*.json || {
            echo "test: lavapipe is not installed (no /usr/share/vulkan/icd.d/lvp_icd.*.json); install Mesa's Vulkan drivers," \
                "or set SIGHTLINE_TEST_DEVICE=any to test on this machine's own device" >&2
            exit 1
        }
        ;;
    swiftshader)
        "$tools/setup.sh" --windows --captures --swiftshader
        drive_with /usr/lib/chromium/vk_swiftshader_icd.json /usr/lib*/chromium*/vk_swiftshader_icd.json || {
            echo "test: SwiftShader is not installed (no /usr/lib/chromium/vk_swiftshader_icd.json): Debian's package" \
                "chromium has it" >&2
            exit 1
        }
        ;;
    *) "$tools/setup.sh" --windows --captures ;;
esac

case ${1-} in
    '') exec "$tools/side_by_side.sh" ;;
    --beside) exec "$tools/side_by_side.sh" "${@:2}" ;;
esac
cd "$tools/.."
exec cargo test --workspace "$@"

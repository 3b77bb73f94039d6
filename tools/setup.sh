#!/usr/bin/env bash
# Makes this machine ready to build and run Sightline: a Rust toolchain, a Vulkan loader and driver, validation layers
# and test models. Installs only what is missing, and says what. Safe to run again.
set -euo pipefail

readonly RUST_NEEDED=1.88

usage() {
    cat <<'END'
Usage: tools/setup.sh [--windows] [--captures] [--shaders] [--swiftshader]

Checks for what Sightline needs and installs what is missing (Debian and Ubuntu; elsewhere it says what to install).

  --windows   also a virtual display for the tests of `sightline view` (xvfb, xauth, imagemagick)
  --captures  also RenderDoc, for `--capture FRAME` and its check (to look at captures: renderdoc)
  --shaders   also what `cargo shaders` builds its compiler with (cmake, ninja, g++, git, python3)
  --swiftshader
              also SwiftShader, a second CPU device to test on, which comes with Debian's chromium (290 MB)
  -h, --help  this text
END
}

say() { printf 'setup: %s\n' "$*" >&2; }

die() {
    say "$*"
    exit 1
}

packages=(mesa-vulkan-drivers libvulkan1 vulkan-validationlayers assimp-testmodels vulkan-tools)
for argument in "$@"; do
    case $argument in
        --windows) packages+=(xvfb xauth imagemagick) ;;
        --captures) packages+=(librenderdoc python3-renderdoc) ;;
        --shaders) packages+=(cmake ninja-build g++ git python3) ;;
        --swiftshader) packages+=(chromium) ;;
        -h | --help)
            usage
            exit 0
            ;;
        *)
            usage >&2
            die "unknown option: $argument"
            ;;
    esac
done

# rustc links through cc; Rust can be there without it.
command -v cc >/dev/null || packages+=(gcc libc6-dev)

is_installed() {
    [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null) == installed ]]
}

# Runs a command with the right to install packages, or says which command to run with it.
as_root() {
    if [[ $(id -u) -eq 0 ]]; then
        "$@"
    elif command -v sudo >/dev/null && sudo -n true 2>/dev/null; then
        sudo -n "$@"
    else
        die "installing needs root. Run this, then try again:
    sudo apt-get update && sudo apt-get install --yes --no-install-recommends ${missing[*]}"
    fi
}

install_with_apt() {
    missing=()
    for package in "${packages[@]}"; do
        is_installed "$package" || missing+=("$package")
    done
    [[ ${#missing[@]} -gt 0 ]] || return 0
    say "installing ${missing[*]}"
    as_root apt-get update --quiet=2 >&2
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends --quiet=2 "${missing[@]}" >&2
}

has_vulkan_loader() {
    # ldconfig is often in /sbin, which is not on every user's PATH.
    PATH=$PATH:/sbin:/usr/sbin ldconfig -p 2>/dev/null | grep -F 'libvulkan.so.1' >/dev/null && return 0
    compgen -G '/usr/lib*/libvulkan.so.1' >/dev/null || compgen -G '/usr/lib/*/libvulkan.so.1' >/dev/null
}

explain_without_apt() {
    cat >&2 <<'END'
setup: this system has no apt-get, so please see to these yourself:
  Fedora      dnf install gcc vulkan-loader mesa-vulkan-drivers vulkan-validation-layers vulkan-tools
  Arch Linux  pacman -S gcc vulkan-icd-loader vulkan-swrast vulkan-validation-layers vulkan-tools
  elsewhere   a C linker, the Vulkan loader (libvulkan.so.1), a Vulkan 1.3 driver, the Khronos validation layers
  windows     Fedora: xorg-x11-server-Xvfb xauth ImageMagick; Arch: xorg-server-xvfb xorg-xauth imagemagick
  captures    renderdoc
  swiftshader chromium, if it comes with vk_swiftshader_icd.json
  shaders     cmake ninja-build gcc-c++ git python3 (Arch: cmake ninja gcc git python)
The tests of real glTF models read /usr/share/assimp/models (assimp's own test models).
END
    has_vulkan_loader || die "no libvulkan.so.1 found: install the Vulkan loader first"
    say "libvulkan.so.1 is there, going on"
}

check_rust() {
    local remedy="install it with: curl --proto '=https' --tlsv1.2 -sSf https://sh.rustup.rs | sh"
    if ! command -v cargo >/dev/null || ! command -v rustc >/dev/null; then
        die "no Rust toolchain (cargo, rustc) on PATH; $remedy"
    fi
    local version
    version=$(rustc --version | cut -d' ' -f2)
    # The older of the two sorts first.
    if [[ $(printf '%s\n' "$RUST_NEEDED" "${version%%-*}" | sort --version-sort | head -n 1) != "$RUST_NEEDED" ]]; then
        die "rustc $version is too old, Sightline needs $RUST_NEEDED; update with: rustup update stable
    (a distribution's rustc is often old: $remedy)"
    fi
}

if command -v apt-get >/dev/null && command -v dpkg-query >/dev/null; then
    install_with_apt
else
    explain_without_apt
fi
check_rust

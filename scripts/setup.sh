#!/usr/bin/env bash
# Installs what the build needs on Debian 12, and only when something is missing.
set -euo pipefail

packages=(
    build-essential cmake ninja-build ccache pkg-config git
    mesa-vulkan-drivers libvulkan-dev vulkan-validationlayers vulkan-tools
    glslang-tools glslang-dev spirv-tools spirv-headers
    libglfw3-dev libglm-dev libopenimageio-dev openimageio-tools libopenmesh-dev
    libsqlite3-dev sqlite3 libtomlplusplus-dev nlohmann-json3-dev libfmt-dev libzstd-dev
    libfreetype-dev libharfbuzz-dev fonts-dejavu-core fonts-inter
    libgtest-dev pybind11-dev python3 python3-dev python3-numpy python3-pytest python3-pil
    xvfb xdotool x11-utils imagemagick
    astcenc libsquish-dev libstb-dev
)

if ! command -v dpkg-query >/dev/null; then
    echo "setup: this is no Debian system; install the counterparts of: ${packages[*]}" >&2
    exit 0
fi

missing=()
for package in "${packages[@]}"; do
    state=$(dpkg-query -W -f='${db:Status-Status}\n' "$package" 2>/dev/null | head -1 || true)
    [[ $state == installed ]] || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
    exit 0
fi

echo "setup: installing ${missing[*]}"
as_root=()
if ((EUID != 0)); then
    if ! command -v sudo >/dev/null; then
        echo "setup: run as root: apt-get install ${missing[*]}" >&2
        exit 1
    fi
    as_root=(sudo)
fi
"${as_root[@]}" apt-get update -q
DEBIAN_FRONTEND=noninteractive "${as_root[@]}" apt-get install -y -q --no-install-recommends "${missing[@]}"

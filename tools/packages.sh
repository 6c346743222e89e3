# Sourced by quickstart and test: installs what the build needs and is not there, on Debian and Ubuntu.
# shellcheck shell=bash

quadseg_packages=(g++ cmake ninja-build pkg-config libeigen3-dev libtbb-dev libopenmesh-dev libboost-dev
    libfast-float-dev libcli11-dev nlohmann-json3-dev libpng-dev libembree-dev libgtest-dev)

# The Python package, its tests and the API reference; the program does without.
quadseg_test_packages=(python3-dev pybind11-dev python3-numpy python3-pytest python3-tqdm python3-meshio
    python3-distributed python3-setuptools python3-wheel python3-pip doxygen)

# install_packages [MORE...]
install_packages() {
    local missing=() package
    for package in "${quadseg_packages[@]}" "$@"; do
        dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
    done
    if [ ${#missing[@]} -eq 0 ]; then return; fi
    echo "quadseg needs these packages: ${missing[*]}"
    local as_root=()
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null; then
            echo "Neither root nor sudo: please have them installed:  apt-get install ${missing[*]}" >&2
            exit 1
        fi
        as_root=(sudo)
    fi
    if ! command -v apt-get >/dev/null; then
        echo "This is no Debian or Ubuntu: please install their counterparts, then run this again." >&2
        exit 1
    fi
    if ! { "${as_root[@]}" apt-get update -qq &&
        "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${missing[@]}"; }; then
        echo "apt-get could not install: ${missing[*]}" >&2
        exit 1
    fi
}

# As many jobs as there are cores, but not more than memory allows: a compiler takes up to 1.5 GB.
build_jobs() {
    local cores memory
    cores=$(nproc)
    memory=$(awk '/MemAvailable/ {print int($2 / 1500000)}' /proc/meminfo)
    if [ "$memory" -lt 1 ]; then memory=1; fi
    echo $((cores < memory ? cores : memory))
}

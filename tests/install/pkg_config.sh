#!/bin/sh
# pkg_config.sh PREFIX LIBDIR COMPILER SOURCE PROGRAM: builds and runs a consumer with what pkg-config says.
set -eu
export PKG_CONFIG_PATH="$1/$2/pkgconfig"
# shellcheck disable=SC2046
"$3" -std=c++20 "$4" $(pkg-config --cflags --libs quadseg) -Wl,-rpath,"$1/$2" -o "$5"
"$5"

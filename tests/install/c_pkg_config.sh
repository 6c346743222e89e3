#!/bin/sh
# c_pkg_config.sh PREFIX LIBDIR C_COMPILER SOURCE PROGRAM: a C program by pkg-config; a static library needs the C++ one.
set -eu
export PKG_CONFIG_PATH="$1/$2/pkgconfig"
# shellcheck disable=SC2046
"$3" -std=c99 -pedantic -Wall -Wextra -Werror "$4" $(pkg-config --cflags --libs quadseg) -lstdc++ -lm \
    -Wl,-rpath,"$1/$2" -o "$5"
"$5"

#!/bin/sh
# pkg_config.sh PREFIX LIBDIR CONSUMER.C FOLDER: a C program by the flags of the installed .pc files alone.
set -eu
libraries=$1/$2
PKG_CONFIG_PATH=$libraries/pkgconfig
export PKG_CONFIG_PATH
mkdir -p "$4"
# shellcheck disable=SC2046 # flags are words
${CC:-cc} -Wall -Wextra -Werror -o "$4/consumer" "$3" $(pkg-config --cflags --libs pellucid pellucid-material)
LD_LIBRARY_PATH=$libraries "$4/consumer"

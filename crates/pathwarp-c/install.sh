#!/bin/sh
# Installs the header and both libraries, with what pkg-config and CMake look for: install.sh PREFIX [FOLDER], where FOLDER holds the
# libraries that cargo built, by default target/dist.
set -eu
prefix=$(mkdir -p "$1" && cd "$1" && pwd)
here=$(cd "$(dirname "$0")" && pwd)
built=${2:-$here/../../target/dist}
version=$(sed -n '/^\[workspace.package\]/,/^$/s/^version = "\(.*\)"/\1/p' "$here/../../Cargo.toml")
case $version in 0.*) abi=${version%.*} ;; *) abi=${version%%.*} ;; esac
mkdir -p "$prefix/include" "$prefix/lib/pkgconfig" "$prefix/lib/cmake/pathwarp"
cp "$here/include/pathwarp.h" "$prefix/include/"
cp "$built/libpathwarp_c.a" "$prefix/lib/"
if [ -f "$built/libpathwarp_c.dylib" ]; then
    shared=libpathwarp_c.$version.dylib abi_name=libpathwarp_c.$abi.dylib plain=libpathwarp_c.dylib
else
    shared=libpathwarp_c.so.$version abi_name=libpathwarp_c.so.$abi plain=libpathwarp_c.so
fi
cp "$built/$plain" "$prefix/lib/$shared"
ln -sf "$shared" "$prefix/lib/$abi_name"
ln -sf "$abi_name" "$prefix/lib/$plain"
cat >"$prefix/lib/pkgconfig/pathwarp.pc" <<PC
prefix=\${pcfiledir}/../..
libdir=\${prefix}/lib
includedir=\${prefix}/include

Name: pathwarp
Description: Bends points, paths and SVG drawings
Version: $version
Libs: -L\${libdir} -lpathwarp_c
Libs.private: -lm -lpthread -ldl
Cflags: -I\${includedir}
PC
sed "s/@VERSION@/$version/" "$here/pathwarp-config-version.cmake" >"$prefix/lib/cmake/pathwarp/pathwarp-config-version.cmake"
cp "$here/pathwarp-config.cmake" "$prefix/lib/cmake/pathwarp/"

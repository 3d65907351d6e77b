#!/usr/bin/env bash
# Builds the C library and its example, runs the example under valgrind, and compares what it prints with the command line. Skipped
# where there is no C compiler; without valgrind, leaks are not looked for.
set -euo pipefail
cd "$(dirname "$0")/.."
compiler=${CC:-cc}
if ! command -v "$compiler" >/dev/null; then
    echo "skipped: the C library is not tested without a C compiler" >&2
    exit 0
fi
# The whole workspace: with the features that the tests have built already.
cargo build --quiet --locked --workspace
out=target/c-tests
mkdir -p "$out"
# Installed as for a caller, with pkg-config and CMake as far as they are there.
rm -rf "$out"/*
prefix=$PWD/$out/installed
crates/pathwarp-c/install.sh "$prefix" target/debug
export PKG_CONFIG_PATH=$prefix/lib/pkgconfig
if command -v pkg-config >/dev/null; then
    shared=$(pkg-config --cflags --libs pathwarp)
    static="$(pkg-config --cflags pathwarp) $prefix/lib/libpathwarp_c.a $(pkg-config --libs-only-l --static pathwarp | sed 's/-lpathwarp_c//')"
else
    echo "skipped: the C library's pkg-config file is not tested without pkg-config" >&2
    shared="-I $prefix/include -L $prefix/lib -lpathwarp_c"
    static="-I $prefix/include $prefix/lib/libpathwarp_c.a -lm -lpthread -ldl"
fi
flags=(-std=c11 -Wall -Wextra -Wpedantic -Werror -g)
sed -n '/^```c$/,/^```$/p' crates/pathwarp-c/README.md | sed '1d;$d' >"$out/readme.c"
build() {
    # shellcheck disable=SC2086
    "$compiler" "${flags[@]}" "$1" $shared -lm -Wl,-rpath,"$prefix/lib" -o "$out/$2"
    # shellcheck disable=SC2086
    "$compiler" "${flags[@]}" "$1" $static -lm -o "$out/$2-static"
}
build crates/pathwarp-c/examples/bend.c bend
build crates/pathwarp-c/tests/edges.c edges
build "$out/readme.c" readme
if command -v cmake >/dev/null; then
    cmake -S crates/pathwarp-c/examples -B "$out/cmake" -DCMAKE_PREFIX_PATH="$prefix" >/dev/null
    cmake --build "$out/cmake" >/dev/null
    for program in bend bend-static; do "$out/cmake/$program" | cmp - <("$out/$program"); done
else
    echo "skipped: the C library's files for CMake are not tested without CMake" >&2
fi
# The header is C++, too.
if command -v "${CXX:-c++}" >/dev/null; then
    "${CXX:-c++}" -Wall -Wextra -Werror -fsyntax-only -x c++ crates/pathwarp-c/include/pathwarp.h
fi
run=()
if command -v valgrind >/dev/null; then
    # Presets are kept until the program ends, and threads keep their stacks.
    run=(valgrind --quiet --leak-check=full --errors-for-leak-kinds=definite,indirect --show-leak-kinds=definite,indirect --error-exitcode=9)
else
    echo "skipped: leaks of the C library are not looked for without valgrind" >&2
fi
for program in edges edges-static; do "${run[@]}" "$out/$program"; done
for program in readme readme-static; do
    # The top of the circle, (50, 10), sways to 50 + 8 sin(10/30).
    "${run[@]}" "$out/$program" >"$out/readme.svg"
    grep -q ' 52\.618,10' "$out/readme.svg"
done
for program in bend bend-static; do
    "${run[@]}" "$out/$program" >"$out/printed.txt"
    # The path and the points are the command line's.
    page='<svg xmlns="http://www.w3.org/2000/svg" viewBox="-200 -200 500 500"><path d="M0,0 H100 V50 H0 Z"/></svg>'
    path=$(echo "$page" | target/debug/pathwarp warp --style arc --bend 40% - | sed 's/.* d="\([^"]*\)".*/\1/')
    points=$(printf '0 0\n100 0\n100 50\n0 50\n' | target/debug/pathwarp map warp --style arc --bend 40% |
        awk '{ printf "%.17g %.17g\n", $1, $2 }')
    error='2 there is no deformation `ark`; did you mean `arc`?'
    diff <(printf '%s\n' "$path" "$points" "$error") "$out/printed.txt"
    "${run[@]}" "$out/$program" samples/logo.svg >"$out/logo.svg" 2>"$out/report.txt"
    target/debug/pathwarp warp --style arc --bend 40% --fit none samples/logo.svg --quiet | cmp - "$out/logo.svg"
    grep -q '^{"file":"samples/logo.svg"' "$out/report.txt"
done
echo "The C library: path, points and drawing are the command line's${run:+, no leaks}"

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
flags=(-std=c11 -Wall -Wextra -Wpedantic -Werror -g -I crates/pathwarp-c/include crates/pathwarp-c/examples/bend.c)
"$compiler" "${flags[@]}" -L target/debug -lpathwarp_c -Wl,-rpath,"$PWD/target/debug" -o "$out/bend"
"$compiler" "${flags[@]}" target/debug/libpathwarp_c.a -lm -lpthread -ldl -o "$out/bend-static"
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
    grep -q '^{"file":"the drawing"' "$out/report.txt"
done
echo "The C library: path, points and drawing are the command line's${run:+, no leaks}"

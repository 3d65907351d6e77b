#!/usr/bin/env bash
# The program without the parts that can be left out: it bends a drawing, and says what it lacks. Each part compiles alone.
set -euo pipefail
cd "$(dirname "$0")/.."
scratch=$(mktemp -d)
trap 'rm -r "$scratch"' EXIT

cargo clippy --quiet --locked --package pathwarp-cli --no-default-features -- -D warnings
for part in dxf editor gimp pdf plug-ins solid; do
    cargo clippy --quiet --locked --package pathwarp-cli --no-default-features --features $part -- -D warnings
done

# Beside the complete program, with which it shares most crates.
cargo build --quiet --locked --package pathwarp-cli --no-default-features
lean=$scratch/pathwarp
cp target/debug/pathwarp "$lean"

# refuses CODE WHAT ARGUMENT…: the command ends with this code, and says that the program was built without WHAT.
refuses() {
    local code=0 said
    said=$("$lean" "${@:3}" 2>&1 >/dev/null) || code=$?
    if [ $code != "$1" ] || [[ $said != *"was built without $2"* ]]; then
        echo "pathwarp ${*:3}: code $code instead of $1, or not about $2: $said" >&2
        exit 1
    fi
}

"$lean" warp samples/badge.svg --style flag -o "$scratch/flag.svg"
cargo build --quiet --locked --package pathwarp-cli
target/debug/pathwarp warp samples/badge.svg --style flag -o "$scratch/complete.svg"
cmp "$scratch/flag.svg" "$scratch/complete.svg"

refuses 2 "the editor" edit samples/badge.svg
refuses 2 "the editor" help edit
refuses 2 solids solid list
refuses 2 plug-ins check wave
refuses 2 plug-ins list --plugin ./ripple.py
refuses 2 PDF warp samples/badge.svg --style flag -o "$scratch/a.pdf"
refuses 2 DXF warp samples/badge.svg --style flag --format dxf
refuses 2 DXF warp samples/badge.svg --style flag --dxf-curves polyline
refuses 2 "GIMP's files" install gimp
printf 'gimp xcf v011\0' >"$scratch/a.xcf"
refuses 3 "GIMP's files" warp "$scratch/a.xcf" --style flag
for word in edit solid check new-plugin convert; do
    if "$lean" --help | grep -q "^  $word "; then
        echo "help offers $word, which was left out" >&2
        exit 1
    fi
done

#!/usr/bin/env bash
# Bundles the scripts of the page anew and compares them with the file in the repository. `--write` stores them there instead.
set -euo pipefail
cd "$(dirname "$0")"
# Fetched again whenever the list of packages is newer.
[ node_modules/.package-lock.json -nt package-lock.json ] || npm ci --silent --no-audit --no-fund || {
    echo "skipped: npm could not fetch what builds the editor's page; it is neither built nor tested" >&2
    exit 0
}
npx tsc --noEmit
if [ "${1:-}" = --write ]; then
    node build.mjs
    exit
fi
built=$(mktemp -d)
trap 'rm -rf "$built"' EXIT
node build.mjs "$built"
cmp --quiet "$built/editor.js" ../assets/editor.js || {
    echo "crates/pathwarp-editor/assets/editor.js is not what web/ builds; run crates/pathwarp-editor/web/check.sh --write" >&2
    exit 1
}

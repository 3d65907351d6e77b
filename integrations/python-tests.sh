#!/usr/bin/env bash
# Builds the wheel of pathwarp for Python and tests it, and the plug-in for vpype on it, in a virtual environment of their own below
# target/. Skipped where there is no Python with venv, or where its packages cannot be fetched.
set -euo pipefail
cd "$(dirname "$0")/.."
. integrations/venv.sh
need_python 9 "the Python package is not tested"
env=target/python-tests
packages=("maturin>=1.9,<2" numpy pytest mypy fonttools svgpathtools lxml pillow tqdm setuptools wheel)
# vpype needs Python 3.11.
with_vpype=$("$python" -c 'import sys; print(int(sys.version_info >= (3, 11)))')
[ "$with_vpype" = 0 ] || packages+=("vpype>=1.15")
fetch_into $env "the Python package is not tested, as its packages cannot be fetched" "${packages[@]}"
# The profile of the other tests, whose crates are built already.
rm -rf target/python-wheels
"$env/bin/maturin" build --quiet --locked --profile dev --strip true --interpreter "$env/bin/python" \
    --manifest-path crates/pathwarp-python/Cargo.toml --out target/python-wheels
cargo build --quiet --locked --workspace --bin pathwarp
"$env/bin/python" -m pip install --quiet --disable-pip-version-check --force-reinstall --no-deps target/python-wheels/*.whl
PATHWARP=$PWD/target/debug/pathwarp "$env/bin/python" -m pytest --quiet -p no:cacheprovider crates/pathwarp-python/tests
if [ "$with_vpype" = 1 ]; then
    # A copy: setuptools leaves its traces in the folder that it builds.
    rm -rf target/vpype-pathwarp && cp -r integrations/vpype target/vpype-pathwarp
    "$env/bin/python" -m pip install --quiet --disable-pip-version-check --force-reinstall --no-deps --no-build-isolation target/vpype-pathwarp
    "$env/bin/python" -m pytest --quiet -p no:cacheprovider integrations/vpype/tests
else
    echo "skipped: the plug-in for vpype is not tested without Python 3.11" >&2
fi

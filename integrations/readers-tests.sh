#!/usr/bin/env bash
# Opens what the program writes in programs that people use it with: DXF in ezdxf, models in trimesh. Skipped where there is no Python with
# venv, or where its packages cannot be fetched.
set -euo pipefail
cd "$(dirname "$0")/.."
python=${PYTHON:-python3}
if ! "$python" -c 'import ensurepip, venv, sys; sys.exit(sys.version_info < (3, 10))' 2>/dev/null; then
    echo "skipped: DXF and models are not opened elsewhere without Python 3.10 or newer with venv" >&2
    exit 0
fi
env=target/readers-tests
[ -x "$env/bin/python" ] || "$python" -m venv "$env"
packages="ezdxf==1.4.* trimesh>=4,<6 numpy scipy pytest svgpathtools"
# shellcheck disable=SC2086
if ! "$env/bin/python" -m pip install --quiet --disable-pip-version-check $packages; then
    echo "skipped: DXF and models are not opened elsewhere, as the packages cannot be fetched" >&2
    exit 0
fi
cargo build --quiet --locked --workspace --bin pathwarp
PATHWARP=$PWD/target/debug/pathwarp "$env/bin/python" -m pytest --quiet -p no:cacheprovider integrations/readers

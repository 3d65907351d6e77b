#!/usr/bin/env bash
# Opens what the program writes in programs that people use it with: DXF in ezdxf, models in trimesh. Skipped where there is no Python with
# venv, or where its packages cannot be fetched.
set -euo pipefail
cd "$(dirname "$0")/.."
. integrations/venv.sh
need_python 10 "DXF and models are not opened elsewhere"
env=target/readers-tests
fetch_into $env "DXF and models are not opened elsewhere, as the packages cannot be fetched" \
    "ezdxf==1.4.*" "trimesh>=4,<6" numpy scipy pytest svgpathtools
cargo build --quiet --locked --workspace --bin pathwarp
PATHWARP=$PWD/target/debug/pathwarp "$env/bin/python" -m pytest --quiet -p no:cacheprovider integrations/readers

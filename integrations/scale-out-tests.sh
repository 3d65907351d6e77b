#!/usr/bin/env bash
# Runs the pipelines for Ray and Spark over two thousand drawings, kills a worker of each on the way, and compares the results with the
# plain batch, byte for byte. Uses the wheel that python-tests.sh built. Skipped where Ray cannot be installed; Spark also needs Java.
set -euo pipefail
cd "$(dirname "$0")/.."
wheel=$(ls target/python-wheels/*.whl 2>/dev/null || true)
if [ -z "$wheel" ] && [ -z "${FETCH_ONLY:-}" ]; then
    echo "skipped: the pipelines for clusters are not tested without the wheel for Python" >&2
    exit 0
fi
. integrations/venv.sh
env=target/scale-out-tests
systems=ray
packages=("ray[data]" numpy pandas pyarrow psutil)
if command -v java >/dev/null; then
    systems="ray spark"
    packages+=(pyspark)
else
    echo "skipped: the pipeline for Spark is not tested without Java" >&2
fi
fetch_into $env "the pipelines for clusters are not tested, as Ray cannot be installed" "${packages[@]}"
"$env/bin/python" -m pip install --quiet --disable-pip-version-check --force-reinstall --no-deps "$wheel"
cargo build --quiet --locked --workspace --bin pathwarp
measure() {
    "$env/bin/python" -B integrations/scale-out/measure.py --program target/debug/pathwarp --source samples --workers 2 "$@" 2>&1 |
        grep -v "INFO\|WARNING"
    return "${PIPESTATUS[0]}"
}
# shellcheck disable=SC2086
measure --count 2000 --kill 1 $systems
# shellcheck disable=SC2086
measure --count 200 --read system $systems

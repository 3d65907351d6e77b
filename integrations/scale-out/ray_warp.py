"""Warps a folder of SVG files with Ray Data: read_binary_files, map_batches, write.

    python ray_warp.py icons/ warped/ arc bend=40%

On a cluster, `ray.init(address="auto", runtime_env={"working_dir": "."})` joins it and ships files.py; the folders are ones that every
node sees.
"""

from __future__ import annotations

from typing import Any, Dict

import numpy as np

import commandline
import files
import pathwarp

BATCH = 128
"""Files per batch: few enough that little is repeated if a worker dies, many enough that the cluster's share of the time is small."""

BLOCKS_PER_WORKER = 16
"""Tasks per worker: the last ones leave others idle for at most a sixteenth of the time."""


def warp(batch: Dict[str, np.ndarray], deformation: pathwarp.Deformation, options: Dict[str, Any]) -> Dict[str, Any]:
    """Bends the files of a batch."""
    files.one_thread_per_worker()
    done = [files.bend(content, path, deformation, options) for content, path in zip(batch["bytes"], batch["path"])]
    return {"path": batch["path"], **{key: [d[key] for d in done] for key in ("content", "warnings", "error")}}


def write(batch: Dict[str, np.ndarray], root: str, folder: str) -> Dict[str, Any]:
    """Writes the results of a batch, and returns a line of the list for each."""
    rows = []
    for content, path, warnings, error in zip(batch["content"], batch["path"], batch["warnings"], batch["error"]):
        row = {"path": path, "sha256": ""} if error else files.put(content, path, root, folder)
        rows.append({**row, "warnings": int(warnings), "error": error})
    return {key: [row[key] for row in rows] for key in ("path", "sha256", "warnings", "error")}


def run(source: str, folder: str, deformation: pathwarp.Deformation, options: Dict[str, Any], workers: int) -> Any:
    """Warps all files of a folder; returns the list of results as a dataset.

    The three steps are plain functions, so Ray runs them as one task, and repeats the task if its worker dies.
    """
    import ray

    suffixes = [s[1:] for s in files.SUFFIXES]
    blocks = BLOCKS_PER_WORKER * workers
    drawings = ray.data.read_binary_files(source, include_paths=True, file_extensions=suffixes, override_num_blocks=blocks)
    bent = drawings.map_batches(warp, batch_size=BATCH, fn_kwargs={"deformation": deformation, "options": options})
    return bent.map_batches(write, batch_size=BATCH, fn_kwargs={"root": source, "folder": folder}).materialize()


def main() -> None:
    given = commandline.read(__doc__)
    import ray

    # Nothing listens beyond this machine.
    ray.init(num_cpus=given.workers, _node_ip_address="127.0.0.2", include_dashboard=False)
    done = run(given.source, given.folder, given.deformation, {}, given.workers).to_pandas()
    commandline.summarize(done)


if __name__ == "__main__":
    main()

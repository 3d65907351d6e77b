"""Warps a folder of SVG files with Ray Data.

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

BLOCKS_PER_WORKER = 8
"""Tasks per worker: the last ones leave others idle for at most an eighth of the time."""


def warp(batch: Dict[str, np.ndarray], **how: Any) -> Dict[str, Any]:
    """Warps the files of a batch, and returns a line of the list for each."""
    files.one_thread_per_worker()
    return files.warp(list(batch["path"]), batch.get("bytes"), **how)


def run(
    source: str, folder: str, deformation: pathwarp.Deformation, options: Dict[str, Any], workers: int, read: str = "worker"
) -> Any:
    """Warps all files of a folder; returns the list of results as a dataset.

    If a worker dies, Ray repeats its task. With `read="system"`, Ray reads the files, which works for object storage, too.
    """
    import ray

    blocks = BLOCKS_PER_WORKER * workers
    if read == "system":
        suffixes = [files.SUFFIX[1:]]
        drawings = ray.data.read_binary_files(source, include_paths=True, file_extensions=suffixes, override_num_blocks=blocks)
    else:
        drawings = ray.data.from_items([{"path": path} for path in files.find(source)], override_num_blocks=blocks)
    how = {"root": source, "folder": folder, "deformation": deformation, "options": options}
    return drawings.map_batches(warp, batch_size=BATCH, fn_kwargs=how).materialize()


def main() -> None:
    given = commandline.read(__doc__)
    import ray

    # Nothing listens beyond this machine.
    ray.init(num_cpus=given.workers, _node_ip_address="127.0.0.2", include_dashboard=False)
    done = run(given.source, given.folder, given.deformation, {}, given.workers, given.read).to_pandas()
    commandline.summarize(done)


if __name__ == "__main__":
    main()

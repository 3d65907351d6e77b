"""Warps a folder of SVG files with Spark and mapInPandas.

    python spark_warp.py icons/ warped/ arc bend=40%

On a cluster, use its master, and folders that every node sees.
"""

from __future__ import annotations

import os
import sys
from typing import Any, Dict, Iterator

import pandas as pd

import commandline
import files
import pathwarp

SCHEMA = "path string, sha256 string, warnings long, error string"

PARTS_PER_WORKER = 8
"""Tasks per worker: the last ones leave others idle for at most an eighth of the time."""


def warper(**how: Any) -> Any:
    """The function for mapInPandas: warps the files of each batch."""

    def warp(batches: Iterator[pd.DataFrame]) -> Iterator[pd.DataFrame]:
        files.one_thread_per_worker()
        for batch in batches:
            paths = [files.local(path) for path in batch["path"]]
            yield pd.DataFrame(files.warp(paths, batch.get("content"), **how))

    return warp


def session(workers: int) -> Any:
    """Spark on this machine, open to nobody else. A task that fails is tried again, up to eight times."""
    from pyspark.sql import SparkSession

    os.environ["SPARK_LOCAL_IP"] = "127.0.0.1"
    # The workers need the packages that this process has.
    os.environ.setdefault("PYSPARK_PYTHON", sys.executable)
    settings = {
        "spark.driver.host": "127.0.0.1",
        "spark.driver.bindAddress": "127.0.0.1",
        "spark.ui.enabled": "false",
        "spark.ui.showConsoleProgress": "false",
        # A batch costs Python as much as ten small drawings. It holds names, or at most these bytes of contents.
        "spark.sql.execution.arrow.maxRecordsPerBatch": "1024",
        "spark.sql.execution.arrow.maxBytesPerBatch": str(16 * 1024 * 1024),
        "spark.sql.execution.arrow.pyspark.enabled": "true",
        # Java only passes names on: its optimizing compiler would take more time than it saves. (`spark.executor.…` on a cluster.)
        "spark.driver.extraJavaOptions": "-XX:TieredStopAtLevel=1 -XX:+UseSerialGC",
        # Small files: their number decides, not their size.
        "spark.sql.files.openCostInBytes": str(64 * 1024),
        "spark.sql.files.maxPartitionBytes": str(32 * 1024 * 1024),
        "spark.sql.sources.parallelPartitionDiscovery.threshold": "1000000",
    }
    builder = SparkSession.builder.master(f"local[{workers},8]").appName("pathwarp")
    for name, value in settings.items():
        builder = builder.config(name, value)
    made = builder.getOrCreate()
    made.sparkContext.setLogLevel("ERROR")
    made.sparkContext.addPyFile(files.__file__)
    return made


def run(
    spark: Any,
    source: str,
    folder: str,
    deformation: pathwarp.Deformation,
    options: Dict[str, Any],
    results: str,
    read: str = "worker",
) -> Any:
    """Warps all files of a folder, and writes the list of results as Parquet, which Spark commits whole.

    With `read="system"`, Spark reads the files, which works for object storage, too.
    """
    if read == "system":
        reader = spark.read.format("binaryFile").option("recursiveFileLookup", "true")
        drawings = reader.option("pathGlobFilter", f"*{files.SUFFIX}").load(source).select("path", "content")
    else:
        paths = [(path,) for path in files.find(source)]
        parts = PARTS_PER_WORKER * spark.sparkContext.defaultParallelism
        drawings = spark.createDataFrame(paths, "path string").repartition(parts)
    how = warper(root=source, folder=folder, deformation=deformation, options=options)
    drawings.mapInPandas(how, SCHEMA).write.mode("overwrite").parquet(results)
    return spark.read.parquet(results)


def main() -> None:
    given = commandline.read(__doc__)
    source, folder = os.path.abspath(given.source), os.path.abspath(given.folder)
    done = run(session(given.workers), source, folder, given.deformation, {}, folder + ".results", given.read).toPandas()
    commandline.summarize(done)


if __name__ == "__main__":
    main()

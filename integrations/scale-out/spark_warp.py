"""Warps a folder of SVG files with Spark: binaryFile, mapInPandas, write.

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


def warper(root: str, folder: str, deformation: pathwarp.Deformation, options: Dict[str, Any]) -> Any:
    """The function for mapInPandas: bends the files of each batch, and writes them."""

    def warp(batches: Iterator[pd.DataFrame]) -> Iterator[pd.DataFrame]:
        files.one_thread_per_worker()
        for batch in batches:
            rows = []
            for path, content in zip(batch["path"], batch["content"]):
                path = files.local(path)
                done = files.bend(content, path, deformation, options)
                row = {"path": path, "sha256": ""} if done["error"] else files.put(done["content"], path, root, folder)
                rows.append({**row, "warnings": done["warnings"], "error": done["error"]})
            yield pd.DataFrame(rows, columns=["path", "sha256", "warnings", "error"])

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
        "spark.sql.execution.arrow.maxRecordsPerBatch": "128",
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


def run(spark: Any, source: str, folder: str, deformation: pathwarp.Deformation, options: Dict[str, Any], results: str) -> Any:
    """Warps all files of a folder, and writes the list of results as Parquet, which Spark commits whole."""
    reader = spark.read.format("binaryFile").option("recursiveFileLookup", "true")
    drawings = reader.option("pathGlobFilter", "*.svg").load(source).select("path", "content")
    done = drawings.mapInPandas(warper(source, folder, deformation, options), SCHEMA)
    done.write.mode("overwrite").parquet(results)
    return spark.read.parquet(results)


def main() -> None:
    given = commandline.read(__doc__)
    source, folder = os.path.abspath(given.source), os.path.abspath(given.folder)
    done = run(session(given.workers), source, folder, given.deformation, {}, folder + ".results").toPandas()
    commandline.summarize(done)


if __name__ == "__main__":
    main()

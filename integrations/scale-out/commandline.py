"""The command line of both pipelines: SOURCE FOLDER DEFORMATION [NAME=VALUE …] [--workers N] [--read worker|system]."""

from __future__ import annotations

import argparse
from typing import Any

import pathwarp


def read(doc: str) -> argparse.Namespace:
    """Parses the arguments and builds the deformation."""
    parser = argparse.ArgumentParser(description=doc.splitlines()[0])
    parser.add_argument("source")
    parser.add_argument("folder")
    parser.add_argument("deformation")
    parser.add_argument("parameters", nargs="*", metavar="NAME=VALUE")
    parser.add_argument("--workers", type=int, default=2)
    who = "who reads the files: each worker its own, by their paths, or the system, which knows object storage"
    parser.add_argument("--read", choices=("worker", "system"), default="worker", help=who)
    given = parser.parse_args()
    given.deformation = pathwarp.Deformation(given.deformation, **dict(p.split("=", 1) for p in given.parameters))
    return given


def summarize(done: Any) -> None:
    """Prints the number of files and the errors of a data frame of results."""
    failed = done[done.error != ""]
    print(f"{len(done) - len(failed)} files written, {len(failed)} failed")
    for _, row in failed.iterrows():
        print(f"{row.path}: {row.error}")

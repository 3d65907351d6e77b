"""One file at a time: what both pipelines do with each, and what makes it safe to do it again.

A file's result depends on its bytes and the deformation alone, and appears under its own name by a rename. A worker that dies leaves
nothing half written, and one that repeats another's work writes the same bytes to the same place.
"""

from __future__ import annotations

import hashlib
import os
import tempfile
from typing import Any, Dict

import pathwarp

SUFFIXES = (".svg",)


def bend(content: bytes, name: str, deformation: pathwarp.Deformation, options: Dict[str, Any]) -> Dict[str, Any]:
    """The warped file, or the error that it causes: a bad file must not stop the others."""
    try:
        warped = deformation.warp_svg(content, name=name, **options)
        return {"content": bytes(warped), "warnings": len(warped.warnings), "error": ""}
    except pathwarp.PathwarpError as e:
        return {"content": b"", "warnings": 0, "error": f"{type(e).__name__}: {e}"}


def put(content: bytes, source: str, root: str, folder: str) -> Dict[str, Any]:
    """Writes a result where its source lies below `root`, all of it or nothing."""
    below = os.path.relpath(source, root)
    target = os.path.join(folder, below)
    os.makedirs(os.path.dirname(target), exist_ok=True)
    handle, temporary = tempfile.mkstemp(dir=os.path.dirname(target), prefix=".pathwarp-")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        os.replace(temporary, target)
    except BaseException:
        os.unlink(temporary)
        raise
    return {"path": below, "sha256": hashlib.sha256(content).hexdigest()}


def one_thread_per_worker() -> None:
    """The cluster runs a process per core, so threads below them only get in each other's way."""
    pathwarp.use_threads(1)


def local(path: str) -> str:
    """The path of a `file:` URI, percent-decoded as Spark and Ray encode it."""
    from urllib.parse import unquote, urlsplit

    return unquote(urlsplit(path).path) if path.startswith("file:") else path

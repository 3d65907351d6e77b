"""One file at a time: what both pipelines do with each, and what makes it safe to do it again.

A file's result depends on its bytes and the deformation alone, and appears under its own name by a rename. A worker that dies leaves
nothing half written, and one that repeats another's work writes the same bytes to the same place.
"""

from __future__ import annotations

import hashlib
import os
import pathlib
import secrets
import threading
from typing import Any, Dict, Iterable, List, Optional, Sequence, Tuple, Union

import pathwarp

SUFFIX = ".svg"

CHUNK = 128
"""Files in memory at a time: enough that one call of pathwarp for all of them costs nothing."""

_RANDOM = secrets.token_hex(8)
"""Sets this program apart from those on other machines, which may have processes of the same number. Forks share it."""

COLUMNS = ("path", "sha256", "warnings", "error")
"""What is listed about a file: path, SHA-256 of the result, number of warnings, error."""

Row = Tuple[str, str, int, str]
"""A line of the list."""


def find(root: str) -> List[str]:
    """The drawings below a folder."""
    return sorted(str(path) for path in pathlib.Path(root).rglob(f"*{SUFFIX}"))


def warp(
    paths: Sequence[str],
    contents: Optional[Sequence[bytes]],
    root: str,
    folder: str,
    deformation: pathwarp.Deformation,
    options: Dict[str, Any],
) -> Dict[str, List[Any]]:
    """Warps files below `root`, reading those whose contents are not given, and writes the results to `folder`. Returns COLUMNS.

    A file that cannot be read or warped must not stop the others: its row has the error.
    """
    rows: List[Row] = []
    for start in range(0, len(paths), CHUNK):
        chunk = paths[start : start + CHUNK]
        found = [_read(path) for path in chunk] if contents is None else list(contents[start : start + CHUNK])
        readable = [(path, content) for path, content in zip(chunk, found) if not isinstance(content, OSError)]
        warped = iter(deformation.warp_svgs([c for _, c in readable], names=[p for p, _ in readable], **options))
        rows += [_row(path, c if isinstance(c, OSError) else next(warped), root, folder) for path, c in zip(chunk, found)]
    return {name: [row[i] for row in rows] for i, name in enumerate(COLUMNS)}


def _read(path: str) -> Union[bytes, OSError]:
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError as e:
        return e


def _row(path: str, result: Union[pathwarp.Warped, Exception], root: str, folder: str) -> Row:
    if isinstance(result, Exception):
        return path, "", 0, f"{type(result).__name__}: {result}"
    below = path[len(root) + 1 :] if path.startswith(root + os.sep) else os.path.relpath(path, root)
    put(result, os.path.join(folder, below))
    return below, hashlib.sha256(result).hexdigest(), len(result.warnings), ""


def put(content: bytes, target: str) -> None:
    """Writes a file, all of it or nothing."""
    parent = os.path.dirname(target)
    temporary = os.path.join(parent, f".pathwarp-{_RANDOM}-{os.getpid()}-{threading.get_ident()}")
    # Python's own file objects would ask the system three more questions about each file.
    flags = os.O_WRONLY | os.O_CREAT | os.O_TRUNC | getattr(os, "O_BINARY", 0)
    try:
        try:
            file = os.open(temporary, flags, 0o666)
        except FileNotFoundError:
            os.makedirs(parent, exist_ok=True)
            file = os.open(temporary, flags, 0o666)
        try:
            view = memoryview(content)
            while view:
                view = view[os.write(file, view) :]
        finally:
            os.close(file)
        os.replace(temporary, target)
    except BaseException:
        pathlib.Path(temporary).unlink(missing_ok=True)
        raise


def one_thread_per_worker() -> None:
    """The cluster runs a process per core, so threads below them only get in each other's way."""
    pathwarp.use_threads(1)


def local(path: str) -> str:
    """The path of a `file:` URI, percent-decoded as Spark and Ray encode it."""
    from urllib.parse import unquote, urlsplit

    return unquote(urlsplit(path).path) if path.startswith("file:") else path

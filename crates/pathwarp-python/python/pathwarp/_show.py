"""What notebooks show."""

from __future__ import annotations

import gzip
from typing import TYPE_CHECKING, Optional, Sequence

from . import _native
from ._errors import PathwarpError

if TYPE_CHECKING:
    from ._deformation import Deformation

LINES = 10
"""Squares of a grid, along and across."""


def page(d: str, box: Sequence[float], width: int = 320) -> str:
    """A drawing of a path, whose box is x, y, width and height."""
    x, y, w, h = box
    room = 0.03 * max(w, h) or 1.0
    view = (x - room, y - room, w + 2 * room, h + 2 * room)
    height = max(1, min(2 * width, round(width * view[3] / view[2])))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="{" ".join(f"{v:.6g}" for v in view)}">'
        f'<path d="{d}" fill="none" stroke="currentColor" vector-effect="non-scaling-stroke"/></svg>'
    )


def svg(content: bytes) -> Optional[str]:
    """The text of an SVG file, also of a compressed one; None if it is another format."""
    if content.startswith(b"\x1f\x8b"):
        content = gzip.decompress(content)
    if not content.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<"):
        return None
    return content.decode("utf-8", "replace")


def grid(deformation: Deformation) -> Optional[str]:
    """A grid on the frame as the deformation bends it; None if it bends no grid."""
    try:
        x, y, w, h = (float(v) for v in (deformation._warper.frame or "0,0,100,100").split(","))
    except ValueError:
        x, y, w, h = 0.0, 0.0, 100.0, 100.0
    steps = [i / LINES for i in range(LINES + 1)]
    across = [f"M{x!r},{y + t * h!r}h{w!r}" for t in steps]
    along = [f"M{x + t * w!r},{y!r}v{h!r}" for t in steps]
    try:
        bent = deformation.warp_path("".join(across + along), frame=(x, y, w, h), tolerance=max(w, h) / 500, precision=3)
    except PathwarpError:
        return None
    box = _native.path_box(bent)
    return None if box is None else page(bent, box)

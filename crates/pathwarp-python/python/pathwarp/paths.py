"""svgpathtools: paths in, paths out."""

from __future__ import annotations

from typing import Any

from svgpathtools import Path, parse_path

from ._deformation import Deformation, Steps


def warp(path: Path, deformation: Steps, /, **options: Any) -> Path:
    """Bends a path of svgpathtools, or one of its segments. Lines, curves and arcs come back; `report` of the result tells how close.

    Options: `tolerance`, `frame`, `certify`, `nodes`, `precision`, `limit`. Arcs are arcs of circles and ellipses, not approximations.
    """
    whole = path if isinstance(path, Path) else Path(path)
    # Fifteen decimals keep what a float64 holds of a drawing's coordinates.
    warped = Deformation.chain(deformation).warp_path(whole, **{"precision": 12, **options})
    result = parse_path(str(warped))
    result.report = warped.report
    return result


__all__ = ["warp"]

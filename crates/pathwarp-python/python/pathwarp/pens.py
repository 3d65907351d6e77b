"""Pens for fontTools: glyphs bent on their way to another pen.

Whole contours are bent when a glyph is complete, so call `flush` at the end, or use the pen as a context manager:

    with WarpPen(TTGlyphPen(None), deformation) as pen:
        glyph_set["A"].draw(pen)

The y axis of fonts points up, that of drawings down. The pen turns glyphs over before and after, so "up" is up, and a `frame` is the box
after turning: (0, -700, 600, 700) from the baseline to a height of 700. Without a frame, each glyph is bent in its own box.
"""

from __future__ import annotations

from typing import Any, Dict, List, Optional, Tuple, Type

import numpy as np
from fontTools.pens.basePen import BasePen

from . import _values
from ._deformation import Deformation, Steps

Point = Tuple[float, float]


class WarpPen(BasePen):  # type: ignore[misc]
    """Bends what is drawn with it, and draws that with another pen: lines and cubic curves.

    `flip=False` leaves y as it is. Options are those of a path: `tolerance`, `frame`, `certify`, `merge`, `limit`.
    """

    def __init__(self, out: Any, deformation: Steps, glyphSet: Any = None, *, flip: bool = True, **options: Any) -> None:
        super().__init__(glyphSet)
        self._out = out
        chosen = Deformation.chain(deformation)
        self._warper = chosen._with(options) if options else chosen._warper
        self._sign = -1.0 if flip else 1.0
        self._verbs: List[str] = []
        self._points: List[Point] = []
        self.report: Optional[Dict[str, Any]] = None
        """The report of the last glyph."""

    def _moveTo(self, pt: Point) -> None:
        self._add("M", pt)

    def _lineTo(self, pt: Point) -> None:
        self._add("L", pt)

    def _curveToOne(self, pt1: Point, pt2: Point, pt3: Point) -> None:
        self._add("C", pt1, pt2, pt3)

    def _qCurveToOne(self, pt1: Point, pt2: Point) -> None:
        self._add("Q", pt1, pt2)

    def _closePath(self) -> None:
        self._add("Z")

    def _add(self, verb: str, *points: Point) -> None:
        self._verbs.append(verb)
        self._points.extend(points)

    def flush(self) -> None:
        """Bends what was drawn, and draws it with the other pen."""
        if not self._verbs:
            return
        turned = np.asarray(self._points, dtype=np.float64) * (1.0, self._sign)
        verbs, coordinates, self.report = self._warper.warp_verbs("".join(self._verbs), turned.ravel())
        points = [(_plain(x), _plain(self._sign * y)) for x, y in coordinates.reshape(-1, 2).tolist()]
        self._verbs, self._points = [], []
        _draw(verbs, points, self._out)

    def __enter__(self) -> "WarpPen":
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], *rest: object) -> None:
        if kind is None:
            self.flush()


def _plain(v: float) -> float:
    """A whole number as an integer, as fonts have them; no -0."""
    return int(v) if v.is_integer() else v


def _draw(verbs: str, points: List[Point], out: Any) -> None:
    """Draws a path with a pen."""
    at = 0
    is_open = False
    for verb in verbs:
        count = {"M": 1, "L": 1, "Q": 2, "C": 3, "Z": 0}[verb]
        mine = points[at : at + count]
        at += count
        if verb == "M":
            if is_open:
                out.endPath()
            out.moveTo(*mine)
            is_open = True
        elif verb == "L":
            out.lineTo(*mine)
        elif verb == "Q":
            out.qCurveTo(*mine)
        elif verb == "C":
            out.curveTo(*mine)
        else:
            out.closePath()
            is_open = False
    if is_open:
        out.endPath()


__all__ = ["WarpPen"]

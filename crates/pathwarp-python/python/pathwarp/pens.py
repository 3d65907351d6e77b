"""Pens for fontTools: glyphs bent on their way to another pen.

Whole contours are bent when a glyph is complete, so call `flush` at the end, or use the pen as a context manager:

    from fontTools.pens.ttGlyphPen import TTGlyphPen
    from fontTools.ttLib import TTFont
    from pathwarp import Deformation
    from pathwarp.pens import WarpPen
    font = TTFont("font.ttf")
    glyphs, arc = font.getGlyphSet(), Deformation("arc", bend=0.4, frame=(0, -700, 600, 700))
    out = TTGlyphPen(None)
    with WarpPen(out, arc, glyphs, tolerance=1) as pen:
        glyphs["A"].draw(pen)
    glyph = out.glyph()
    glyph.recalcBounds(font["glyf"])
    font["glyf"]["A"], font["hmtx"]["A"] = glyph, (font["hmtx"]["A"][0], glyph.xMin)
    font.save("bent.ttf")

Components, as accents are in "Ä", become outlines, which takes the glyph set. TrueType has quadratic curves only, so a TTGlyphPen gets these.

The y axis of fonts points up, that of drawings down. The pen turns glyphs over before and after, so "up" is up, and a `frame` is the box
after turning: (0, -700, 600, 700) from the baseline to a height of 700. Without a frame, each glyph is bent in its own box.
"""

from __future__ import annotations

from typing import Any, List, Optional, Tuple, Type

import numpy as np
from fontTools.pens.basePen import BasePen
from fontTools.pens.ttGlyphPen import TTGlyphPen

from ._deformation import Deformation, Steps
from ._errors import UsageError
from ._reports import PathReport

Point = Tuple[float, float]


class WarpPen(BasePen):  # type: ignore[misc]
    """Bends what is drawn with it, and draws that with another pen: lines and cubic curves, or quadratic ones.

    `quadratic` says which; by default they are quadratic if `out` is a TTGlyphPen. `flip=False` leaves y as it is. Options are those of a path: `tolerance`, `frame`, `certify`, `nodes`, `limit`.
    """

    skipMissingComponents = False

    def __init__(
        self,
        out: Any,
        deformation: Steps,
        glyphSet: Any = None,
        *,
        flip: bool = True,
        quadratic: Optional[bool] = None,
        **options: Any,
    ) -> None:
        super().__init__(glyphSet)
        self._quadratic = isinstance(out, TTGlyphPen) if quadratic is None else quadratic
        self._out = out
        chosen = Deformation.chain(deformation)
        self._warper = chosen._with(options) if options else chosen._warper
        self._sign = -1.0 if flip else 1.0
        self._verbs: List[str] = []
        self._points: List[Point] = []
        self.report: Optional[PathReport] = None
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

    def addComponent(self, glyphName: str, transformation: Any) -> None:
        if self.glyphSet is None:
            raise UsageError(f"the component `{glyphName}` takes the glyph set: WarpPen(out, deformation, glyph_set)")
        try:
            super().addComponent(glyphName, transformation)
        except self.MissingComponentError:
            raise UsageError(f"the component `{glyphName}` is not in the glyph set") from None

    def _add(self, verb: str, *points: Point) -> None:
        self._verbs.append(verb)
        self._points.extend(points)

    def flush(self) -> None:
        """Bends what was drawn, and draws it with the other pen."""
        if not self._verbs:
            return
        turned = np.asarray(self._points, dtype=np.float64) * (1.0, self._sign)
        verbs, coordinates, self.report = self._warper.warp_verbs("".join(self._verbs), turned.ravel(), self._quadratic)
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
    controls: List[Point] = []
    last: Point = (0, 0)
    for verb in verbs:
        count = {"M": 1, "L": 1, "Q": 2, "C": 3, "Z": 0}[verb]
        mine = points[at : at + count]
        at += count
        if verb != "Q" and controls:
            out.qCurveTo(*controls, last)
            controls = []
        if verb == "M":
            if is_open:
                out.endPath()
            out.moveTo(*mine)
            is_open = True
        elif verb == "L":
            out.lineTo(*mine)
        elif verb == "Q":
            # Where a curve meets the next in the middle of their controls, TrueType has no point.
            if controls and not _is_middle(last, controls[-1], mine[0]):
                out.qCurveTo(*controls, last)
                controls = []
            controls.append(mine[0])
            last = mine[1]
        elif verb == "C":
            out.curveTo(*mine)
        else:
            out.closePath()
            is_open = False
    if controls:
        out.qCurveTo(*controls, last)
    if is_open:
        out.endPath()


def _is_middle(p: Point, a: Point, b: Point) -> bool:
    return all(abs(u + v - 2 * m) <= 1e-9 * (abs(u) + abs(v) + 1) for m, u, v in zip(p, a, b))


__all__ = ["WarpPen"]

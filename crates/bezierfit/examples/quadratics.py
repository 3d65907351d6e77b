"""Outlines of a font as cubics, with the number of quadratics that fontTools' cu2qu needs for each, for the example `quadratics`.

python3 quadratics.py FONT.ttf | cargo run --release -p bezierfit --example quadratics

Fonts of quadratics are raised to cubics and bent: a wave moves the points, and its derivative the handles, so that smooth joints stay so.
A line of the output is a contour: three numbers for the tolerances 1, 0.1 and 0.01 thousandths of an em, and path data.
"""
import math
import sys
from fontTools.cu2qu import curve_to_quadratic
from fontTools.pens.basePen import BasePen
from fontTools.ttLib import TTFont

TOLERANCES = (1.0, 0.1, 0.01)


class Contours(BasePen):
    """Collects contours of cubics and lines in thousandths of an em."""

    def __init__(self, glyphs, scale, bent):
        super().__init__(glyphs)
        self.scale, self.bent, self.contours = scale, bent, []

    def move(self, on, at):
        """The bent place of `at`, a handle of `on`."""
        (x, y), (u, v) = ([c * self.scale for c in p] for p in (on, at))
        if not self.bent:
            return u, v
        du, dv = u - x, v - y
        return (x + 40 * math.sin(y / 170) + du + 40 / 170 * math.cos(y / 170) * dv,
                y + 30 * math.sin(x / 140) + dv + 30 / 140 * math.cos(x / 140) * du)

    def _moveTo(self, p):
        self.contours.append([("M", [self.move(p, p)])])

    def _lineTo(self, p):
        self.contours[-1].append(("L", [self.move(p, p)]))

    def _curveToOne(self, p, q, r):
        start = self._getCurrentPoint()
        self.contours[-1].append(("C", [self.move(start, p), self.move(r, q), self.move(r, r)]))

    def _closePath(self):
        self.contours[-1].append(("Z", []))

    def _endPath(self):
        pass


def main(path):
    font = TTFont(path)
    glyphs = font.getGlyphSet()
    pen = Contours(glyphs, 1000 / font["head"].unitsPerEm, "glyf" in font)
    for name in font.getGlyphOrder():
        glyphs[name].draw(pen)
    for contour in pen.contours:
        counts, at, text = [0] * len(TOLERANCES), None, []
        for command, points in contour:
            # As read by the example.
            points = [(round(x, 4), round(y, 4)) for x, y in points]
            if command == "C":
                for i, tolerance in enumerate(TOLERANCES):
                    counts[i] += len(curve_to_quadratic([at, *points], tolerance)) - 2
            at = points[-1] if points else at
            text.append(command + " ".join(f"{x:.4f},{y:.4f}" for x, y in points))
        print(*counts, "".join(text))


main(sys.argv[1])

"""Bends the letters of a font by a function, and stores them as a UFO: python glyphs.py FONT.ttf OUT.ufo"""

import sys
from types import SimpleNamespace

import numpy as np
from fontTools.pens.pointPen import SegmentToPointPen
from fontTools.ttLib import TTFont
from fontTools.ufoLib import UFOWriter

from pathwarp import Deformation
from pathwarp.pens import WarpPen


def melt(x, y):
    """Letters in moving water, in units of the font, y up."""
    return x + 35 * np.sin(y / 110), y + 20 * np.sin(x / 90)


def main(font: str, out: str) -> None:
    source = TTFont(font)
    letters, advances = source.getGlyphSet(), source["hmtx"].metrics
    codes = {}
    for code, name in source.getBestCmap().items():
        codes.setdefault(name, []).append(code)
    # A quarter of the shortest wave, 2π·90.
    water = Deformation(melt, detail=140)
    ufo = UFOWriter(out)
    glyphs = ufo.getGlyphSet()
    for name in source.getGlyphOrder():

        def draw(points, name=name):
            # Without `flip=False` the function would see letters upside down, as drawings are.
            with WarpPen(SegmentToPointPen(points), water, letters, flip=False, tolerance=0.5) as pen:
                letters[name].draw(pen)

        glyphs.writeGlyph(name, SimpleNamespace(width=advances[name][0], unicodes=codes.get(name, [])), draw)
    glyphs.writeContents()
    ufo.writeLayerContents()
    head, lines = source["head"], source["hhea"]
    names = SimpleNamespace(familyName="Water", unitsPerEm=head.unitsPerEm, ascender=lines.ascent, descender=lines.descent)
    ufo.writeInfo(names)
    print(f"{len(glyphs.contents)} letters are in {out}")


if __name__ == "__main__":
    main(*sys.argv[1:])

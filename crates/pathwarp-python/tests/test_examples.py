"""The programs of docs/fonts-and-plots.md, against their formulas."""

import runpy
import sys
from types import SimpleNamespace
from xml.etree import ElementTree

import numpy as np
import pytest
import svgpathtools
from fontTools.pens.basePen import BasePen
from fontTools.subset import Subsetter
from fontTools.ttLib import TTFont

from conftest import ROOT

EXAMPLES = ROOT / "examples/python"
FONT = ROOT / "crates/pathwarp-svg/fonts/NotoSans-Regular.subset.ttf"


def run(program, *words, monkeypatch):
    monkeypatch.setattr(sys, "argv", [program, *map(str, words)])
    return runpy.run_path(str(EXAMPLES / program), run_name="__main__")


class Samples(BasePen):
    """Points on the curves of a glyph."""

    def __init__(self, glyphs=None):
        super().__init__(glyphs)
        self.points = []

    def _moveTo(self, p):
        self.first = p

    def _closePath(self):
        self._lineTo(self.first)

    def _lineTo(self, p):
        t = np.linspace(0, 1, 201)[:, None]
        self.points += list(np.array(self._getCurrentPoint()) * (1 - t) + np.array(p) * t)

    def _curveToOne(self, b, c, d):
        t = np.linspace(0, 1, 201)[:, None]
        a, b, c, d = map(np.array, (self._getCurrentPoint(), b, c, d))
        self.points += list(a * (1 - t) ** 3 + 3 * b * t * (1 - t) ** 2 + 3 * c * t**2 * (1 - t) + d * t**3)


def farthest(points, others):
    """The largest distance of points from the nearest of others."""
    return max(np.hypot(*(others - p).T).min() for p in points)


def test_letters_become_a_ufo(tmp_path, monkeypatch, capsys):
    ufoLib = pytest.importorskip("fontTools.ufoLib", exc_type=ImportError)
    font, out = tmp_path / "font.ttf", tmp_path / "water.ufo"
    few = TTFont(FONT)
    subsetter = Subsetter()
    subsetter.populate(text="Aog")
    subsetter.subset(few)
    few.save(font)
    melt = run("glyphs.py", font, out, monkeypatch=monkeypatch)["melt"]
    assert "4 letters are in" in capsys.readouterr().out
    source, ufo = TTFont(font), ufoLib.UFOReader(str(out)).getGlyphSet()
    plain, code = source.getGlyphSet(), source.getBestCmap()
    assert set(ufo.keys()) == set(source.getGlyphOrder())
    for letter in "Aog":
        name = code[ord(letter)]
        before, after = Samples(plain), Samples()
        plain[name].draw(before)
        ufo[name].draw(after)
        stored = SimpleNamespace()
        ufo.readGlyph(name, stored)
        assert stored.width == source["hmtx"][name][0] and stored.unicodes == [ord(letter)]
        # Both ways: nothing lacks, and nothing is elsewhere. Half a unit is the tolerance, the rest the distance of samples.
        image = np.column_stack(melt(*np.array(before.points).T))
        assert farthest(image, np.array(after.points)) < 3 and farthest(np.array(after.points), image) < 3


def test_a_figure_is_bent_and_has_few_nodes(tmp_path, monkeypatch, capsys):
    out = tmp_path / "bent.svg"
    sheet = run("plot.py", EXAMPLES / "figure.svg", out, monkeypatch=monkeypatch)["sheet"]
    before, after = (int(word) for word in capsys.readouterr().out.split(";")[0].split() if word.isdigit())
    assert after < before / 3
    curve = {}
    for name, file in (("plain", EXAMPLES / "figure.svg"), ("bent", out)):
        group = next(e for e in ElementTree.parse(file).iter() if e.get("id") == "line2d_13")
        curve[name] = svgpathtools.parse_path(next(group.iter("{http://www.w3.org/2000/svg}path")).get("d"))
    # Each point that matplotlib computed is on the bent curve: the tolerance of both fits, and that of 20,000 samples.
    points = np.array([[s.start.real, s.start.imag] for s in curve["plain"]])
    dense = np.array([s.point(t) for s in curve["bent"] for t in np.linspace(0, 1, 400)])
    assert len(curve["plain"]) == 399 and len(curve["bent"]) < 40
    assert farthest(np.column_stack(sheet(*points.T)), np.column_stack([dense.real, dense.imag])) < 0.15

"""Fonts as fontTools users bend them: read, drawn through the pen, saved, and read again."""

import numpy as np
import pytest

pytest.importorskip("fontTools")
from fontTools.pens.recordingPen import DecomposingRecordingPen, RecordingPen
from fontTools.pens.t2CharStringPen import T2CharStringPen
from fontTools.pens.ttGlyphPen import TTGlyphPen
from fontTools.ttLib import TTFont

import pathwarp
from pathwarp import Deformation, pens
from pathwarp.pens import WarpPen
from conftest import ROOT

FONTS = ROOT / "crates/pathwarp-text/tests/fonts"
ARC = Deformation("arc", bend=0.4, frame=(0, -700, 600, 900))


def points(recorded, steps=40):
    """Points of what a pen recorded, densely."""
    out, at, start = [], None, None
    for verb, given in recorded.value:
        if verb == "moveTo":
            at = start = given[0]
        curves = []
        if verb == "lineTo":
            curves = [(at, given[0])]
        elif verb == "closePath":
            curves = [(at, start)]
        elif verb == "curveTo":
            curves = [(at, *given)]
        elif verb == "qCurveTo":
            *controls, end = given
            middles = [tuple((u + v) / 2 for u, v in zip(a, b)) for a, b in zip(controls, controls[1:])]
            curves, begin = [], at
            for control, joint in zip(controls, [*middles, end]):
                curves.append((begin, control, joint))
                begin = joint
        for curve in curves:
            b = np.array(curve, float)
            t = np.linspace(0, 1, steps)[:, None]
            while len(b) > 1:
                b = b[:-1, None] * (1 - t) + b[1:, None] * t if b.ndim == 2 else b[:-1] * (1 - t) + b[1:] * t
            out.append(b[0])
            at = curve[-1]
    return np.concatenate(out) if out else np.zeros((0, 2))


def away(a, b):
    """The largest distance of a point of `a` from the polyline `b`."""
    starts, steps = b[:-1], np.diff(b, axis=0)
    squared = np.maximum((steps**2).sum(1), 1e-300)

    def nearest(p):
        t = np.clip(((p - starts) * steps).sum(1) / squared, 0, 1)[:, None]
        return np.hypot(*(starts + t * steps - p).T).min()

    return max(map(nearest, a))


def test_the_docstrings_example_saves_a_truetype_font(tmp_path):
    example = pens.__doc__.split("context manager:\n\n")[1].split("\n\n")[0]
    font = TTFont(FONTS / "arabic.ttf")
    composite = next(g for g in font.getGlyphOrder() if font["glyf"][g].isComposite())
    code = "\n".join(line[4:] for line in example.splitlines()).replace('"A"', repr(composite))
    code = code.replace("bent.ttf", str(tmp_path / "bent.ttf")).replace('"font.ttf"', repr(str(FONTS / "arabic.ttf")))
    source = DecomposingRecordingPen(font.getGlyphSet())
    names = {**vars(pathwarp), "WarpPen": WarpPen, "TTGlyphPen": TTGlyphPen, "font": font}
    font.getGlyphSet()[composite].draw(source)
    exact = points(source) * (1, -1)
    exec(code, names)
    assert names["pen"].report["max_error"] <= 1
    saved = RecordingPen()
    TTFont(tmp_path / "bent.ttf").getGlyphSet()[composite].draw(saved)
    assert {v for v, _ in saved.value} <= {"moveTo", "lineTo", "qCurveTo", "closePath"}
    bent = names["arc"].map(exact) * (1, -1)
    # The tolerance, and coordinates that are whole.
    assert away(points(saved), bent) < 1 + 0.8 and away(bent[::7], points(saved)) < 1 + 0.8


@pytest.mark.parametrize("tolerance", [0.1, 2])
def test_quadratics_keep_the_tolerance_and_are_few(tolerance):
    glyphs = TTFont(FONTS / "cff.otf").getGlyphSet()
    name = max(glyphs.keys(), key=lambda g: len(points(record(glyphs[g].draw))))
    exact = points(record(glyphs[name].draw), 150) * (1, -1)
    recorded = RecordingPen()
    with WarpPen(recorded, ARC, glyphs, quadratic=True, tolerance=tolerance) as pen:
        glyphs[name].draw(pen)
    bent = ARC.map(exact) * (1, -1)
    assert 0 < pen.report["max_error"] <= tolerance and away(points(recorded), bent) < 1.02 * tolerance
    splines = [g for v, g in recorded.value if v == "qCurveTo"]
    # Points that lie between their controls are left out.
    assert splines and max(map(len, splines)) > 2
    # Without being asked, a pen for other fonts gets cubics.
    with WarpPen(T2CharStringPen(600, glyphs), ARC, glyphs, tolerance=tolerance) as cubic:
        glyphs[name].draw(cubic)
    assert cubic.report["segments_out"] <= pen.report["segments_out"]


def record(draw):
    recorded = RecordingPen()
    draw(recorded)
    return recorded


def test_components_are_decomposed_or_refused_in_words():
    font = TTFont(FONTS / "arabic.ttf")
    glyphs = font.getGlyphSet()
    composite = next(g for g in font.getGlyphOrder() if font["glyf"][g].isComposite())
    drawn = {}
    for name in (composite, font["glyf"][composite].components[0].glyphName):
        with WarpPen(RecordingPen(), ARC, glyphs) as pen:
            glyphs[name].draw(pen)
        drawn[name] = pen.report["segments_in"]
    assert all(n > 0 for n in drawn.values())
    with pytest.raises(pathwarp.UsageError, match="takes the glyph set"):
        glyphs[composite].draw(WarpPen(RecordingPen(), ARC))
    with pytest.raises(pathwarp.UsageError, match="is not in the glyph set"):
        glyphs[composite].draw(WarpPen(RecordingPen(), ARC, {}))

"""Results as notebooks and type checkers have them, errors with their parts, and messages in Python's names."""

import pickle
import re
import typing
from xml.etree import ElementTree

import numpy as np
import pytest

import pathwarp
from pathwarp import Deformation, deform
from conftest import SAMPLES

LOGO = SAMPLES / "logo.svg"


def test_notebooks_show_results():
    drawing = pathwarp.warp_svg(LOGO, "arc")
    assert drawing._repr_svg_().encode() == drawing and drawing._repr_png_() is None and drawing._repr_jpeg_() is None
    assert pathwarp.warp_svg(LOGO, "arc", format="svgz")._repr_svg_().encode() == drawing
    pdf = pathwarp.warp_svg(LOGO, "arc", format="pdf")
    assert pdf._repr_svg_() is pdf._repr_png_() is pdf._repr_jpeg_() is None
    picture = pathwarp.warp_svg(np.zeros((9, 9), np.uint8), "arc")
    assert picture._repr_png_() == picture and picture._repr_svg_() is None
    assert pathwarp.warp_svg(picture, "arc", format="jpg")._repr_jpeg_().startswith(b"\xff\xd8")

    path = pathwarp.warp_path("M0,0 H100 V50 H0 Z", "arc")
    shown = ElementTree.fromstring(path._repr_svg_())
    assert shown[0].get("d") == path
    x, y, w, h = map(float, shown.get("viewBox").split())
    for px, py in re.findall(r"(-?[\d.]+),(-?[\d.]+)(?= [CLZ]|$)", path):
        assert x < float(px) < x + w and y < float(py) < y + h
    assert pathwarp.warp_path("", "affine")._repr_svg_() is None


def test_notebooks_show_deformations_as_grids():
    frame = (10.0, 20.0, 30.0, 60.0)
    grid = [(10 + t, 20) for t in range(0, 31, 3)] + [(10, 20 + t) for t in range(0, 61, 6)]
    for made in (deform.arc(bend=0.4, frame=frame), deform.swirl(frame=frame).inverse(), deform.affine(rotate=30, frame=frame)):
        shown = ElementTree.fromstring(made._repr_svg_())[0].get("d")
        # The ends of the lines are where the map takes them.
        starts = [(float(x), float(y)) for x, y in re.findall(r"M([-\d.]+),([-\d.]+)", shown)]
        image = made.map(grid)
        assert len(starts) == 22 and all(np.hypot(*(image - p).T).min() < 2e-3 for p in starts)
    assert Deformation("swirl")._repr_svg_() and Deformation("shaper")._repr_svg_() is None


def declared(kind, report):
    """Checks a report against its declaration."""
    hints = typing.get_type_hints(kind)
    assert set(report) <= set(hints) and kind.__required_keys__ <= set(report), set(report) ^ set(hints)
    for name, value in report.items():
        one = next((a for a in typing.get_args(hints[name]) if hasattr(a, "__required_keys__")), None)
        if one:
            for part in value:
                declared(one, part)
            continue
        origin, args = typing.get_origin(hints[name]) or hints[name], typing.get_args(hints[name])
        fitting = args if origin is typing.Union else (hints[name],)
        plain = tuple(typing.get_origin(f) or f for f in fitting)
        if typing.Literal in plain:
            assert value in args
        else:
            assert isinstance(value, tuple(float if p is float else p for p in plain)) or (float in plain and isinstance(value, int))


def test_reports_are_declared():
    svg = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 90 90"><defs><linearGradient id="g"><stop offset="1" stop-color="red"/>
        </linearGradient></defs><path id="a" d="M5,5 h60 v60 z" fill="url(#g)" stroke="red" stroke-dasharray="3"/><text id="t" y="40">Abc</text>
        <circle id="c" cx="45" cy="45" r="30"/><rect id="skip" width="5" height="5"/></svg>"""
    swirl, arc = Deformation("swirl").with_options(select="a"), Deformation("arc", bend=0.9).with_options(select="c")
    given = [(svg, swirl + arc, {}), (svg, "mobius", {"pole": (5, 5), "on_error": "skip"}), (svg, "arc", {"bend": 1.8, "fit": "page"})]
    given += [(svg, "arc", {"gradients": "exact", "strokes": "keep"}), (svg, "swirl", {"tolerance": 1e-11, "strokes": "keep"})]
    given += [(p, "arc", {}) for p in sorted(SAMPLES.glob("*.svg"))]
    seen = set()
    for drawing, deformation, values in given:
        report = pathwarp.warp_svg(drawing, deformation, **values).report
        declared(pathwarp.Report, report)
        seen |= set(report) | {key for shape in report["shapes"] for key in shape}
    assert {"selections", "steps", "page", "stroke_error"} <= seen
    declared(pathwarp.PathReport, pathwarp.warp_path("M0,0 L9,9 H40 V20z", "swirl", angle=900).report)


def caught(call):
    with pytest.raises(pathwarp.PathwarpError) as caught:
        call()
    again = pickle.loads(pickle.dumps(caught.value))
    assert (type(again), str(again), vars(again)) == (type(caught.value), str(caught.value), vars(caught.value))
    return caught.value


def test_errors_have_parts():
    e = caught(lambda: pathwarp.warp_svg(LOGO, "arc", limit={"elements": 7}))
    assert isinstance(e, pathwarp.LimitError) and (e.limit, e.needs) == ("elements", 38) and f'limit={{"elements": {e.needs:.0f}}}' in str(e)
    assert pathwarp.warp_svg(LOGO, "arc", limit={e.limit: e.needs})
    e = caught(lambda: pathwarp.warp_svg(np.zeros((40, 40), np.uint8), "arc", limit={"pixels": 100}))
    assert isinstance(e, pathwarp.LimitError) and (e.limit, e.needs) == ("pixels", 1600)
    e = caught(lambda: pathwarp.warp_path("M0,0 H9", "swirl", radius=-1))
    assert (e.parameter, e.value) == ("radius", "-1")
    e = caught(lambda: pathwarp.warp_path("M0,0 H9", "shaper"))
    assert (e.parameter, e.value) == ("shaper", None)
    e = caught(lambda: Deformation("shaper", reverse_shapre=True))
    assert e.parameter == "reverse_shapre" and "`reverse_shapre`; did you mean `reverse_shaper`?" in str(e)
    for call in (lambda: pathwarp.warp_svg(LOGO, "arc", fit="grwo"), lambda: Deformation("arc").with_options(fit="grwo")):
        assert (caught(call).parameter, caught(call).value) == ("fit", "grwo")
    e = caught(lambda: pathwarp.warp_svg("<svg\n a></svg>", "arc", name="x.svg"))
    assert e.place.startswith("x.svg:2:")
    assert caught(lambda: pathwarp.warp_svg("no.svg", "arc")).place == "no.svg"
    e = caught(lambda: pathwarp.warp_path("M0,0 L9,9", "mobius", pole=(4, 4)))
    assert isinstance(e, pathwarp.GeometryError) and np.allclose(e.place, (4, 4), atol=0.5)


def test_messages_are_in_pythons_names():
    def warnings(**values):
        return pathwarp.warp_svg(LOGO, "affine", **values).warnings

    assert warnings(move_x=5000) == ['nothing is on the page of the result; fit="page" sets it to the artwork, fit="shrink" moves that back']
    assert 'fit="grow" enlarges the page' in warnings(move_x=50)[0]
    assert "precision=0 is too coarse" in "".join(pathwarp.warp_svg(LOGO, "arc", precision=0).warnings)
    notes = pathwarp.warp_svg(LOGO, "arc", explain=True, strokes="outline").notes
    assert any('(strokes="scale" or "keep" prevents that)' in n for n in notes)
    e = caught(lambda: pathwarp.warp_path("M0,0 L9,9", "mobius", pole=(4, 4)))
    assert '(on_error="skip")' in str(e)
    # What a message advises can be given: each of these is a call.
    for call in ('fit="page"', 'fit="grow"', 'strokes="scale"', 'on_error="skip"', 'limit={"elements": 38}'):
        assert pathwarp.warp_svg(LOGO, "arc", **eval(f"dict({call})"))


@pytest.mark.parametrize("call", [pathwarp.warp_path, pathwarp.warp_svg])
def test_misspelt_options_are_recognised(call):
    given = "M0,0 H9" if call is pathwarp.warp_path else LOGO
    for deformation in ("arc", "swirl", Deformation("arc"), ["arc", "swirl"]):
        e = caught(lambda: call(given, deformation, tolerence=1))
        assert "did you mean `tolerance`?" in str(e) and "warp:" not in str(e) and e.parameter == "tolerence"
    assert "did you mean `bend`?" in str(caught(lambda: call(given, "arc", bnd=0.4)))
    assert "there are style, bend" in str(caught(lambda: call(given, "arc", wobble=0.4)))
    assert "is an option" in str(caught(lambda: Deformation("arc", tolerance=1)))

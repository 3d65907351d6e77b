"""The catalogue, the stubs, the README, and the adapters for other packages."""

import doctest
import inspect
import json
import pathlib
import re
import subprocess
import sys

import numpy as np
import pytest

import pathwarp
from pathwarp import Deformation, deform
from conftest import ROOT

HERE = pathlib.Path(__file__).resolve().parents[1]


def test_the_catalogue_is_the_command_lines(cli):
    listed = {d["name"]: d for d in json.loads(cli("list", "--json"))["deformations"]}
    assert list(pathwarp.deformations()) == list(listed)
    for info in pathwarp.deformations().values():
        theirs = {p["name"]: p for p in listed[info.name]["parameters"]}
        for p in info.parameters:
            assert p.help == theirs[p.name.rstrip("_").replace("_", "-")]["help"]
    arc = deform.arc(bend=0.4)
    assert arc == Deformation("arc", bend=0.4) and arc != Deformation("flag", bend=0.4)
    signature = inspect.signature(deform.shaper)
    assert signature.parameters["shaper"].default is None and "reverse_shaper" in signature.parameters
    assert inspect.signature(deform.projective).parameters["target"].default is inspect.Parameter.empty
    assert "four" in deform.shaper.__doc__ and "style" not in inspect.signature(deform.arc).parameters


def test_every_function_makes_its_deformation():
    assert len(set(deform.__all__)) == len(deform.__all__) > 40
    for name in deform.__all__:
        made = getattr(deform, name)
        if not any(p.default is inspect.Parameter.empty for p in inspect.signature(made).parameters.values()):
            try:
                made(frame=(0, 0, 100, 100)).map([[10.0, 10.0]])
            except pathwarp.UsageError as e:
                # Some need one of two parameters.
                assert "needed" in str(e) or "give" in str(e), e


def test_the_stubs_are_up_to_date():
    written = (HERE / "python/pathwarp/deform.pyi").read_text()
    made = subprocess.run([sys.executable, HERE / "stubs.py"], capture_output=True, text=True, check=True).stdout
    assert made == written, f"run python {HERE / 'stubs.py'} > python/pathwarp/deform.pyi"


def test_the_examples_of_the_readme_and_the_docs():
    readme = doctest.testfile(str(HERE / "README.md"), module_relative=False, optionflags=doctest.ELLIPSIS)
    assert readme.failed == 0 and readme.attempted > 15
    assert doctest.testmod(pathwarp).failed == 0


def test_types():
    mypy = pytest.importorskip("mypy.api")
    out, errors, status = mypy.run(["--strict", "--config-file", str(HERE / "pyproject.toml"), str(HERE / "tests/typed.py")])
    assert status == 0, out + errors
    wrong = HERE / "tests/typed_wrong.py"
    out, _, _ = mypy.run(["--strict", "--config-file", str(HERE / "pyproject.toml"), str(wrong)])
    lines = wrong.read_text().splitlines()
    first = lines.index('arc = deform.arc(bend=0.4)') + 2
    assert {int(n) for n in re.findall(r"typed_wrong.py:(\d+): error", out)} == set(range(first, len(lines) + 1)), out


def test_fonttools_pens():
    pytest.importorskip("fontTools")
    from fontTools.pens.recordingPen import RecordingPen
    from fontTools.pens.svgPathPen import SVGPathPen
    from fontTools.ttLib import TTFont
    from pathwarp.pens import WarpPen

    def letter(pen):
        pen.moveTo((0, 0)), pen.lineTo((300, 700)), pen.qCurveTo((400, 650), (450, 500), (600, 0)), pen.closePath()
        pen.moveTo((100, 100)), pen.curveTo((150, 50), (200, 50), (250, 100)), pen.endPath()

    plain, turned = SVGPathPen(None), SVGPathPen(None)
    with WarpPen(plain, Deformation("affine", move_x=10, move_y=-20)) as pen:
        letter(pen)
    # "Up" in a drawing is up in the font.
    assert plain.getCommands().startswith("M10 20 310 720C") and plain.getCommands().endswith(" 260 120")
    with WarpPen(turned, Deformation("arc", bend=0.5, frame=(0, -700, 600, 700)), tolerance=0.5) as pen:
        letter(pen)
    assert pen.report["max_error"] <= 0.5 and turned.getCommands().count("Z") == 1
    glyphs = TTFont(ROOT / "crates/pathwarp-text/tests/fonts" / font()).getGlyphSet()
    recorded = RecordingPen()
    with WarpPen(recorded, deform.swirl(), glyphs) as pen:
        glyphs[sorted(glyphs.keys())[-1]].draw(pen)
    assert recorded.value


def font():
    return next(f.name for f in sorted((ROOT / "crates/pathwarp-text/tests/fonts").glob("*.?tf")))


def test_svgpathtools_paths():
    svgpathtools = pytest.importorskip("svgpathtools")
    from pathwarp.paths import warp

    path = svgpathtools.parse_path("M0,0 C10,50 90,50 100,0 L100,80 A50,30 0 0 1 0,80 Z")
    frame = (0, 0, 100, 100)
    swirl = Deformation("swirl", frame=frame)
    bent = warp(path, swirl, tolerance=0.01)
    assert isinstance(bent, svgpathtools.Path) and bent.isclosed() and bent.report["max_error"] <= 0.01
    # Points of the result lie on the exact image, sampled densely.
    exact = swirl.map([(p.real, p.imag) for p in (path.point(t) for t in np.linspace(0, 1, 8001))])
    for t in np.linspace(0, 1, 60):
        p = bent.point(t)
        assert np.hypot(*(exact - (p.real, p.imag)).T).min() < 0.05
    # A path is a value for a parameter, too.
    along = svgpathtools.Path(svgpathtools.QuadraticBezier(0j, 50 + 30j, 100 + 0j))
    assert Deformation("bend", along=along) == Deformation("bend", along=along.d())

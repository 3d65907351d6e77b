"""Drawings through vpype, against exact images."""

import pathlib
import subprocess
import sys

import numpy as np
import pathwarp as pw
import pytest
import vpype as vp
from vpype_cli import execute

ROOT = pathlib.Path(__file__).resolve().parents[3]
LOGO = ROOT / "samples/logo.svg"

CIRCLE = """<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"
 width="100mm" height="100mm" viewBox="0 0 100 100">
<g inkscape:groupmode="layer" inkscape:label="1 pen" stroke="#f00" fill="none"><circle cx="50" cy="50" r="40"/></g>
<g inkscape:groupmode="layer" inkscape:label="3 box" stroke="#00f" fill="none"><path d="M10,10 H90 V90 H10 Z"/></g></svg>"""

MM = 96 / 25.4


@pytest.fixture
def circle(tmp_path):
    file = tmp_path / "circle.svg"
    file.write_text(CIRCLE)
    return file


def points(document, layer):
    return np.concatenate([np.asarray(line) for line in document.layers[layer]])


def distance_to_exact(document, layer, exact, deformation):
    """The largest distance of the drawing's vertices, and of the middles between them, from the exact image of densely sampled curves."""
    image = deformation.map(exact).view(complex).reshape(-1)
    worst = 0.0
    for line in document.layers[layer]:
        middles = (line[1:] + line[:-1]) / 2
        for p in np.concatenate([line, middles]):
            worst = max(worst, abs(image - p).min())
    return worst


def exact_circle():
    t = np.linspace(0, 2 * np.pi, 40_001)
    return np.stack([(50 + 40 * np.cos(t)) * MM, (50 + 40 * np.sin(t)) * MM], axis=1)


def exact_box():
    t = np.linspace(10, 90, 20_001)
    sides = [(t, 10 + 0 * t), (t, 90 + 0 * t), (10 + 0 * t, t), (90 + 0 * t, t)]
    return np.concatenate([np.stack(s, axis=1) for s in sides]) * MM


FRAME = tuple(v * MM for v in (10, 10, 80, 80))


def test_the_curves_are_those_of_the_file(circle):
    deformation = pw.Deformation("swirl", frame=FRAME)
    coarse = f"read -q 5mm --no-crop {circle} pathwarp swirl -q 5mm"
    smooth, lines = execute(coarse), execute(coarse + " --curves lines")
    assert sorted(smooth.layers) == sorted(lines.layers) == [1, 3]
    # Read with pieces of 5 mm, the circle is a polygon, and bent it stays one. The file's circle is bent first.
    by_lines = distance_to_exact(lines, 1, exact_circle(), deformation)
    plain = execute(f"read -q 5mm --no-crop {circle}")
    vertices = max(abs(deformation.map(exact_circle()).view(complex).reshape(-1) - p).min() for p in points(smooth, 1))
    assert vertices < 0.06 * 5 * MM and by_lines > 2 * vertices
    assert len(points(plain, 3)) < 10 and len(points(lines, 3)) > 30


def test_lines_follow_the_map(circle):
    deformation = pw.Deformation("swirl", frame=FRAME)
    # The commands in between make the drawing another one.
    bent = execute(f"read -q 0.05mm --no-crop {circle} translate 1cm 0 translate -- -1cm 0 rotate -o 0 0 0 pathwarp swirl --curves lines")
    for layer, exact in ((1, exact_circle()), (3, exact_box())):
        assert distance_to_exact(bent, layer, exact, deformation) < 0.02 * MM
    moved = execute(f"read --no-crop {circle} translate 1cm 0 pathwarp swirl")
    assert abs(points(moved, 1).mean().real - points(bent, 1).mean().real - 10 * MM) < 0.5 * MM


def test_a_logo_is_pathwarps(tmp_path):
    out = tmp_path / "out.svg"
    execute(f"read {LOGO} pathwarp arc --bend 40% write {out}")
    assert out.read_text().count("<poly") + out.read_text().count("<path") > 0
    bent = vp.read_multilayer_svg(str(out), quantization=1, crop=False)
    expected = pw.warp_svg(LOGO.read_bytes(), "arc", bend=0.4)
    by_pathwarp = tmp_path / "pathwarp.svg"
    by_pathwarp.write_bytes(expected)
    boxes = [np.array(d.bounds()) for d in (bent, vp.read_multilayer_svg(str(by_pathwarp), quantization=1, crop=False))]
    assert abs(boxes[0] - boxes[1]).max() < 0.5, boxes


def test_layers_keep_their_properties(circle):
    before = execute(f"read --no-crop {circle}")
    for how in ("source", "lines"):
        bent = execute(f"read --no-crop {circle} penwidth -l 3 2mm pathwarp arc --curves {how}")
        assert bent.page_size == before.page_size
        assert bent.layers[1].metadata == before.layers[1].metadata
        assert bent.layers[3].metadata["vp_pen_width"] == pytest.approx(2 * MM)


def test_options_and_percentages_reach_pathwarp(circle):
    words = "--pin 0%,100% --pin 100%,100% --pair 50%,0%:55%,-20%"
    bent = execute(f"read --no-crop {circle} pathwarp mls {words} --curves lines linemerge")
    deformation = pw.Deformation("mls", pin=["0%,100%", "100%,100%"], pair="50%,0%:55%,-20%", frame=FRAME)
    assert distance_to_exact(bent, 3, exact_box(), deformation) < 0.05 * MM
    back = execute(f"read --no-crop {circle} pathwarp swirl --curves lines pathwarp swirl --inverse --curves lines "
                   f"--frame {','.join(str(v) for v in FRAME)}")
    plain = execute(f"read --no-crop {circle}")
    assert abs(np.array(back.bounds()) - np.array(plain.bounds())).max() < 0.05 * MM


def test_messages():
    def run(*words):
        return subprocess.run([sys.executable, "-m", "vpype_cli", *words], capture_output=True, text=True)

    wrong = run("read", str(LOGO), "pathwarp", "ark")
    assert wrong.returncode == 2 and "did you mean `arc`" in wrong.stderr, wrong
    wrong = run("read", str(LOGO), "pathwarp", "arc", "--wobble", "3")
    assert wrong.returncode == 2 and "--wobble" in wrong.stderr
    wrong = run("line", "0", "0", "9", "9", "pathwarp", "arc", "--curves", "source")
    assert wrong.returncode == 1 and "not read from a file" in wrong.stderr
    wrong = run("read", str(LOGO), "pathwarp", "arc", "--bend", "much")
    assert wrong.returncode != 0 and "bend" in wrong.stderr and "Traceback" not in wrong.stderr
    cut = run("read", str(LOGO), "pathwarp", "arc", "--bend", "40%")
    assert cut.returncode == 0 and "past the page by 69" in cut.stderr and "`layout tight`" in cut.stderr, cut
    small = run("read", str(LOGO), "scale", "0.2", "0.2", "pathwarp", "arc", "--bend", "40%", "--curves", "lines", "layout", "tight")
    assert small.returncode == 0 and "past the page" not in small.stderr, small
    assert "--bend" in run("pathwarp", "arc", "--help").stdout and "DEFORMATION" in run("pathwarp", "--help").stdout


def test_a_function_in_a_file_is_a_map(circle, tmp_path):
    maps = ROOT / "examples/python/maps.py"
    bent = execute(f"read --no-crop {circle} pathwarp {maps}:breeze")
    # Each vertex, and each middle between two, is near the image of the circle by the formula.
    x, y = exact_circle().T
    image = x + 9 * np.sin(y / 40) + 1j * (y + x / 16 * np.sin(x / 60 + y / 200))
    (line,) = bent.layers[1]
    assert max(abs(image - p).min() for p in np.concatenate([line, (line[1:] + line[:-1]) / 2])) < 0.02 * MM
    for words, told in (
        (f"{maps}:storm", "has no function `storm`"),
        (f"{tmp_path}/none.py:breeze", "FileNotFoundError"),
        (f"{maps}:breeze --curves source", "bends lines"),
    ):
        command = [sys.executable, "-m", "vpype_cli", "read", str(circle), "pathwarp", *words.split()]
        failed = subprocess.run(command, capture_output=True, text=True)
        assert failed.returncode == 2 and told in failed.stderr, failed.stderr

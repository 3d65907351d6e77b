"""Edits of shapes: few nodes, outlines."""

import math
import re

import pathwarp
import pytest

CIRCLE = [(100 * math.cos(t), 100 * math.sin(t)) for t in (2 * math.pi * i / 72 for i in range(72))]


def drawing(content):
    return f"<svg xmlns='http://www.w3.org/2000/svg' viewBox='-150 -150 300 300'>{content}</svg>"


def test_a_polygon_becomes_a_round_curve():
    d = "M" + " ".join(f"{x:.3f},{y:.3f}" for x, y in CIRCLE) + "Z"
    path = pathwarp.simplify(d, tolerance=0.1)
    numbers = [float(n) for n in re.findall(r"-?[\d.]+", path)]
    assert path.count("C") <= 5 and path.report["segments_in"] == 72
    assert all(abs(math.hypot(*p) - 100) < 0.2 for p in zip(numbers[::6], numbers[1::6]))
    done = pathwarp.simplify(drawing(f"<path id='a' d='{d}'/>"), tolerance=0.1)
    assert done.count(b"C") <= 5 and done.report["shapes"][0]["segments_out"] <= 5


def test_what_gets_no_fewer_nodes_stays():
    svg = drawing("<rect width='3' height='4'/><path d='M0 0l9 0l0 9z'/>")
    assert pathwarp.simplify(svg) == svg.encode()
    assert pathwarp.simplify("M0,0 L9,0 L9,9 Z").count("L") == 2


def test_strokes_become_outlines():
    done = pathwarp.outline(drawing("<path d='M-50 0H50' stroke='red' stroke-width='10'/>"), structure="flatten")
    assert b"stroke-width" not in done and done.report["shapes"][0]["outlined_strokes"] == 1


def test_misspelt_parameters_are_said():
    with pytest.raises(pathwarp.UsageError, match="did you mean `tolerance`"):
        pathwarp.simplify(drawing(""), tolerence=1)
    with pytest.raises(pathwarp.UsageError, match="corners"):
        pathwarp.simplify("M0,0 H9", corners="wide")


def test_areas_grow_and_shrink():
    d = pathwarp.offset("M0,0 H40 V40 H0 Z", 10, join="miter")
    numbers = [float(n) for n in re.findall(r"-?[\d.]+", d)]
    assert (min(numbers), max(numbers)) == pytest.approx((-10, 50), abs=0.01)
    svg = drawing("<rect id='a' width='40' height='40'/>")
    assert pathwarp.offset(svg, 5, side="inside").report["shapes"][0]["segments_out"] == 4
    assert any("nothing is left of a" in w for w in pathwarp.offset(svg, "30", side="inside").warnings)


def test_shapes_become_one():
    svg = drawing("<rect id='a' width='40' height='40'/><rect id='b' x='20' width='40' height='40'/>")
    done = pathwarp.unite(svg)
    assert done.report["shapes"][0]["united"] == ["a", "b"] and done.count(b"<path") == 1
    assert b"<rect" in pathwarp.unite(svg.replace("id='b'", "id='b' fill='red'"), by="fill")


def test_a_line_runs_around_all():
    svg = drawing("<rect width='40' height='40'/><rect x='60' width='40' height='40'/>")
    done = pathwarp.contour(svg, 5, spot="CutContour", only=True, tolerance=0.01)
    assert done.count(b"<rect") == 0 and b'data-spot="CutContour"' in done
    assert done.report["shapes"][0]["copies"] == 2
    assert "copies" not in pathwarp.contour(svg, 5, join=True).report["shapes"][0]

"""DXF files as ezdxf reads them: sound, one closed entity for each contour, and where the exact image of the source is."""

import math

import ezdxf
import numpy as np
import pytest
import svgpathtools
from conftest import SAMPLES
from ezdxf.lldxf.encoding import decode_dxf_unicode
from scipy.spatial import cKDTree

PAGE = 100.0
# Of ezdxf's polylines from its curves, and between samples, in mm.
FLATTENED = 1e-4
STEP = 0.005
# usvg reads coordinates in single precision.
SINGLE = 2e-5

# Contours of every kind: curves with corners, lines among curves, arcs among lines, a circle, and an open one.
PATHS = {
    "leaf": "M10,40 C20,10 40,10 45,40 C40,60 20,60 10,40 Z",
    "mixed": "M55,10 H90 C95,20 95,30 90,40 L75,30 Q65,45 55,40 Z",
    "tab": "M10,70 H40 A5,5 0 0 1 40,80 H30 A5,5 0 0 0 20,80 H10 Z",
    "arch": "M55,90 V70 A15,20 0 0 1 85,70 V90 Z",
}


def drawing(body):
    return (
        f"<svg xmlns='http://www.w3.org/2000/svg' width='{PAGE}mm' height='{PAGE}mm' viewBox='0 0 {PAGE} {PAGE}'>{body}</svg>"
    )


def opened(path):
    """The entities of a file in which ezdxf finds nothing wrong."""
    file = ezdxf.readfile(path)
    auditor = file.audit()
    assert not auditor.errors and not auditor.fixes, auditor.errors
    assert file.header["$INSUNITS"] == 4
    return list(file.modelspace())


def points(entity):
    """Points along an entity, x to the right and y down as on the page."""
    lines = np.array([(p.x, PAGE - p.y) for p in ezdxf.path.make_path(entity).flattening(FLATTENED)])
    out = [lines[:1]]
    for p, q in zip(lines, lines[1:]):
        n = max(1, math.ceil(math.dist(p, q) / STEP))
        out.append(p + (q - p) * (np.arange(1, n + 1) / n)[:, None])
    return np.concatenate(out)


def image(d, f):
    """Points along the image of path data."""
    path = svgpathtools.parse_path(d)
    t = np.linspace(0, 1, 20001)
    return np.concatenate([[f(p.real, p.imag) for p in map(seg.point, t)] for seg in path])


def apart(a, b):
    return max(cKDTree(a).query(b)[0].max(), cKDTree(b).query(a)[0].max())


def is_closed(entity):
    if entity.dxftype() == "LWPOLYLINE":
        return entity.closed
    first, *_, last = entity.control_points
    return np.allclose(first, last, rtol=0, atol=0)


@pytest.mark.parametrize("curves", ["spline", "polyline"])
@pytest.mark.parametrize("name", PATHS)
def test_contours_are_one_entity_on_the_exact_image(run, tmp_path, name, curves):
    d = PATHS[name]
    (tmp_path / "in.svg").write_text(drawing(f"<path d='{d}'/>"))
    ripple = ["--x", "x + 3*sin(y/9)", "--y", "y + x*x/300"]
    wanted = image(d, lambda x, y: (x + 3 * math.sin(y / 9), y + x * x / 300))
    run("expr", "in.svg", *ripple, "--fit", "none", "--tolerance", "0.02mm", "--dxf-curves", curves, "-o", "out.dxf")
    (entity,) = opened(tmp_path / "out.dxf")
    assert entity.dxftype() == {"spline": "SPLINE", "polyline": "LWPOLYLINE"}[curves]
    assert is_closed(entity)
    # The curve, and the polyline within as much again; half a step between samples.
    room = {"spline": 0.02, "polyline": 0.04}[curves] + STEP + FLATTENED + SINGLE
    assert apart(points(entity), wanted) < room
    if curves == "spline":
        knots = list(entity.knots)
        assert all(knots.count(k) in (3, 4) for k in set(knots))


@pytest.mark.parametrize("name", PATHS)
def test_exact_images_are_splines_with_weights(run, tmp_path, name):
    """Under a projective map a contour is one spline of its own degree, and control points are on rays of the eye."""
    tool = ["--frame", "0,0,100,100", "--eye", "50,150", "--reference", "0,100 100,100 50,-60", "--push", "0,0,1:160%"]
    run("map", "anamorph", *tool, "--exact", PATHS[name], "-o", "out.dxf")
    (entity,) = opened(tmp_path / "out.dxf")
    px = 25.4 / 96

    def f(x, y):
        delta = 1 + (100 - y) / 160 * (1 / 1.6 - 1)
        return (50 + (x - 50) / delta) * px, PAGE + (150 + (y - 150) / delta) * px

    assert entity.dxftype() == "SPLINE" and is_closed(entity)
    # The cubic of "mixed" is a quadratic in disguise.
    assert entity.dxf.degree == (3 if name == "leaf" else 2) and len(entity.weights) == len(entity.control_points)
    # ezdxf's paths are cubics, its own curve is not.
    curve = entity.construction_tool()
    t = np.linspace(curve.knots()[0], curve.max_t, 40001)
    found = np.array([(p.x, PAGE - p.y) for p in curve.points(t)])
    assert apart(found, image(PATHS[name], f)) < STEP


@pytest.mark.parametrize("name", PATHS)
def test_lines_and_arcs_are_polylines_with_bulges(run, tmp_path, name):
    d = PATHS[name]
    (tmp_path / "in.svg").write_text(drawing(f"<path d='{d}' fill='none' stroke='red' stroke-width='0.1'/>"))
    run("convert", "in.svg", "-o", "out.dxf")
    (entity,) = opened(tmp_path / "out.dxf")
    kind = "LWPOLYLINE" if name == "tab" else "SPLINE"
    assert entity.dxftype() == kind and is_closed(entity)
    if name == "tab":
        # Of half circles: y points up, so the first, clockwise on the page, is so in the file.
        assert [round(b, 6) for *_, b in entity.get_points("xyb") if b] == [-1.0, 1.0]
    assert apart(points(entity), image(d, lambda x, y: (x, y))) < 0.002 + STEP + FLATTENED + SINGLE


def test_every_sample_is_sound(run, tmp_path):
    for sample in sorted(SAMPLES.glob("*.svg")):
        run("warp", sample, "--style", "flag", "--quiet", "-o", "out.dxf")
        for entity in opened(tmp_path / "out.dxf"):
            assert entity.dxftype() in {"SPLINE", "LWPOLYLINE", "LINE", "CIRCLE", "ARC", "ELLIPSE"}


def test_what_is_cut_is_cut_once_and_filled_shapes_are_closed(run, tmp_path):
    (tmp_path / "in.svg").write_text(
        drawing(
            "<g id='Zuschnitt ä'><path d='M20,2H30V12'/><path d='M2,2H12V12H2V2'/></g>"
            "<g id='engrave' stroke='#f00' stroke-width='2'><path d='M50,50H80V70Z' fill='blue'/>"
            "<path d='M5,60C20,50 20,80 40,70' fill='none'/></g>"
        )
    )
    for args in (["convert", "in.svg"], ["expr", "in.svg", "--y", "y + x/9"]):
        run(*args, "--quiet", "-o", "out.dxf")
        entities = opened(tmp_path / "out.dxf")
        assert [decode_dxf_unicode(e.dxf.layer) for e in entities] == ["Zuschnitt ä"] * 2 + ["engrave"] * 2
        assert [is_closed(e) for e in entities] == [True, True, True, False]
        assert [len(e) for e in entities[:3]] == [3, 4, 3]
        assert [e.dxf.color for e in entities[2:]] == [1, 1]
    run("expr", "in.svg", "--y", "y + x/9", "--strokes", "outline", "--quiet", "-o", "out.dxf")
    assert len(opened(tmp_path / "out.dxf")) > 4


def area(points):
    x, y = points[:, 0], points[:, 1]
    return abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2


def area_with_bulges(polyline):
    """The area within a closed LWPOLYLINE: a bulge is the tangent of a quarter of its arc's angle."""
    total, points = 0, list(polyline.get_points("xyb"))
    for (x, y, bulge), (u, v, _) in zip(points, points[1:] + points[:1]):
        angle = 4 * np.arctan(bulge)
        radius = np.hypot(u - x, v - y) / 2 / np.sin(angle / 2) if bulge else 0
        total += (x * v - u * y) / 2 + radius**2 * (angle - np.sin(angle)) / 2
    return abs(total)


def test_kerf_lets_parts_grow_and_holes_shrink(run, tmp_path):
    lines = "fill='none' stroke='red' stroke-width='0.1'"
    (tmp_path / "in.svg").write_text(
        drawing(
            f"<g {lines}><rect x='10' y='10' width='40' height='30'/><circle cx='30' cy='25' r='5'/>"
            "<rect x='12' y='12' width='4' height='4'/><path d='M60,5V50'/></g>"
            "<path fill='blue' d='M10,60H50V90H10ZM20,70V80H40V70Z'/>"
            "<path d='M90,10 m10,0 A10,10 0 1 1 70,10 A10,10 0 1 1 90,10Z' transform='translate(-5,40)' fill='green'/>"
        )
    )
    for kerf in (0.2, 1.0):
        run("convert", "in.svg", "--kerf", f"{kerf}mm", "--quiet", "-o", "out.dxf")
        entities = opened(tmp_path / "out.dxf")
        plate, hole, square, line, outer, inner = entities[:6]
        assert hole.dxftype() == "CIRCLE" and abs(hole.dxf.radius - (5 - kerf / 2)) < SINGLE
        assert abs(line.dxf.start.y - 95) < SINGLE and abs(line.dxf.end.y - 50) < SINGLE
        for entity, w, h, sign in [(plate, 40, 30, 1), (square, 4, 4, -1), (outer, 40, 30, 1), (inner, 20, 10, -1)]:
            assert entity.dxftype() == "LWPOLYLINE" and entity.closed
            wanted = (w + sign * kerf) * (h + sign * kerf)
            assert abs(area(np.array(entity.get_points("xy"))) - wanted) < 1e-3 * wanted
    said = run("convert", "in.svg", "--kerf", "5mm", "-o", "out.dxf")
    assert "fewer" in said
    run("convert", "in.svg", "--kerf", "0.2mm", "-o", "out.pdf", code=2)


def test_kerf_takes_no_line_that_crosses_another_for_a_hole(run, tmp_path):
    lines = "fill='none' stroke='red' stroke-width='0.1'"
    rings = [(40, 30, 10), (45, 30, 10), (42, 60, 12), (57, 60, 6)]
    circles = "".join(f"<circle cx='{x}' cy='{y}' r='{r}'/>" for x, y, r in rings)
    (tmp_path / "in.svg").write_text(drawing(f"<g {lines}>{circles}</g>"))
    run("convert", "in.svg", "--kerf", "0.4mm", "-o", "out.dxf")
    for circle, (_, _, r) in zip(opened(tmp_path / "out.dxf"), rings, strict=True):
        assert circle.dxftype() == "CIRCLE" and abs(circle.dxf.radius - (r + 0.2)) < SINGLE


def test_kerf_keeps_circular_arcs(run, tmp_path):
    (tmp_path / "in.svg").write_text(
        drawing(
            "<rect x='10' y='10' width='40' height='30' rx='6'/>"
            "<path d='M60,20H80A8,8 0 0 1 80,36H60A8,8 0 0 1 60,20Z' fill='none' stroke='red' stroke-width='0.1'/>"
        )
    )
    run("convert", "in.svg", "--kerf", "0.4mm", "--quiet", "-o", "out.dxf")
    plate, slot = opened(tmp_path / "out.dxf")
    wanted = [(40.4 * 30.4, 6.2), (20 * 16.4, 8.2)]
    for entity, (straight, radius) in zip([plate, slot], wanted):
        assert entity.dxftype() == "LWPOLYLINE" and entity.closed
        # The corners of the plate lack a part of their squares; the ends of the slot are half circles.
        whole = straight + (np.pi - 4 if entity is plate else np.pi) * radius**2
        assert abs(area_with_bulges(entity) - whole) < 1e-6 * whole


PLATE = "M10,10H50V40H10Z"
HOLE = "<circle cx='30' cy='25' r='5'/>"
LINES = "<path d='M10,10H50'/><path d='M50,40V10'/><path d='M50,40H10'/><path d='M10,40V10'/>"
# A plate of 40 x 30 mm with a hole of 5 mm, drawn so that the plate is one contour only to those who look.
PLATES = {
    "twice": f"<path d='{PLATE}'/><path d='{PLATE}'/>{HOLE}",
    "and back": f"<path d='{PLATE}'/><path d='M10,10V40H50V10Z'/>{HOLE}",
    "by use": f"<path id='plate' d='{PLATE}'/><use href='#plate'/>{HOLE}",
    "as subpaths": f"<path d='{PLATE}{PLATE}'/>{HOLE}",
    "a hair apart": f"<path d='{PLATE}'/><path d='M10.001,10.001H49.999V39.999H10.001Z'/>{HOLE}",
    "with a vertex more": f"<path d='{PLATE}'/><path d='M30,10H50V40H10V10Z'/>{HOLE}",
    "as lines": LINES + HOLE,
    "as lines, twice": LINES + LINES + HOLE,
    "as lines, of which one is double": LINES + "<path d='M10,40V10'/>" + HOLE,
    "as lines and whole": LINES + f"<path d='{PLATE}'/>{HOLE}",
    "with a gap": "<path d='M10,10H50V40H10V10.0005'/>" + HOLE,
    "with gaps at corners": "<path d='M10,10H49.996'/><path d='M50,10.004V40'/><path d='M50,40H10V10'/>" + HOLE,
    "in another colour": f"<path d='{PLATE}'/><g stroke='blue'>{HOLE}</g>",
    "in colours": f"<path d='M10,10H50V40' stroke='#0f0'/><path d='M10,10V40H50' stroke='blue'/>{HOLE}",
    "in another layer": f"<g id='plates'><path d='{PLATE}'/></g><g id='holes'>{HOLE}<path d='M60,60h9'/></g>",
    "filled": f"<path d='{PLATE}' fill='#ccc'/><g fill='#fff'>{HOLE}</g>",
    "inside of a frame": f"<path d='M2,2H98V98H2Z'/><path d='M4,4H96V96H4Z'/><path d='{PLATE}'/>{HOLE}",
}


def moved_by_kerf(run, tmp_path, body, *args, code=0):
    """What is said, and the entities of lines drawn with --kerf 0.4mm."""
    (tmp_path / "in.svg").write_text(drawing(f"<g fill='none' stroke='red' stroke-width='0.1'>{body}</g>"))
    said = run("convert", "in.svg", "--kerf", "0.4mm", "-o", "out.dxf", *args, code=code)
    return said, opened(tmp_path / "out.dxf")


@pytest.mark.parametrize("name", PLATES)
def test_kerf_tells_in_from_out_however_a_plate_is_drawn(run, tmp_path, name):
    said, entities = moved_by_kerf(run, tmp_path, PLATES[name])
    circles = [e for e in entities if e.dxftype() == "CIRCLE"]
    plates = [e for e in entities if e.dxftype() == "LWPOLYLINE" and area(np.array(e.get_points("xy"))) < 2000]
    assert [round(e.dxf.radius, 4) for e in circles] == [4.8]
    # The corners with gaps are where either line says, 0.004 mm apart.
    assert len(plates) == 1 and plates[0].closed and len(plates[0]) in (4, 5, 6)
    assert abs(area(np.array(plates[0].get_points("xy"))) - 40.4 * 30.4) < 0.004 * 70.8
    assert "grew: " in said and "circle at" in said.split("shrank: ")[1]
    assert ("drawn twice" in said) == (name in list(PLATES)[:6] or "twice" in name or "double" in name or "whole" in name)


def test_what_is_drawn_twice_is_cut_once(run, tmp_path):
    lines = f"<path d='{PLATE}'/><path d='{PLATE}'/>{LINES}<path d='M60,5V50'/><path d='M60,50V5'/>"
    (tmp_path / "in.svg").write_text(drawing(f"<g fill='none' stroke='red' stroke-width='0.1'>{lines}</g>"))
    assert "1 contour and 5 open lines" in run("convert", "in.svg", "-o", "out.dxf")
    assert len(opened(tmp_path / "out.dxf")) == 2
    run("convert", "in.svg", "--duplicates", "keep", "-o", "out.dxf")
    assert len(opened(tmp_path / "out.dxf")) == 8
    _, entities = moved_by_kerf(run, tmp_path, PLATES["twice"], "--duplicates", "keep")
    assert [e.dxftype() for e in entities] == ["LWPOLYLINE"] * 2 + ["CIRCLE"]
    assert entities[2].dxf.radius < 5


@pytest.mark.parametrize("selector", ["#grid", ".engraved", "blue", "#00f", "Engraving"])
def test_what_is_engraved_stays_and_does_not_count(run, tmp_path, selector):
    label = "xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' inkscape:label='Engraving'"
    frame = f"<path id='grid' class='engraved' {label} stroke='blue' d='M12,12H48V38H12Z'/>"
    _, entities = moved_by_kerf(run, tmp_path, f"<path d='{PLATE}'/>{frame}{HOLE}", "--engrave", selector)
    plate, frame, hole = entities
    assert abs(area(np.array(frame.get_points("xy"))) - 36 * 26) < 1e-3
    assert abs(hole.dxf.radius - 4.8) < SINGLE
    assert abs(area(np.array(plate.get_points("xy"))) - 40.4 * 30.4) < 1e-3
    run("convert", "in.svg", "--kerf", "0.4mm", "--engrave", "#nothing", "-o", "out.dxf", code=3)


UNDECIDED = {
    "wide gap": "<path d='M10,10H50V40H10V10.5'/>",
    "gaps at corners": "<path d='M10.5,10H49'/><path d='M50,11V40'/><path d='M49,40H11'/><path d='M10,39V11'/>",
    "bracket": "<path d='M40,10H10V40H40'/>",
    "halves": "<path d='M10,10H50V40H10Z'/><path d='M10,10L50,40'/>",
    "branches": LINES + "<path d='M10,10L50,40'/>",
}


@pytest.mark.parametrize("name", UNDECIDED)
def test_open_lines_around_something_are_named(run, tmp_path, name):
    code = 0 if name == "halves" else 1
    said, entities = moved_by_kerf(run, tmp_path, UNDECIDED[name] + HOLE, code=code)
    assert ("open lines that enclose" in said) == (code == 1)
    assert [e.dxf.radius for e in entities if e.dxftype() == "CIRCLE"]


@pytest.mark.parametrize("bend", ["polar --sweep 360", "bend --stretch fit --along circle:r=100"])
def test_a_band_bent_into_a_ring_is_two_circles(run, tmp_path, bend):
    band = "<rect width='400' height='60' fill='#58c'/><path d='M0,30H400' stroke='#fff' stroke-width='0.1' fill='none'/>"
    square = "<path d='M190,40h20v10h-20z' fill='gold'/>"
    (tmp_path / "in.svg").write_text(f"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 400 60'>{band}{square}</svg>")
    deformation, *options = bend.split()
    run(deformation, "in.svg", *options, "--frame", "0,0,400,60", "--quiet", "-o", "out.dxf")
    *circles, square = opened(tmp_path / "out.dxf")
    assert [e.dxftype() for e in circles] == ["CIRCLE"] * 3 and is_closed(square)
    outer, line, inner = sorted((e.dxf.radius for e in circles), reverse=True)
    # The band is 60 px high, and its middle is 400 px long, or lies on the circle.
    px = 25.4 / 96
    middle = 100 * px if deformation == "bend" else outer - 30 * px
    assert np.allclose([outer, line, inner], [middle + 30 * px, middle, middle - 30 * px], atol=1e-3)


def test_beads_on_a_ring_have_equal_gaps_in_a_file(run, tmp_path):
    beads = "<circle id='large' cx='10' cy='10' r='6'/><circle id='small' cx='40' cy='10' r='3'/>"
    (tmp_path / "in.svg").write_text(drawing(beads))
    ring = ["--along", "circle:r=40mm", "--glyphs", "rotate", "--copies", "fill", "--gap", "2mm"]
    run("bend", "in.svg", *ring, "--fit", "none", "--quiet", "-o", "out.dxf")
    entities = opened(tmp_path / "out.dxf")
    centres = [(e.dxf.center.x, e.dxf.center.y, e.dxf.radius) for e in entities]
    count = int(80 * math.pi // (12 + 6 + 2 * 2))
    assert len(centres) == 2 * count
    middle = np.mean([c[:2] for c in centres], axis=0)
    turned = sorted((math.atan2(y - middle[1], x - middle[0]), r) for x, y, r in centres)
    gaps = [40 * ((b[0] - a[0]) % math.tau) - a[1] - b[1] for a, b in zip(turned, turned[1:] + turned[:1])]
    assert np.allclose([math.dist(c[:2], middle) for c in centres], 40, atol=1e-3)
    assert np.allclose(gaps, (80 * math.pi - 18 * count) / (2 * count), atol=2e-3)

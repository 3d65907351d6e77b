"""Functions of Python as deformations, plug-ins by name and by file, and shapes of other packages."""

import importlib.metadata
import json
import math
import pickle
import threading

import numpy as np
import pytest
import svgpathtools

import pathwarp
from pathwarp import Deformation
from conftest import ROOT, SAMPLES

SQUARE = "M0,0 H100 V50 H0 Z"
RIPPLE = ROOT / "examples/plug-ins/pathwarp-ripple.py"


def wave(x, y):
    return x, y + 5 * np.sin(x / 9)


def slopes(x, y):
    return (1, 0), (5 / 9 * np.cos(x / 9), 1)


def back(x, y):
    return x, y - 5 * np.sin(x / 9)


@pytest.mark.parametrize("jacobian", [None, slopes])
@pytest.mark.parametrize("inverse", [None, back])
def test_a_function_is_a_map(jacobian, inverse):
    made = Deformation(wave, jacobian=jacobian, inverse=inverse, frame=(0, 0, 100, 50))
    points = np.random.default_rng(3).uniform(0, 1, (40_000, 2)) * (100, 50)
    bent = made.map(points)
    assert np.array_equal(bent, np.column_stack(wave(*points.T)))
    slope = made.jacobian(points[:50])
    assert np.allclose(slope[:, 1, 0], 5 / 9 * np.cos(points[:50, 0] / 9), atol=1e-9) and np.allclose(slope[:, 0, 0], 1)
    assert np.allclose(made.inverse().map(bent[:200]), points[:200], atol=1e-9)


def test_its_curves_are_within_the_tolerance():
    for detail, assurance in ((None, "sampled"), (14, "checked")):
        bent = Deformation(wave, detail=detail).warp_path("M0,0 L100,0", tolerance=0.01)
        assert bent.report["assurance"] == assurance
        path = svgpathtools.parse_path(str(bent))
        for segment in path:
            for t in np.linspace(0, 1, 101):
                z = segment.point(t)
                # Half of the tolerance is for the decimals; the distance is at most the vertical one.
                assert abs(z.imag - 5 * math.sin(z.real / 9)) < 0.012


def test_it_stands_in_chains_and_beside_built_in_steps():
    points = np.array([[10.0, 20.0], [60.0, 5.0]])
    shift = lambda x, y: (x + 3, y)
    double = Deformation("affine", scale_x=2, about=(0, 0))
    chained = shift + double + wave
    assert np.allclose(chained.map(points), np.column_stack(wave(2 * (points[:, 0] + 3), points[:, 1])))
    assert np.allclose(pathwarp.Deformation.chain([shift, shift]).map(points), points + (6, 0))
    assert pathwarp.warp_path("M1,2 H5", shift) == "M4,2 L8,2"
    assert (chained + "arc").warp_path(SQUARE).startswith("M")


def test_a_drawing_is_that_of_the_formula(cli):
    ours = pathwarp.warp_svg(SAMPLES / "logo.svg", wave, tolerance=0.05)
    theirs = cli("expr", SAMPLES / "logo.svg", "--x", "x", "--y", "y + 5*sin(x/9)", "--tolerance", "0.05", "-o", "-")
    paths = [svgpathtools.parse_path(d) for d in _ds(ours)], [svgpathtools.parse_path(d) for d in _ds(theirs)]
    assert len(paths[0]) == len(paths[1]) > 3
    for mine, other in zip(*paths):
        assert np.allclose(mine.bbox(), other.bbox(), atol=0.15) and abs(mine.length() / other.length() - 1) < 1e-3


def _ds(svg):
    from lxml import etree

    return [e.get("d") for e in etree.fromstring(bytes(svg)).iter("{*}path")]


def test_kinks_are_kept():
    kink = Deformation(lambda x, y: (x, y + np.abs(x - 50)), creases=[(1, 0, -50)])
    assert kink.warp_path("M0,0 H100") == "M0,50 L50,0 L100,50"
    edge = Deformation(lambda x, y: (np.sqrt(np.where(x < 0, np.nan, x)), y), creases="edge line 1 0 0")
    with pytest.raises(pathwarp.GeometryError):
        edge.warp_path("M-5,0 H9")


class Oops(Exception):
    pass


def raising(x, y):
    raise Oops("so it is")


@pytest.mark.parametrize("use", ["map", "jacobian", "path", "svg", "chain"])
def test_exceptions_come_out_as_they_were_raised(use):
    made = Deformation(raising)
    with pytest.raises(Oops, match="so it is") as raised:
        if use == "map":
            made.map([[1.0, 2.0], [3.0, 4.0]])
        elif use == "jacobian":
            made.jacobian([[1.0, 2.0], [3.0, 4.0]])
        elif use == "path":
            made.warp_path(SQUARE)
        elif use == "chain":
            ("arc" + made).warp_path(SQUARE)
        else:
            made.warp_svg(SAMPLES / "icon.svg")
    names = [entry.name for entry in raised.traceback]
    assert "raising" in names
    if use == "svg":
        assert "icon.svg" in raised.value.__notes__[0]
    several = made.warp_svgs([SAMPLES / "icon.svg", b"<svg"])
    assert isinstance(several[0], Oops) and isinstance(several[1], pathwarp.InputError)


@pytest.mark.parametrize(
    "answer, words",
    [
        (lambda x, y: x, "must give a pair"),
        (lambda x, y: None, "NoneType"),
        (lambda x, y: (x, y, x), "tuple of 3"),
        (lambda x, y: (x, y[:1]), "y has shape"),
        (lambda x, y: (x, "a"), "y is str"),
        (lambda x, y: (x + 1j, y), "complex128"),
        (lambda x, y: np.column_stack([x, y]), "must give a pair"),
    ],
)
def test_wrong_answers_are_named(answer, words):
    for use in (lambda d: d.map(np.ones((5, 2))), lambda d: d.warp_path(SQUARE)):
        with pytest.raises(pathwarp.UsageError, match=words) as raised:
            use(Deformation(answer))
        assert str(raised.value).startswith("the function: ")
    with pytest.raises(pathwarp.UsageError, match="jacobian: "):
        Deformation(wave, jacobian=answer).warp_path(SQUARE)


def test_no_number_is_no_image():
    hole = Deformation(lambda x, y: (np.where(x > 50, np.nan, x), y))
    assert np.isnan(hole.map([[60.0, 1.0]])[0, 0]) and hole.map([[40.0, 1.0]]).tolist() == [[40.0, 1.0]]
    with pytest.raises(pathwarp.GeometryError):
        hole.warp_path("M0,0 H100")
    with pytest.raises(pathwarp.GeometryError, match="the function gives no numbers there"):
        hole.warp_svg(SAMPLES / "logo.svg")


def test_it_may_call_the_library_and_other_threads_go_on():
    turn = Deformation("affine", rotate=90, about=(0, 0))
    nested = Deformation(lambda x, y: tuple(turn.map(np.column_stack([x, y])).T))
    points = np.random.default_rng(5).uniform(0, 9, (100_000, 2))
    assert np.allclose(nested.map(points), np.column_stack([-points[:, 1], points[:, 0]]))
    reached = threading.Event()

    def waits(x, y):
        # Another thread of Python has to go on for this to end.
        assert reached.wait(60)
        return x, y

    results = []
    worker = threading.Thread(target=lambda: results.append(Deformation(waits).warp_path(SQUARE)))
    worker.start()
    reached.set()
    worker.join(60)
    assert results == ["M0,0 L100,0 L100,50 L0,50 Z"]


def test_it_is_compared_shown_and_pickled():
    made = Deformation(wave, frame=(0, 0, 9, 9)).with_options(tolerance=0.5)
    assert made == Deformation(wave, frame=(0, 0, 9, 9)).with_options(tolerance=0.5) != Deformation(back)
    again = pickle.loads(pickle.dumps(made + "arc"))
    assert again == made + "arc" and again.warp_path(SQUARE) == (made + "arc").warp_path(SQUARE)
    assert repr(Deformation("warp", bend=0.4, style="arc")) == "Deformation('warp', style='arc', bend=0.4)"
    assert "Deformation('function')" in repr(made) and eval(repr(pathwarp.deform.arc(bend="40%"))) == Deformation("arc", bend="40%")
    with pytest.raises(pathwarp.UsageError, match="plug-in"):
        made.to_recipe()


def test_wrong_deformations_are_refused_when_they_are_made():
    for wrong in (5, None, 1.5):
        with pytest.raises(TypeError):
            Deformation(wrong)
        with pytest.raises(TypeError):
            pathwarp.warp_path(SQUARE, wrong)
    with pytest.raises(TypeError, match="jacobian"):
        Deformation(wave, jacobian=5)
    for name, values, words in [
        ("arc", {"bend": "x"}, "bend"),
        ("wave", {"height": "tall"}, "height"),
        ("mobius", {"pole": "5"}, "pole"),
        ("warp", {"style": "bent"}, "style"),
    ]:
        with pytest.raises(pathwarp.UsageError, match=words):
            Deformation(name, **values)
    with pytest.raises(pathwarp.UsageError, match="creases"):
        Deformation(wave, creases="line 1 2")
    with pytest.raises(pathwarp.UsageError, match="parameter"):
        Deformation(wave, bend=0.4)


def test_plug_ins_work_by_file_and_by_name(monkeypatch, tmp_path, cli):
    by_file = Deformation("ripple", plugins=[RIPPLE], height="5%")
    bent = by_file.warp_path(SQUARE)
    assert bent != SQUARE and pickle.loads(pickle.dumps(by_file)).warp_path(SQUARE) == bent
    with pytest.raises(pathwarp.UsageError, match="ripple"):
        Deformation("ripple")
    (tmp_path / "pathwarp-ripple").write_bytes(RIPPLE.read_bytes())
    (tmp_path / "pathwarp-ripple").chmod(0o755)
    monkeypatch.setenv("PATHWARP_PLUGINS", str(tmp_path))
    assert Deformation("ripple", height="5%").warp_path(SQUARE) == bent
    assert ("arc" + Deformation("ripple", height="5%")).warp_path(SQUARE).startswith("M")
    recipe = 'pathwarp = 1\n[[step]]\ndeformation = "ripple"\nheight = "5%"\n'
    assert Deformation.from_recipe(recipe).warp_path(SQUARE) == bent
    assert pathwarp.warp_svg(SAMPLES / "icon.svg", "ripple") == cli("ripple", SAMPLES / "icon.svg", "-o", "-")
    with pytest.raises(pathwarp.UsageError, match="did you mean"):
        Deformation("rippel", plugins=[RIPPLE])


def test_any_curve_is_fitted():
    d = pathwarp.fit(lambda t: (np.cos(t), np.sin(t)), 0, 2 * np.pi, 1e-3, precision=6)
    for segment in svgpathtools.parse_path(str(d)):
        assert all(abs(abs(segment.point(t)) - 1) < 1.1e-3 for t in np.linspace(0, 1, 50))
    corner = svgpathtools.parse_path(str(pathwarp.fit(lambda t: np.abs(t) + 1j * t, -1, 1, 1e-3, corners=[0])))
    assert len(corner) == 2 and abs(corner[0].end) < 1e-6
    # A wave of an odd frequency, which even samples miss, is not missed with its detail.
    many = pathwarp.fit(lambda t: (t, np.sin(2 * np.pi * 17 * t)), 0, 1, 1e-2, detail=1 / 68)
    assert many.count("C") + many.count(" ") > 17
    with pytest.raises(pathwarp.UsageError, match="pair"):
        pathwarp.fit(lambda t: t, 0, 1, 1e-3)


def test_shapes_come_back_as_they_were_given():
    circle = np.array([[100 * math.cos(t), 100 * math.sin(t)] for t in np.linspace(0, 2 * math.pi, 400)])
    few = pathwarp.simplify(circle, tolerance=1)
    assert few.shape[1] == 2 and len(few) < 60 and np.all(np.abs(np.hypot(*few.T) - 100) < 2)
    numbers = pathwarp.simplify(circle[:, 0] + 1j * circle[:, 1], tolerance=1)
    assert np.allclose(numbers, few[:, 0] + 1j * few[:, 1])
    square = svgpathtools.parse_path("M0,0 H40 V40 H0 Z")
    grown = pathwarp.offset(square, 5, join="miter")
    assert type(grown) is type(square) and abs(abs(grown.area()) - 50 * 50) < 1e-6
    one = pathwarp.unite("M0,0 H40 V40 H0 Z M20,20 H60 V60 H20 Z")
    assert abs(svgpathtools.parse_path(str(one)).area()) == pytest.approx(2 * 1600 - 400)
    two = pathwarp.unite([(0, 0), (4, 0), (4, 4), (0, 4), (0, 0)])
    assert np.isnan(two).sum() == 0 and {tuple(p) for p in two.tolist()} == {(0, 0), (4, 0), (4, 4), (0, 4)}
    around = pathwarp.contour("M0,0 H40 V40 H0 Z M60,0 H100 V40 H60 Z", 5)
    assert around.upper().count("M") == 2

    class Path:
        """As svgelements has it: made from path data, and written by `d()`."""

        def __init__(self, d):
            self.data = d

        def d(self):
            return self.data

    assert type(pathwarp.offset(Path("M0,0 H40 V40 H0 Z"), 5)) is Path


def test_the_wheel_has_its_papers():
    metadata = importlib.metadata.metadata("pathwarp")
    assert sorted(metadata.get_all("License-File")) == ["LICENSE-APACHE", "LICENSE-MIT"]
    assert any("Repository" in url for url in metadata.get_all("Project-URL"))
    texts = [f.read_text() for f in importlib.metadata.files("pathwarp") if f.name.startswith("LICENSE")]
    assert len(texts) == 2 and any("Permission is hereby granted" in t for t in texts)
    assert "\n\n" in pathwarp.deform.bend.__doc__ and json.dumps(pathwarp.deform.bend.__doc__)


def faults(function, frame=None, **of_function):
    checks = Deformation(function, **of_function).check(frame)
    return {check.name: check.faults for check in checks if check.faults}


def test_mistakes_are_told_by_their_kind():
    assert not faults(wave) and not faults(wave, jacobian=slopes, inverse=back, detail=14)
    for wrong, name, words in (
        (lambda x, y: (x, y + abs(x - 50)), "creases", "declare a crease at line 1 0 -50"),
        (lambda x, y: (x, y + np.maximum(0, 20 - np.hypot(x - 50, y - 40)) / 5), "creases", "at circle 50 40 20"),
        (lambda x, y: (x + (x > 50) * 9, y), "creases", "jumps by 9 at 50"),
        (lambda x, y: (np.nan * x, y), "values", "has no value at any of 81 places"),
        (lambda x, y: (7, 7), "values", "sends all points to one, or"),
        (lambda x, y: ((x + np.sin(y)).astype(np.float32), y), "values", "x' has the digits of single precision"),
        (lambda x, y: (x, np.round(y + np.sin(x), 3)), "values", "y' is rounded to 3 decimals"),
        (lambda x, y: (x + np.random.default_rng().random(x.shape), y), "values", "gives two answers for the point 3.7,4.3"),
        (lambda x, y: (x - x.mean(), y), "values", "may not depend on the other points of a batch"),
    ):
        found = faults(wrong)
        assert list(found) == [name] and words in found[name][0], found
    # Jacobians: a sign, and rows for columns.
    flat = faults(wave, jacobian=lambda x, y: ((1, 0), (-5 / 9 * np.cos(x / 9), 1)))
    assert flat["values"][0].startswith("∂y'/∂x is wrong at 81 of 81 places: -0.5"), flat
    rows = faults(wave, jacobian=lambda x, y: ((1, 5 / 9 * np.cos(x / 9)), (0, 1)))
    assert rows == {"values": ["its derivatives are transposed: ∂y'/∂x and ∂x'/∂y change places"]}
    # An inverse that is right in a part.
    root = faults(lambda x, y: ((x - 50) ** 2 / 50, y), inverse=lambda x, y: (50 + np.sqrt(50 * x), y))
    assert "at 45 of 81 places" in root["inverse"][0] and "the map folds" in root["inverse"][0]
    # Declared creases, half a plane, chains, and another box.
    assert not faults(lambda x, y: (x, y + abs(x - 50)), creases=[(1, 0, -50)])
    assert not faults(lambda x, y: (np.where(x > 50, x + np.sin(y / 9), np.nan), y))
    assert not any(check.faults for check in (Deformation(wave) + "arc").check())
    assert "line 1 0 -500" in faults(lambda x, y: (x, y + abs(x - 500)), frame=(0, 0, 900, 900))["creases"][0]
    with pytest.raises(ZeroDivisionError):
        Deformation(lambda x, y: 1 / 0).check()


def test_outlines_of_paths_are_of_their_kind():
    assert pathwarp.outline("M0,0 H40", width=10) == "M0,5 L40,5 L40,-5 L0,-5 Z"
    ring = pathwarp.outline(svgpathtools.parse_path("M10,50 A40,40 0 1 1 90,50 A40,40 0 1 1 10,50 Z"), width=4, tolerance=0.01)
    radii = {round(abs(p - (50 + 50j)), 1) for p in (side.point(0.3) for side in ring if not isinstance(side, svgpathtools.Line))}
    assert isinstance(ring, svgpathtools.Path) and radii == {38.0, 42.0}
    line = pathwarp.outline(np.array([[0, 0], [40, 0], [40, 30]]), width=2, join="round", cap="square")
    assert isinstance(line, np.ndarray) and abs(line[~np.isnan(line[:, 0])].min(0) - (-1, -1)).max() < 0.01
    assert pathwarp.outline(np.array([0, 40 + 0j]), width=2).dtype.kind == "c"
    for shapes, options, words in (
        ("M0,0 H40", {}, "width"),
        ("M0,0 H40", {"width": 0}, "width"),
        ("M0,0 H40", {"width": 2, "join": "mitre"}, "join: `mitre` is not one of miter"),
        (SAMPLES / "logo.svg", {"width": 2}, "have their own"),
        ("M0,0 L", {"width": 2}, "path data"),
    ):
        with pytest.raises(pathwarp.PathwarpError, match=words):
            pathwarp.outline(shapes, **options)

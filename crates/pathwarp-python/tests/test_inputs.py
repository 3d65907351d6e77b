"""What stands for a drawing, a path or points: the same result as from bytes, or words."""

import io
import pathlib
import xml.dom.minidom
from xml.etree import ElementTree

import numpy as np
import pytest

import pathwarp
from pathwarp import Deformation
from conftest import SAMPLES

FILE = SAMPLES / "logo.svg"
TEXT = FILE.read_text()
ARC = Deformation("arc", bend=0.4)
DOUBLE = Deformation("affine", scale_x=2, about=(0, 0))

SAME = {
    "path": lambda: FILE,
    "file name": lambda: str(FILE),
    "text": lambda: TEXT,
    "text with a BOM": lambda: "\ufeff\r\n " + TEXT,
    "bytearray": lambda: bytearray(TEXT.encode()),
    "memoryview": lambda: memoryview(TEXT.encode()),
    "open text file": lambda: FILE.open(),
    "open file": lambda: FILE.open("rb"),
    "text stream": lambda: io.StringIO(TEXT),
    "stream": lambda: io.BytesIO(TEXT.encode()),
    "a drawing that shows itself": lambda: type("Shown", (), {"_repr_svg_": lambda _: TEXT})(),
}


@pytest.mark.parametrize("given", SAME.values(), ids=SAME)
def test_a_drawing_in_any_form_is_that_of_its_bytes(given):
    # The name is in the report only.
    assert ARC.warp_svg(given()) == ARC.warp_svg(TEXT.encode())
    assert pathwarp.warp_svg(given(), "arc", bend=0.4) == ARC.warp_svg(TEXT.encode())


def paths(svg):
    return [e.get("d") for e in ElementTree.fromstring(svg).iter() if e.get("d")]


def test_elements_and_trees():
    expected = paths(ARC.warp_svg(TEXT))
    tree = ElementTree.parse(FILE)
    given = [tree, tree.getroot(), xml.dom.minidom.parse(str(FILE))]
    # A drawing in another document, with text behind it.
    page = ElementTree.fromstring(f"<html>{TEXT[TEXT.index('<svg'):]}and so on</html>")
    given.append(page[0])
    lxml = pytest.importorskip("lxml.etree")
    tree = lxml.parse(str(FILE))
    given += [tree, tree.getroot(), lxml.fromstring(f"<html>{TEXT[TEXT.index('<svg'):]}and so on</html>")[0]]
    for one in given:
        assert expected and paths(ARC.warp_svg(one)) == expected
    assert page[0].tail.endswith("and so on")


def test_a_decoded_text_is_not_decoded_again():
    head = '<?xml version="1.0" encoding="iso-8859-1"?>'
    svg = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9"><title>é✓</title><path d="M0,0H9V9z"/></svg>'
    for text in (head + svg, head.replace('"', "'") + svg, svg):
        assert "é✓".encode() in DOUBLE.warp_svg(text)
        assert "é✓".encode() in DOUBLE.warp_svg(io.StringIO(text))
    assert "é</title>".encode() in DOUBLE.warp_svg((head + svg.replace("✓", "")).encode("latin-1"))


def test_linked_pictures_are_found_beside_a_file(tmp_path):
    file = tmp_path / "page.svg"
    link = '<image href="dot.png" width="9" height="9"/>'
    file.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 20 20">{link}<path d="M0,0H9V9z"/></svg>')
    (tmp_path / "dot.png").write_bytes(DOUBLE.warp_svg(np.full((3, 3, 3), 200, np.uint8)))
    for given in (file, str(file), file.open("rb")):
        warped = ARC.warp_svg(given)
        assert b"data:image/png" in warped and warped.report["file"] == str(file)


def test_pixels_are_pictures():
    png = ARC.warp_svg(np.zeros((20, 30, 3), np.uint8))
    assert png.startswith(b"\x89PNG")
    image = pytest.importorskip("PIL.Image")
    pixels = np.random.default_rng(3).integers(0, 256, (24, 40, 4), np.uint8)
    pixels[..., 3] = 255
    still = Deformation("affine", move_x=0)
    for given in (pixels, pixels[..., :3], pixels[:, ::-1][:, ::-1], pixels[..., 0], pixels[..., :1]):
        back = np.asarray(image.open(io.BytesIO(still.warp_svg(given))).convert("RGBA"))
        expected = np.broadcast_to(given.reshape(24, 40, -1)[..., :3], (24, 40, 3))
        assert np.array_equal(back[..., :3], expected)
        # Pillow's own pictures, also with a palette.
        picture = image.fromarray(given.squeeze())
        for mode in ("", "P", "1"):
            one = picture.convert(mode) if mode else picture
            back = image.open(io.BytesIO(still.warp_svg(one))).convert("RGBA")
            assert np.array_equal(np.asarray(back), np.asarray(one.convert("RGBA")))


REFUSED = [
    (None, "NoneType is not a drawing"),
    (7, "int is not a drawing"),
    ([TEXT, TEXT], "warp_svgs takes several"),
    ("M0,0 H9", "warp_path"),
    ("nothing.svg", "nothing.svg: cannot be read: No such file or directory; the text is taken for a file's name"),
    (pathlib.Path("nothing.svg"), "nothing.svg: cannot be read: No such file"),
    (SAMPLES, "cannot be read: Is a directory"),
    ("", "empty"),
    ("a\0b", "cannot be read"),
    ("<svg>\ud800</svg>", "surrogates"),
    (np.zeros((4, 4, 3)), "astype('uint8')"),
    (np.zeros((4, 4, 7), np.uint8), "shape (4, 4, 7)"),
    (np.zeros((0, 4), np.uint8), "shape (0, 4)"),
    (ElementTree.fromstring("<g/>"), "<svg>"),
]


@pytest.mark.parametrize("given,words", REFUSED, ids=[r[1] for r in REFUSED])
def test_what_is_no_drawing_is_refused_in_words(given, words):
    with pytest.raises(pathwarp.PathwarpError) as caught:
        ARC.warp_svg(given)
    assert words in str(caught.value)
    # In a list it stands for itself alone.
    first, second = ARC.warp_svgs([given, FILE])
    assert isinstance(first, type(caught.value)) and isinstance(second, pathwarp.Warped)


def test_one_drawing_is_not_a_list():
    for one in (TEXT, TEXT.encode(), FILE, ElementTree.fromstring(TEXT), np.zeros((4, 4, 3), np.uint8), FILE.open()):
        with pytest.raises(pathwarp.UsageError, match="warp_svg warps one"):
            ARC.warp_svgs(one)
    assert len(ARC.warp_svgs(np.zeros((2, 4, 4, 3), np.uint8))) == 2
    assert len(ARC.warp_svgs(f for f in [FILE, TEXT])) == 2


def test_paths():
    expected = "M0,0 L2,1 L4,0"
    d = "M0,0 L1,1 L2,0"
    element = ElementTree.fromstring(f"<path d='{d}'/>")
    points = np.array([[0, 0], [1, 1], [2, 0]])
    for given in (d, d.encode(), bytearray(d.encode()), io.StringIO(d), element, points, points.tolist(), [0j, 1 + 1j, 2]):
        assert DOUBLE.warp_path(given) == expected
    for given, words in [(FILE, "warp_svg"), (TEXT, "warp_svg"), (None, "d: "), (ElementTree.fromstring("<g/>"), "no attribute d")]:
        with pytest.raises(pathwarp.PathwarpError, match=words):
            DOUBLE.warp_path(given)
    assert Deformation("bend", along=b"M0,0 H9") == Deformation("bend", along="M0,0 H9")
    about = Deformation("affine", rotate=30, about=(1.0, 2.0))
    assert all(Deformation("affine", rotate=30, about=z) == about for z in (1 + 2j, np.complex64(1 + 2j), np.array(1 + 2j)))


def test_complex_numbers_are_points():
    assert DOUBLE.map(3 + 4j) == 6 + 4j and type(DOUBLE.map(3 + 4j)) is complex
    grid = np.arange(6).reshape(2, 3) * (1 + 2j)
    for given in (grid, grid.astype(np.complex64), grid.tolist(), np.asfortranarray(grid), grid[::-1][::-1]):
        assert np.array_equal(DOUBLE.map(given), 2 * grid.real + 1j * grid.imag)
    pairs = np.stack([grid.real, grid.imag], -1).reshape(-1, 2)
    swirl = Deformation("swirl", frame=(0, 0, 9, 9))
    assert np.array_equal(swirl.jacobian(grid).reshape(-1, 2, 2), swirl.jacobian(pairs))
    assert swirl.jacobian(1j).shape == (2, 2) and DOUBLE.map(np.zeros(0, complex)).shape == (0,)
    out = np.zeros((2, 6), complex)[:, ::2]
    assert DOUBLE.map(grid, out=out) is out and np.array_equal(out, DOUBLE.map(grid))
    assert DOUBLE.map(out, out=out) is out and np.array_equal(out, DOUBLE.map(DOUBLE.map(grid)))


def test_out_is_named_and_checked():
    y = np.array([3.0, 4.0])
    with pytest.raises(TypeError):
        DOUBLE.map(np.array([1.0, 2.0]), y)
    assert y.tolist() == [3, 4]
    for points, out in [((1, 2), np.zeros(3)), ((1, 2), np.zeros((1, 2))), ([1j], np.zeros((1, 2))), ([[1, 2]], np.zeros(1, complex)), ((1, 2), [0, 0])]:
        with pytest.raises(pathwarp.UsageError, match="out: is .* as the points"):
            DOUBLE.map(points, out=out)
    wide = np.zeros(4)
    assert DOUBLE.map((1, 2), out=wide[::2]).tolist() == [2, 2] and wide.tolist() == [2, 0, 2, 0]
    assert DOUBLE.map(y, out=y) is y and y.tolist() == [6, 4]


def test_few_points_have_no_box():
    for name in ("swirl", "arc", "polar", "bulge", "wave", "mobius", "ffd"):
        with pytest.raises(pathwarp.UsageError, match=r"the box of the points has no size.*frame=\(x, y, width, height\)"):
            Deformation(name).map((3, 4))
        assert Deformation(name, frame=(0, 0, 9, 9)).map((3, 4)).shape == (2,)
        assert Deformation(name).map([]).shape == (0, 2) and Deformation(name).jacobian(np.zeros((0, 2))).shape == (0, 2, 2)
    assert (Deformation("swirl") + "arc").map([]).shape == (0, 2)
    assert Deformation("swirl", radius=5, center=(3, 3)).map((3, 3)).tolist() == [3, 3]
    # What lacks besides is said as ever.
    with pytest.raises(pathwarp.UsageError, match="shaper is needed"):
        Deformation("shaper").map((3, 4))
    with pytest.raises(pathwarp.UsageError, match="radius"):
        Deformation("swirl", radius=-1).map((3, 4))
    for wrong in ([(0, 0), 1j], ["a", "b"], [object(), 1], None):
        with pytest.raises(pathwarp.UsageError, match="points: "):
            DOUBLE.map(wrong)

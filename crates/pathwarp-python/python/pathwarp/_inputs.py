"""What stands for a drawing, a path or points."""

from __future__ import annotations

import copy
import os
import re
import struct
import sys
import zlib
from typing import Any, List, Optional, Tuple

import numpy as np
from numpy.typing import NDArray

from . import _native
from ._errors import InputError, UsageError

DRAWINGS = "bytes, text, the name of a file, an open file, an element of ElementTree or lxml, or an array of pixels"
_PATH_DATA = re.compile(r"\s*[Mm]\s*[-+.\d]")


def drawing(given: Any) -> Tuple[bytes, Optional[str]]:
    """The bytes of a drawing or picture, and the name of its file if there is one."""
    if isinstance(given, (bytes, bytearray)):
        return bytes(given), None
    if isinstance(given, str):
        return _of_text(given)
    if isinstance(given, os.PathLike):
        return _of_file(os.fsdecode(given))
    if callable(getattr(given, "read", None)):
        return _of_open_file(given)
    if callable(getattr(given, "d", None)):
        raise UsageError(f"{type(given).__name__} is a path, not a drawing; warp_path bends paths")
    markup = _markup(given)
    if markup is not None:
        return markup, None
    if isinstance(given, memoryview) and given.ndim == 1:
        return given.tobytes(), None
    if hasattr(given, "__array_interface__") or hasattr(given, "__array__") or isinstance(given, memoryview):
        return _png(given), None
    more = "; warp_svgs takes several" if hasattr(given, "__iter__") else ""
    raise UsageError(f"{type(given).__name__} is not a drawing: give {DRAWINGS}{more}")


def is_one(given: Any) -> bool:
    """It is one drawing, where several are wanted."""
    if isinstance(given, (bytes, bytearray, memoryview, str, os.PathLike)):
        return True
    array = getattr(given, "ndim", 4) < 4
    return array or any(hasattr(given, name) for name in ("read", "tag", "getroot", "toxml", "d", "convert", "_repr_svg_"))


def _of_text(text: str) -> Tuple[bytes, Optional[str]]:
    markup = text.lstrip("\ufeff \t\r\n")
    if markup.startswith("<"):
        # The text is decoded already, whatever it says.
        declared = re.match(r"<\?xml[^>]*?(\sencoding\s*=\s*(?:\"[^\"]*\"|'[^']*'))", markup)
        if declared:
            markup = markup[: declared.start(1)] + markup[declared.end(1) :]
        try:
            return markup.encode(), None
        except UnicodeEncodeError as e:
            raise InputError(f"the drawing: {e}") from None
    if not markup:
        raise InputError("the drawing is an empty text")
    if _PATH_DATA.match(text):
        raise InputError("the text is taken for a file's name, as it does not begin with `<`, but it is path data; warp_path bends that")
    return _of_file(text, "; the text is taken for a file's name, as it does not begin with `<`")


def _of_file(name: str, why: str = "") -> Tuple[bytes, str]:
    try:
        with open(name, "rb") as opened:
            return opened.read(), name
    except (OSError, ValueError) as e:
        short = name if len(name) < 200 else name[:200] + "…"
        problem = getattr(e, "strerror", None) or e
        raise InputError(f"{short}: cannot be read: {problem}{why}", place=name) from e


def _of_open_file(opened: Any) -> Tuple[bytes, Optional[str]]:
    name = getattr(opened, "name", None)
    name = name if isinstance(name, str) and os.path.isfile(name) else None
    try:
        content = opened.read()
    except (OSError, ValueError) as e:
        raise InputError(f"{name or 'the open file'}: cannot be read: {e}", place=name) from e
    if isinstance(content, str):
        markup = content.lstrip("\ufeff \t\r\n")
        content = _of_text(markup)[0] if markup.startswith("<") else markup.encode(errors="replace")
    if not isinstance(content, (bytes, bytearray)):
        raise UsageError(f"{type(opened).__name__}: read() gives {type(content).__name__}, not bytes or text")
    return bytes(content), name


def _markup(given: Any) -> Optional[bytes]:
    """The text of an element, a tree, or an object that shows itself as SVG."""
    if callable(getattr(given, "toxml", None)):
        return bytes(given.toxml("utf-8"))
    if hasattr(given, "getroot") or (hasattr(given, "tag") and hasattr(given, "iter")):
        if type(given).__module__.startswith("lxml"):
            return bytes(sys.modules["lxml.etree"].tostring(given, with_tail=False))
        from xml.etree import ElementTree

        element = copy.copy(given.getroot() if hasattr(given, "getroot") else given)
        element.tail = None
        return bytes(ElementTree.tostring(element, "utf-8"))
    for name in ("_repr_svg_", "tostring"):
        if callable(getattr(given, name, None)) and not hasattr(given, "dtype"):
            text = getattr(given, name)()
            return _of_text(text)[0] if isinstance(text, str) else None
    return None


def _png(given: Any) -> bytes:
    """Pixels as a PNG."""
    if hasattr(given, "mode") and hasattr(given, "convert"):
        # A picture of Pillow: its own kinds of pixels.
        clear = "A" in given.mode or "a" in given.mode or "transparency" in given.info
        given = given.convert("RGBA" if clear else "L" if given.mode in "1L" else "RGB")
    pixels = np.asarray(given)
    if pixels.dtype != np.uint8:
        hint = "(pixels * 255).round()" if pixels.dtype.kind == "f" else "pixels"
        raise UsageError(f"pixels: are {pixels.dtype}, not whole numbers from 0 to 255; give {hint}.astype('uint8')")
    kinds = {1: 0, 2: 4, 3: 2, 4: 6}
    shape = pixels.shape if pixels.ndim == 3 else (*pixels.shape, 1)
    if len(shape) != 3 or shape[2] not in kinds or 0 in shape:
        raise UsageError(f"pixels: have shape {pixels.shape}; it must be (height, width), or (height, width, n) with n from 1 to 4")
    height, width, channels = shape
    rows = np.zeros((height, 1 + width * channels), np.uint8)
    rows[:, 1:] = pixels.reshape(height, -1)

    def chunk(kind: bytes, content: bytes) -> bytes:
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    head = struct.pack(">IIBBBBB", width, height, 8, kinds[channels], 0, 0, 0)
    body = zlib.compress(rows.tobytes(), 1)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", body) + chunk(b"IEND", b"")


def path(given: Any) -> str:
    """Path data."""
    if isinstance(given, os.PathLike):
        raise UsageError(f"{os.fsdecode(given)} is a file; warp_svg warps drawings, and warp_path bends path data")
    if callable(getattr(given, "d", None)):
        return str(given.d())
    if hasattr(given, "tag") and callable(getattr(given, "get", None)):
        data = given.get("d")
        if data is None:
            raise UsageError(f"the element {given.tag} has no attribute d")
        return str(data)
    if callable(getattr(given, "read", None)):
        given = given.read()
    if isinstance(given, (bytes, bytearray, memoryview)):
        try:
            given = bytes(given).decode()
        except UnicodeDecodeError as e:
            raise InputError(f"path data: {e}") from None
    if isinstance(given, str):
        if given.lstrip("\ufeff \t\r\n").startswith("<"):
            raise UsageError("path data: this is a drawing; warp_svg warps drawings")
        return given
    points, _ = coordinates(given, "d")
    return "M" + " ".join(f"{x!r},{y!r}" for x, y in points.tolist())


def is_path(given: Any) -> bool:
    """It is a path, where a drawing may stand, too."""
    if isinstance(given, str):
        return bool(_PATH_DATA.match(given))
    if callable(getattr(given, "d", None)):
        return True
    array = np.asarray(given) if isinstance(given, (list, tuple, np.ndarray)) else np.zeros(0, np.uint8)
    return array.dtype.kind == "c" or (array.ndim == 2 and array.shape[1] == 2 and array.dtype.kind in "fi")


def like(given: Any, data: str, tolerance: float) -> Any:
    """Path data as what was given: text, a path of svgpathtools or svgelements, or points."""
    if isinstance(given, (str, bytes)) or hasattr(given, "tag"):
        return data
    if callable(getattr(given, "d", None)):
        package = type(given).__module__.split(".")[0]
        if package == "svgpathtools":
            return sys.modules["svgpathtools"].parse_path(str(data))
        made = getattr(sys.modules[package], "Path", type(given))
        return made(str(data))
    points = _flattened(data, tolerance)
    return points[:, 0] + 1j * points[:, 1] if np.asarray(given).dtype.kind == "c" else points


def stroked(data: str, width: float, join: str, cap: str) -> bytes:
    """A drawing of a line along path data."""
    for name, word, words in (("join", join, ("miter", "round", "bevel")), ("cap", cap, ("butt", "round", "square"))):
        if word not in words:
            raise UsageError(f"{name}: `{word}` is not one of {', '.join(words)}")
    if _native.path_box(data) is None:
        # The error that names the first bad place; nothing is drawn for no path.
        _native.Warper.edit("simplify", []).warp_path(data)
        raise UsageError("path data: is empty")
    x, y, w, h = (repr(v) for v in _native.path_box(data) or ())
    style = f"fill='none' stroke='#000' stroke-width='{width!r}' stroke-linejoin='{join}' stroke-linecap='{cap}'"
    page = f"<svg xmlns='http://www.w3.org/2000/svg' viewBox='{x} {y} {float(w) or 1!r} {float(h) or 1!r}'>"
    return f"{page}<path {style} d='{data}'/></svg>".encode()


def data_of(drawing: bytes) -> str:
    """The data of the only path of a drawing."""
    from xml.etree import ElementTree

    return " ".join(str(e.get("d")) for e in ElementTree.fromstring(drawing).iter() if e.get("d"))


def size(data: str) -> float:
    """The diagonal of the box of path data, above 0."""
    box = _native.path_box(data) or [0.0, 0.0, 0.0, 0.0]
    return float(np.hypot(box[2], box[3])) or 1.0


def _flattened(data: str, tolerance: float) -> NDArray[np.float64]:
    """The corners of polylines within a distance of path data; a row of NaN stands between two."""
    verbs, coordinates = _native.path_verbs(data)
    points = coordinates.reshape(-1, 2)
    out: List[NDArray[np.float64]] = []
    first = last = np.zeros(2)
    at = 0
    for verb in verbs:
        count = {"M": 1, "L": 1, "Q": 2, "C": 3, "Z": 0}[verb]
        p = points[at : at + count]
        at += count
        if verb == "M":
            out += [np.full((1, 2), np.nan)] if out else []
            first = p[0]
        elif verb == "Z":
            p = first[np.newaxis] if np.any(first != last) else p
        elif count > 1:
            p = _curve(np.concatenate([last[np.newaxis], p]), tolerance)
        out.append(p)
        last = p[-1] if len(p) else last
    return np.concatenate(out) if out else np.zeros((0, 2))


def _curve(control: NDArray[np.float64], tolerance: float) -> NDArray[np.float64]:
    """Points of a Bézier curve after its first: a chord is at most max|B''|/8 n² away."""
    degree = len(control) - 1
    bend = degree * (degree - 1) * np.hypot(*np.diff(control, 2, axis=0).T).max()
    n = int(np.clip(np.ceil(np.sqrt(bend / (8 * tolerance))), 1, 10_000))
    t = np.linspace(0, 1, n + 1)[1:, np.newaxis]
    layers = control[:, np.newaxis] + 0 * t
    for _ in range(degree):
        layers = layers[:-1] * (1 - t) + layers[1:] * t
    return np.asarray(layers[0])


def coordinates(given: Any, name: str = "points") -> Tuple[NDArray[np.float64], Optional[Tuple[int, ...]]]:
    """Points as an array of shape (n, 2), not copied if it is one; for complex numbers also their shape."""
    try:
        array = np.asarray(given)
        if array.dtype.kind == "c":
            flat = np.ascontiguousarray(array, dtype=np.complex128).reshape(-1)
            return flat.view(np.float64).reshape(-1, 2), array.shape
        if array.dtype.kind in "SUV":
            raise TypeError("texts" if array.dtype.kind != "V" else "records")
        array = np.asarray(array, dtype=np.float64)
    except (TypeError, ValueError) as e:
        raise UsageError(f"{name}: are not numbers: pairs (x, y), or complex numbers ({e})") from None
    if array.shape == (0,):
        array = array.reshape(0, 2)
    if array.shape == (2,):
        return array.reshape(1, 2), None
    if array.ndim != 2 or array.shape[1] != 2:
        raise UsageError(f"{name}: has shape {array.shape}; it must be (n, 2), or (2,) for one point")
    return array, None

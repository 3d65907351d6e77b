"""Bend, warp and deform vector paths and SVG drawings, and get clean Bézier curves back.

    >>> import pathwarp
    >>> pathwarp.warp_path("M0,0 H100 V50 H0 Z", "arc", bend=0.4, tolerance=1, precision=0)
    'M-29,10 C18,-25 82,-25 129,10 L100,50 C70,28 30,28 0,50 Z'

`Deformation` maps points, paths and drawings; `warp_path` and `warp_svg` are short forms. `deformations()` lists what there is, and
`pathwarp.deform` has a function for each. The numbers are those of the command line, whose names and values these are.
"""

from __future__ import annotations

import difflib
import os
from typing import Any, Callable, Dict, Iterable, Mapping, Optional, Tuple, Union

import numpy as np

from . import _inputs, deform

from ._catalog import Info, Parameter, deformations, find, options, python_name
from ._deformation import Deformation, Frame, Steps, Warped, WarpedPath
from ._errors import GeometryError, InputError, InternalError, LimitError, PathwarpError, UsageError
from ._native import __version__, use_threads
from ._reports import Check, PathReport, Report, Selection, ShapeReport, Skipped

__all__ = [
    "Check",
    "Deformation",
    "Frame",
    "GeometryError",
    "Info",
    "InputError",
    "InternalError",
    "LimitError",
    "Parameter",
    "PathReport",
    "PathwarpError",
    "Report",
    "Selection",
    "ShapeReport",
    "Skipped",
    "Steps",
    "UsageError",
    "Warped",
    "WarpedPath",
    "__version__",
    "contour",
    "deform",
    "deformations",
    "fit",
    "offset",
    "options",
    "outline",
    "simplify",
    "unite",
    "use_threads",
    "warp_path",
    "warp_svg",
]

for _error in (PathwarpError, UsageError, InputError, GeometryError, LimitError, InternalError):
    _error.__module__ = __name__


def warp_path(d: Any, deformation: Steps, /, **values: Any) -> WarpedPath:
    """Bends a path by a deformation, and returns path data.

    `d` is SVG path data, a path of svgpathtools, an element with an attribute `d`, or points, which become a polyline.

    `values` are parameters of the deformation, if that is given by its name, and the options `tolerance`, `frame`, `certify`,
    `nodes`, `precision` and `limit`: `warp_path("M0,0 H100", "arc", bend=0.4, tolerance=0.01)`.
    """
    chosen, given = _divided(deformation, values)
    return chosen.warp_path(d, **given)


def warp_svg(
    svg: Any,
    deformation: Steps,
    /,
    *,
    name: Union[str, "os.PathLike[str]", None] = None,
    **values: Any,
) -> Warped:
    """Warps a drawing, and returns the file that the command line would write.

    `svg` is the content of a file (bytes, or a text that begins with `<`), its name (a Path, or another text), an open file, an element or
    tree of ElementTree or lxml, or an array of pixels.

    `deformation` is a name, a Deformation, a list of them, or the Path of a recipe. `values` are parameters of the deformation, if that
    is given by its name, and options: `warp_svg(svg, "arc", bend=0.4, fit="grow")`.
    """
    chosen, given = _divided(deformation, values)
    return chosen.warp_svg(svg, name=name, **given)


def fit(
    curve: Callable[[Any], Any], start: float, end: float, tolerance: float, /, *, corners: Iterable[float] = (), **options: Any
) -> WarpedPath:
    """Fits Bézier curves to a curve, within `tolerance`, and returns path data.

    `curve` takes an array of parameters from `start` to `end`, and gives a pair of arrays, x and y, or an array of complex numbers.
    `corners` are the parameters at which it has one. Options are those of a path, and `detail`: no feature takes a shorter interval.

        >>> import numpy as np, pathwarp
        >>> d = pathwarp.fit(lambda t: (np.cos(t), np.sin(t)), 0, 2 * np.pi, 1e-3, precision=4)
        >>> d.count("C"), d.report["max_error"] <= 1e-3
        (4, True)
    """

    def image(t: Any, _: Any) -> Any:
        given = curve(t)
        return (given.real, given.imag) if getattr(given, "dtype", np.dtype(float)).kind == "c" else given

    detail = options.pop("detail", None)
    shown = Deformation(image, creases=[(1.0, 0.0, -float(t)) for t in corners], detail=detail)
    return shown.warp_path([(start, 0.0), (end, 0.0)], tolerance=tolerance, **options)


def simplify(
    shapes: Any,
    /,
    *,
    corners: Any = None,
    name: Union[str, "os.PathLike[str]", None] = None,
    **options: Any,
) -> Any:
    """Gives the paths of a drawing the fewest nodes within `tolerance`, as `pathwarp simplify` does.

    `shapes` is a drawing, as `warp_svg` takes it, and the file is returned; or a path, and one of its kind is returned: path data, a path of
    svgpathtools or svgelements, or an array of points, which are then those of polylines within `tolerance`, with a row of NaN between
    two. The other functions for shapes do so, too. Joints that turn by more than `corners` degrees stay corners; without it, those for
    which no smooth curve can stand within `tolerance`.

        >>> import pathwarp
        >>> pathwarp.simplify("M0,0 C5,0 10,.5 15,1.5 C20,2.5 25,4 30,6 L60,60", tolerance=0.1)
        'M0,0 C10.261,0 20.473,2.189 30,6 L60,60'
    """
    return _edited("simplify", {"corners": corners}, shapes, name, options)


def offset(
    shapes: Any,
    by: Any,
    /,
    *,
    join: str = "round",
    side: str = "outside",
    name: Union[str, "os.PathLike[str]", None] = None,
    **options: Any,
) -> Any:
    """Lets areas of a drawing or path grow or shrink by a distance (`2`, `"2mm"`), and lines run beside themselves, as `pathwarp offset` does.

    `join` is round, miter or bevel, `side` outside, inside or both. `shapes` and the result are as those of `simplify`.
    """
    return _edited("offset", {"by": by, "join": join, "side": side}, shapes, name, options)


def outline(
    shapes: Any,
    /,
    *,
    width: Optional[float] = None,
    join: str = "miter",
    cap: str = "butt",
    name: Union[str, "os.PathLike[str]", None] = None,
    **options: Any,
) -> Any:
    """Turns strokes and text into filled outlines, as `pathwarp outline` does.

    `shapes` and the result are as those of `simplify`. A path has no stroke of its own: `width` is that of its line, `join` is miter, round
    or bevel, and `cap` butt, round or square.

        >>> import pathwarp
        >>> pathwarp.outline("M0,0 H40", width=10)
        'M0,5 L40,5 L40,-5 L0,-5 Z'
    """
    if not _inputs.is_path(shapes):
        if width is not None:
            raise UsageError("width: the strokes of a drawing have their own")
        return Deformation._edit("outline", {}).warp_svg(shapes, name=name, **options)
    if width is None or not float(width) > 0:
        raise UsageError("width: give that of the line along a path, above 0")
    data = _inputs.path(shapes)
    done = Deformation._edit("outline", {}).warp_svg(_inputs.stroked(data, float(width), join, cap), **options)
    return _inputs.like(shapes, _inputs.data_of(done), _tolerance(data, options))


def unite(
    shapes: Any, /, *, by: str = "all", name: Union[str, "os.PathLike[str]", None] = None, **options: Any
) -> Any:
    """Makes one shape of those of a drawing or path that overlap or touch, as `pathwarp unite` does; by "fill", one for each paint.

    `shapes` and the result are as those of `simplify`.
    """
    return _edited("unite", {"by": by}, shapes, name, options)


def contour(shapes: Any, by: Any, /, *, name: Union[str, "os.PathLike[str]", None] = None, **values: Any) -> Any:
    """Draws one line around all that is visible of a drawing or path, at a distance (`"3mm"`), as `pathwarp contour` does.

    `values` are its parameters `holes`, `join`, `only`, `spot`, `knockout`, `bleed` and `marks`, and options. `shapes` and the result are
    as those of `simplify`.
    """
    known = options()
    given = {name: value for name, value in values.items() if name in known}
    parameters = {name: value for name, value in values.items() if name not in known}
    return _edited("contour", {"by": by, **parameters}, shapes, name, given)


def _edited(
    edit: str, values: Mapping[str, Any], shapes: Any, name: Union[str, "os.PathLike[str]", None], options: Mapping[str, Any]
) -> Any:
    """A drawing edited, or a path of the kind that was given."""
    made = Deformation._edit(edit, values)
    if not _inputs.is_path(shapes):
        return made.warp_svg(shapes, name=name, **options)
    path = made.warp_path(shapes, **options)
    return _inputs.like(shapes, path, _tolerance(path, options))


def _tolerance(path: str, options: Mapping[str, Any]) -> float:
    """The tolerance of a path, in user units."""
    try:
        return float(options.get("tolerance", 0)) or _inputs.size(path) * 1e-4
    except (TypeError, ValueError):
        return _inputs.size(path) * 1e-4


def _divided(deformation: Steps, values: Mapping[str, Any]) -> Tuple[Deformation, Dict[str, Any]]:
    """The deformation with its parameters, and the options."""
    known = options()
    given = {name: value for name, value in values.items() if name in known}
    parameters = {name: value for name, value in values.items() if name not in known}
    if isinstance(deformation, str) or (callable(deformation) and not isinstance(deformation, Deformation)):
        return Deformation(deformation, **parameters), given
    if parameters:
        name = next(iter(parameters))
        near = difflib.get_close_matches(name, known, 1, 0.75)
        hint = f"did you mean `{near[0]}`?" if near else "parameters belong to the deformation itself"
        raise UsageError(f"`{name}` is not an option; {hint}", parameter=name)
    return Deformation.chain(deformation), given

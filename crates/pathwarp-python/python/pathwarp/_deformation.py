"""Deformations: what bends points, paths and drawings."""

from __future__ import annotations

import json
import os
from typing import Any, Dict, Iterable, List, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native, _values
from ._errors import InputError, PathwarpError, UsageError

Frame = Union[str, Sequence[float]]
"""A box: (x, y, width, height), or one of the names that the option `frame` has on the command line."""

Steps = Union[str, "Deformation", "os.PathLike[str]", Sequence[Union[str, "Deformation"]]]
"""A deformation, the name of one, the file of a recipe (as a Path), or a list of deformations."""


class WarpedPath(str):
    """Path data. `report` tells how it was made."""

    report: Dict[str, Any]


class Warped(bytes):
    """A warped drawing: the bytes of the file.

    `report` tells what was done, shape by shape, as the command line's `--report` does; `warnings` holds what the command line would
    print. `notes` are the decisions that the option `explain` asks for.
    """

    notes: List[str]
    warnings: List[str]
    """What the caller should know: artwork that folds over, leaves the page, or cannot be bent as it should."""

    _json: str
    _report: Optional[Dict[str, Any]] = None

    @property
    def report(self) -> Dict[str, Any]:
        """What was done, shape by shape."""
        # Read when it is asked for: for small drawings that takes a while.
        if self._report is None:
            self._report = json.loads(self._json)
        return self._report


class Deformation:
    """A deformation with its parameters, or several in a row.

    `Deformation("shaper", shaper="M0,90 Q40,110 95,85 L90,15 5,10 Z")` takes the name of a deformation, or of a preset such as `"arc"`,
    and its parameters by name. Values are numbers, text as on the command line (`"40%"`, `"12mm"`, `"cage.svg#flag"`), points `(x, y)`,
    lists of points, or paths of svgpathtools. `frame` is the box that percentages refer to, (x, y, width, height); without it, that
    is the bounding box of what is bent.

    `a + b` applies a, then b. Deformations are immutable, and can be pickled: file names in them are kept, not the files.
    """

    __slots__ = ("_warper", "_options")

    def __init__(self, name: str, /, *, frame: Optional[Frame] = None, **parameters: Any) -> None:
        self._warper = _native.Warper(name, _values.parameters(name, parameters))
        self._options: List[Tuple[str, str]] = []
        if frame is not None:
            self._add({"frame": frame})

    @classmethod
    def chain(cls, steps: Steps, /) -> "Deformation":
        """Deformations applied one after another: the first one first."""
        if isinstance(steps, Deformation):
            return steps
        if isinstance(steps, str):
            return cls(steps)
        if isinstance(steps, os.PathLike):
            return cls.from_recipe(steps)
        chained = [cls.chain(s) for s in steps]
        if not chained:
            raise UsageError("a list of deformations is empty")
        whole = chained[0]
        for later in chained[1:]:
            whole = whole + later
        return whole

    @classmethod
    def from_recipe(cls, recipe: Union[str, "os.PathLike[str]"], /, *, allow_external: bool = False) -> "Deformation":
        """A recipe as the command line saves it: its file as a Path, or its text.

        Files that it names are looked up beside it, those of a text in the current folder. Absolute names need `allow_external`.
        """
        if isinstance(recipe, os.PathLike):
            file = os.fspath(recipe)
            try:
                with open(file, encoding="utf-8") as opened:
                    text, folder = opened.read(), os.path.dirname(file)
            except (OSError, UnicodeDecodeError) as e:
                raise InputError(f"{file}: cannot be read: {e}") from e
        else:
            text, folder = recipe, ""
        return cls._of(_native.Warper.from_recipe(text, folder, allow_external), [])

    def to_recipe(self, folder: Union[str, "os.PathLike[str]"] = "") -> str:
        """The text of a recipe file in `folder`, for `pathwarp run`."""
        return self._warper.to_recipe(os.fspath(folder))

    def __add__(self, later: Union[str, "Deformation"]) -> "Deformation":
        if not isinstance(later, (str, Deformation)):
            return NotImplemented
        other = Deformation.chain(later)
        return self._of(self._warper.then(other._warper), self._options + other._options)

    def __radd__(self, earlier: str) -> "Deformation":
        return Deformation(earlier) + self if isinstance(earlier, str) else NotImplemented

    @property
    def steps(self) -> List[str]:
        """The names of the deformations."""
        return self._warper.steps

    def with_options(self, **options: Any) -> "Deformation":
        """The same with options of the command line: `frame`, `tolerance`, `strokes`… `pathwarp.options()` lists them."""
        changed = self._of(self._warper, list(self._options))
        changed._add(options)
        return changed

    def inverse(self, frame: Optional[Frame] = None) -> "Deformation":
        """The deformation that undoes this one.

        `frame` is the box of the source, which percentages and defaults refer to; it may have been given before.
        """
        framed = self if frame is None else self.with_options(frame=frame)
        if framed._warper.frame is None:
            raise UsageError("inverse: percentages and defaults refer to the box of the source; give frame=(x, y, width, height)")
        return self._of(framed._warper.inverted(), framed._options)

    def map(self, points: ArrayLike, out: Optional[NDArray[np.float64]] = None) -> NDArray[np.float64]:
        """Maps points, an array of shape (n, 2), or (2,) for one.

        An array of float64 is read where it is. `out` receives the result; it may be `points`. Where the map is undefined, the
        result is NaN. Large arrays are mapped on all processors; the result does not depend on their number.
        """
        source = np.asarray(points, dtype=np.float64)
        if source.ndim == 1 and source.shape == (2,):
            single = self._warper.map(source.reshape(1, 2), None if out is None else out.reshape(1, 2))
            return single.reshape(2) if out is None else out
        _check_points(source)
        if out is not None and not (isinstance(out, np.ndarray) and out.dtype == np.float64 and out.ndim == 2):
            raise UsageError("out: must be an array of float64 with the shape of the points")
        return self._warper.map(source, out)

    def jacobian(self, points: ArrayLike) -> NDArray[np.float64]:
        """The derivatives at points: an array of shape (n, 2, 2), or (2, 2) for one point.

        `j[i]` is [[∂x'/∂x, ∂x'/∂y], [∂y'/∂x, ∂y'/∂y]] at point i: `j[i] @ v` is the image of a small step v.
        """
        source = np.asarray(points, dtype=np.float64)
        if source.ndim == 1 and source.shape == (2,):
            return self._warper.jacobian(source.reshape(1, 2))[0]
        _check_points(source)
        return self._warper.jacobian(source)

    def warp_path(self, d: Any, /, **options: Any) -> WarpedPath:
        """Bends SVG path data, or a path of svgpathtools, and returns path data.

        Options: `tolerance` (the largest distance from the exact result), `frame`, `certify`, `merge`, `precision`, `limit`.
        """
        data, report = self._with(options).warp_path(_values.text(d, "d"))
        warped = WarpedPath(data)
        warped.report = report
        return warped

    def warp_svg(
        self, svg: Union[bytes, bytearray, memoryview, str], /, *, name: Union[str, "os.PathLike[str]", None] = None, **options: Any
    ) -> Warped:
        """Warps a drawing, or a picture in PNG, JPEG or WebP, and returns the file that the command line would write.

        `name` is the drawing's file, for messages and for linked pictures beside it. All options of the command line work that do
        not name outputs: `tolerance`, `strokes`, `fit`, `format="pdf"`… `pathwarp.options()` lists them with their help.
        """
        (done,) = self.warp_svgs([svg], names=None if name is None else [name], **options)
        if isinstance(done, PathwarpError):
            raise done
        return done

    def warp_svgs(
        self,
        svgs: Iterable[Union[bytes, bytearray, memoryview, str]],
        /,
        *,
        names: Optional[Iterable[Union[str, "os.PathLike[str]"]]] = None,
        **options: Any,
    ) -> List[Union[Warped, PathwarpError]]:
        """Warps many drawings, on all processors, and returns the results in their order, each as by `warp_svg`.

        In place of a drawing that cannot be warped stands the exception, so one bad file does not stop the others.
        """
        data = [svg.encode() if isinstance(svg, str) else bytes(svg) for svg in svgs]
        named: List[Optional[str]] = [None] * len(data) if names is None else [os.fspath(name) for name in names]
        if len(named) != len(data):
            raise UsageError(f"names: has {len(named)} entries for {len(data)} drawings")
        return [_warped(result) for result in self._with(options).warp_drawings(list(zip(data, named)))]

    def __repr__(self) -> str:
        return f"<pathwarp.Deformation {' + '.join(self.steps)}>"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Deformation):
            return NotImplemented
        return self._options == other._options and self.to_recipe() == other.to_recipe()

    def __hash__(self) -> int:
        return hash(self.to_recipe())

    def __reduce__(self) -> Tuple[Any, ...]:
        return _unpickled, (self.to_recipe(), os.getcwd(), self._options)

    @classmethod
    def _of(cls, warper: _native.Warper, options: List[Tuple[str, str]]) -> "Deformation":
        made = cls.__new__(cls)
        made._warper, made._options = warper, options
        return made

    def _add(self, options: Dict[str, Any]) -> None:
        pairs = _values.options(options)
        self._warper = self._warper.with_options(pairs)
        self._options = self._options + pairs

    def _with(self, options: Dict[str, Any]) -> _native.Warper:
        return self._warper.with_options(_values.options(options)) if options else self._warper


def _warped(result: Union[Tuple[bytes, str, List[str], List[str]], PathwarpError]) -> Union[Warped, PathwarpError]:
    if isinstance(result, PathwarpError):
        return result
    content, report, warnings, notes = result
    made = Warped(content)
    made._json, made.warnings, made.notes = report, warnings, notes
    return made


def _unpickled(recipe: str, folder: str, options: List[Tuple[str, str]]) -> Deformation:
    made = Deformation._of(_native.Warper.from_recipe(recipe, folder, True), list(options))
    stored = [(name, value) for name, value in options if f"{name} = " not in recipe.split("[[step]]")[0]]
    made._warper = made._warper.with_options(stored)
    return made


def _check_points(points: NDArray[np.float64]) -> None:
    if points.ndim != 2 or points.shape[1] != 2:
        raise UsageError(f"points: has shape {points.shape}; it must be (n, 2)")

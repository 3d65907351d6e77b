"""Deformations: what bends points, paths and drawings."""

from __future__ import annotations

import json
import os
from typing import Any, Callable, Dict, Iterable, List, Mapping, Optional, Sequence, Tuple, Union, cast, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _functions, _inputs, _native, _show, _values
from ._catalog import find
from ._errors import InputError, PathwarpError, UsageError, in_python
from ._functions import Function
from ._reports import Check, PathReport, Report

Frame = Union[str, Sequence[float]]
"""A box: (x, y, width, height), or one of the names that the option `frame` has on the command line."""

Steps = Union[str, "Deformation", Function, "os.PathLike[str]", Sequence[Union[str, "Deformation", Function]]]
"""A deformation, the name of one, a function of x and y, the file of a recipe (as a Path), or a list of deformations."""


class WarpedPath(str):
    """Path data. `report` tells how it was made. Notebooks show it."""

    report: PathReport

    def _repr_svg_(self) -> Optional[str]:
        box = _native.path_box(self)
        return None if box is None else _show.page(self, box)


class Warped(bytes):
    """A warped drawing or picture: the bytes of the file. Notebooks show it.

    `report` tells what was done, shape by shape, as the command line's `--report` does; `warnings` holds what the command line would
    print. `notes` are the decisions that the option `explain` asks for.
    """

    notes: List[str]
    warnings: List[str]
    """What the caller should know: artwork that folds over, leaves the page, or cannot be bent as it should."""

    _json: str
    _report: Optional[Report] = None

    @property
    def report(self) -> Report:
        """What was done, shape by shape."""
        # Read when it is asked for: for small drawings that takes a while.
        if self._report is None:
            self._report = json.loads(self._json)
        return cast(Report, self._report)

    def _repr_svg_(self) -> Optional[str]:
        return _show.svg(self)

    def _repr_png_(self) -> Optional[bytes]:
        return bytes(self) if self.startswith(b"\x89PNG\r\n") else None

    def _repr_jpeg_(self) -> Optional[bytes]:
        return bytes(self) if self.startswith(b"\xff\xd8\xff") else None


class Deformation:
    """A deformation with its parameters, or several in a row.

    `Deformation("shaper", shaper="M0,90 Q40,110 95,85 L90,15 5,10 Z")` takes the name of a deformation, or of a preset such as `"arc"`,
    and its parameters by name. Values are numbers, text as on the command line (`"40%"`, `"12mm"`, `"cage.svg#flag"`), points `(x, y)`,
    lists of points, or paths of svgpathtools. `frame` is the box that percentages refer to, (x, y, width, height); without it, that
    is the bounding box of what is bent.

    A function is a deformation, too: `Deformation(lambda x, y: (x, y + 5 * np.sin(x / 9)))`. It is called with two arrays, x and y, and
    gives a pair of arrays. `jacobian(x, y)` may give the derivatives, ((∂x'/∂x, ∂x'/∂y), (∂y'/∂x, ∂y'/∂y)); without it they are
    differences. `inverse(x, y)` leads back. `creases` are lines and circles at which it has a kink, in user units: `(a, b, c)` for
    a·x + b·y + c = 0, or `"circle X Y R"`; `"edge line A B C"` ends its domain where that is negative. `detail` is the size of its
    smallest feature, a quarter of its shortest wave; without it, reports say that curves were sampled. NaN is no image. An exception of
    the function comes out as it was raised.

    `plugins` are files of plug-ins that may have the name; those of the user's folder are known.

    `a + b` applies a, then b. Deformations are immutable, and can be pickled: file names in them are kept, not the files.
    """

    __slots__ = ("_warper", "_options", "_made")

    def __init__(
        self,
        name: Union[str, Function],
        /,
        *,
        frame: Optional[Frame] = None,
        plugins: Iterable[Union[str, "os.PathLike[str]"]] = (),
        jacobian: Optional[Function] = None,
        inverse: Optional[Function] = None,
        creases: Any = None,
        detail: Optional[float] = None,
        **parameters: Any,
    ) -> None:
        of_function = {"jacobian": jacobian, "inverse": inverse, "creases": creases, "detail": detail}
        self._made: Optional[Tuple[Any, ...]] = None
        if isinstance(name, str):
            given = {**parameters, **{key: value for key, value in of_function.items() if value is not None}}
            files = [os.fspath(p) for p in plugins]
            self._warper = _native.Warper(name, _values.parameters(name, given), files)
            if files:
                self._made = (Deformation, (name,), {**given, "plugins": files})
        elif callable(name) and not isinstance(name, Deformation):
            if parameters:
                raise UsageError(f"`{next(iter(parameters))}` is a parameter, which a function does not have")
            self._warper = _functions.warper(name, jacobian, inverse, creases, detail)
            self._made = (Deformation, (name,), of_function)
        else:
            raise TypeError(f"a deformation is a name or a function of x and y, not {type(name).__name__}")
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
        if callable(steps):
            return cls(steps)
        if not isinstance(steps, Iterable):
            raise TypeError(f"a deformation is a name, a Deformation, a function or a list of them, not {type(steps).__name__}")
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

    @classmethod
    def _edit(cls, name: str, values: Mapping[str, Any]) -> "Deformation":
        """What the command `name` does to shapes without bending them."""
        return cls._of(_native.Warper.edit(name, _values.options(values)), [])

    def to_recipe(self, folder: Union[str, "os.PathLike[str]"] = "") -> str:
        """The text of a recipe file in `folder`, for `pathwarp run`."""
        return self._warper.to_recipe(os.fspath(folder))

    def __add__(self, later: Union[str, "Deformation", Function]) -> "Deformation":
        if not isinstance(later, (str, Deformation)) and not callable(later):
            return NotImplemented
        other = Deformation.chain(later)
        joined = self._of(self._warper.then(other._warper), self._options + other._options)
        if self._made or other._made:
            joined._made = (Deformation.chain, ([self, other],), {})
        return joined

    def __radd__(self, earlier: Union[str, Function]) -> "Deformation":
        return Deformation(earlier) + self if isinstance(earlier, str) or callable(earlier) else NotImplemented

    @property
    def steps(self) -> List[str]:
        """The names of the deformations."""
        return self._warper.steps

    def with_options(self, **options: Any) -> "Deformation":
        """The same with options of the command line: `frame`, `tolerance`, `strokes`… `pathwarp.options()` lists them."""
        changed = self._of(self._warper, list(self._options), self._made)
        changed._add(options)
        return changed

    def inverse(self, frame: Optional[Frame] = None) -> "Deformation":
        """The deformation that undoes this one.

        `frame` is the box of the source, which percentages and defaults refer to; it may have been given before.
        """
        framed = self if frame is None else self.with_options(frame=frame)
        if framed._warper.frame is None:
            raise UsageError(
                "an inverse does not know the box of the source, which percentages and defaults refer to: "
                "give it (frame=(x, y, width, height))"
            )
        made = framed._made and (Deformation.inverse, (framed,), {})
        return self._of(framed._warper.inverted(), framed._options, made)

    @overload
    def map(self, points: complex, *, out: None = None) -> complex: ...  # type: ignore[overload-overlap]
    @overload
    def map(
        self, points: NDArray[np.complexfloating[Any, Any]], *, out: Optional[NDArray[np.complex128]] = None
    ) -> NDArray[np.complex128]: ...
    @overload
    def map(self, points: ArrayLike, *, out: Optional[NDArray[np.float64]] = None) -> NDArray[np.float64]: ...
    def map(self, points: Any, *, out: Any = None) -> Any:
        """Maps points, an array of shape (n, 2), or (2,) for one, or complex numbers x + yj in an array of any shape.

        An array of float64 is read where it is. `out` receives the result; it may be `points`. Where the map is undefined, the
        result is NaN. Large arrays are mapped on all processors; the result does not depend on their number.
        """
        source, of_numbers = _inputs.coordinates(points)
        if of_numbers is not None:
            _check_out(out, np.complex128, of_numbers)
            numbers = self._warper.map(source).view(np.complex128).reshape(of_numbers)
            if out is None:
                return complex(numbers[()]) if isinstance(points, complex) else numbers
            out[...] = numbers
            return out
        shape = (2,) if np.shape(points) == (2,) else source.shape
        _check_out(out, np.float64, shape)
        if shape != (2,):
            return self._warper.map(source, out)
        single = self._warper.map(source)[0]
        if out is None:
            return single
        out[:] = single
        return out

    def jacobian(self, points: ArrayLike) -> NDArray[np.float64]:
        """The derivatives at points: an array of shape (n, 2, 2), or (2, 2) for one point; the shape of complex numbers, and (2, 2).

        `j[i]` is [[∂x'/∂x, ∂x'/∂y], [∂y'/∂x, ∂y'/∂y]] at point i: `j[i] @ v` is the image of a small step v.
        """
        source, of_numbers = _inputs.coordinates(points)
        jacobians = self._warper.jacobian(source)
        if of_numbers is not None:
            return jacobians.reshape(*of_numbers, 2, 2)
        return jacobians[0] if np.shape(points) == (2,) else jacobians

    def check(self, frame: Optional[Frame] = None) -> List[Check]:
        """Looks for mistakes in the map over a box, without `frame` (0, 0, 100, 100): values, derivatives, creases, inverse, a refit.

            >>> fold = pathwarp.Deformation(lambda x, y: (x, y + abs(x - 50)))
            >>> print(*(check for check in fold.check() if check.faults))
            FAIL creases: 0 are declared; others were looked for on lines across the box
                has a kink at 50,2.3875, where its slope changes by 2; declare a crease at line 1 0 -50
        """
        framed = self if frame is None else self.with_options(frame=frame)
        return [Check(*made) for made in framed._warper.check()]

    def warp_path(self, d: Any, /, **options: Any) -> WarpedPath:
        """Bends a path, and returns path data.

        `d` is SVG path data, a path of svgpathtools, an element with an attribute `d`, or points, which become a polyline.

        Options: `tolerance` (the largest distance from the exact result), `frame`, `certify`, `nodes`, `precision`, `limit`.
        """
        data, report = self._with(options).warp_path(_inputs.path(d))
        warped = WarpedPath(data)
        warped.report = report
        return warped

    def warp_svg(self, svg: Any, /, *, name: Union[str, "os.PathLike[str]", None] = None, **options: Any) -> Warped:
        """Warps a drawing, or a picture in PNG, JPEG or WebP, and returns the file that the command line would write.

        `svg` is the content of the file (bytes, or a text that begins with `<`), its name (a Path, or another text), an open file, an
        element or tree of ElementTree or lxml, or an array of pixels. `name` is the drawing's file, for messages and for linked pictures beside it. All options of the command line work that do
        not name outputs: `tolerance`, `strokes`, `fit`, `format="pdf"`… `pathwarp.options()` lists them with their help.
        """
        (done,) = self.warp_svgs([svg], names=None if name is None else [name], **options)
        if isinstance(done, Exception):
            raise done
        return done

    def warp_svgs(
        self,
        svgs: Iterable[Any],
        /,
        *,
        names: Optional[Iterable[Union[str, "os.PathLike[str]"]]] = None,
        progress: Optional[Callable[[int], object]] = None,
        **options: Any,
    ) -> List[Union[Warped, Exception]]:
        """Warps many drawings, on all processors, and returns the results in their order, each as by `warp_svg`.

        In place of a drawing that cannot be warped stands the exception, so one bad file does not stop the others. `progress` is called
        from time to time, and at the end, with the number of drawings that are done.
        """
        if _inputs.is_one(svgs):
            raise UsageError(f"warp_svgs takes a list of drawings, not one ({type(svgs).__name__}); warp_svg warps one")
        given = list(svgs)
        named: List[Any] = [None] * len(given) if names is None else list(names)
        if len(named) != len(given):
            raise UsageError(f"names: has {len(named)} entries for {len(given)} drawings")
        results: List[Union[Warped, Exception, None]] = [None] * len(given)
        read: List[Tuple[int, bytes, Optional[str]]] = []
        for i, (drawing, name) in enumerate(zip(given, named)):
            try:
                content, file = _inputs.drawing(drawing)
                read.append((i, content, file if name is None else os.fsdecode(name)))
            except PathwarpError as e:
                results[i] = e
        unread = len(given) - len(read)
        tell = progress and (lambda done: progress(unread + done))
        done = self._with(options).warp_drawings([(content, name) for _, content, name in read], tell)
        for (i, _, file), result in zip(read, done):
            results[i] = _warped(result)
            if isinstance(result, Exception) and not isinstance(result, PathwarpError):
                _note(result, f"in a function of pathwarp, while it warped {file or f'drawing {i + 1}'}")
        return [r for r in results if r is not None]

    def _repr_svg_(self) -> Optional[str]:
        return _show.grid(self)

    def __repr__(self) -> str:
        steps = " + ".join(_shown(*step) for step in self._warper.typed)
        options = ", ".join(f"{name.replace('-', '_')}={_value([value])}" for name, value in self._options)
        several = "(" if len(self.steps) > 1 else ""
        return f"{several}{steps}{')' if several else ''}.with_options({options})" if options else steps

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Deformation):
            return NotImplemented
        if self._made or other._made:
            return self._made == other._made and self._options == other._options
        return self._options == other._options and self.to_recipe() == other.to_recipe()

    def __hash__(self) -> int:
        return hash(tuple(self.steps) if self._made else self.to_recipe())

    def __reduce__(self) -> Tuple[Any, ...]:
        if self._made:
            return _made_again, (self._made, self._options)
        return _unpickled, (self.to_recipe(), os.getcwd(), self._options)

    @classmethod
    def _of(
        cls, warper: _native.Warper, options: List[Tuple[str, str]], made: Optional[Tuple[Any, ...]] = None
    ) -> "Deformation":
        """`made` is the call that makes it, if a recipe cannot tell: of functions, and of plug-ins in files."""
        of = cls.__new__(cls)
        of._warper, of._options, of._made = warper, options, made
        return of

    def _add(self, options: Dict[str, Any]) -> None:
        pairs = _values.options(options)
        self._warper = self._warper.with_options(pairs)
        self._options = self._options + pairs

    def _with(self, options: Dict[str, Any]) -> _native.Warper:
        return self._warper.with_options(_values.options(options)) if options else self._warper


def _note(error: Exception, note: str) -> None:
    """Adds a line below the error's own, which Python shows from version 3.11 on."""
    notes = getattr(error, "__notes__", [])
    error.__notes__ = [*notes, note]  # type: ignore[attr-defined]


def _shown(name: str, values: List[Tuple[str, List[str]]], inverse: bool) -> str:
    """A step as it would be written."""
    if name.startswith("function #"):
        name = "function"
    info = find(name)
    order = [p.name.rstrip("_").replace("_", "-") for p in info.parameters] if info else []
    values = sorted(values, key=lambda v: order.index(v[0]) if v[0] in order else len(order))
    arguments = [repr(name), *(f"{key.replace('-', '_')}={_value(texts)}" for key, texts in values)]
    return f"Deformation({', '.join(arguments)})" + (".inverse()" if inverse else "")


def _value(texts: List[str]) -> str:
    def one(text: str) -> str:
        try:
            return repr(float(text)) if "." in text or "e" in text.lower() else repr(int(text))
        except ValueError:
            return {"true": "True", "false": "False"}.get(text, repr(text))

    return one(texts[0]) if len(texts) == 1 else f"[{', '.join(map(one, texts))}]"


def _made_again(made: Tuple[Any, ...], options: List[Tuple[str, str]]) -> Deformation:
    call, arguments, named = made
    again: Deformation = call(*arguments, **named)
    # The deformations in it have brought their options.
    later = options[len(again._options) :]
    again._warper, again._options = again._warper.with_options(later), list(options)
    return again


def _warped(result: Union[Tuple[bytes, str, List[str], List[str]], Exception]) -> Union[Warped, Exception]:
    if isinstance(result, Exception):
        return result
    content, report, warnings, notes = result
    made = Warped(content)
    made._json, made.warnings, made.notes = report, [*map(in_python, warnings)], [*map(in_python, notes)]
    return made


def _unpickled(recipe: str, folder: str, options: List[Tuple[str, str]]) -> Deformation:
    made = Deformation._of(_native.Warper.from_recipe(recipe, folder, True), list(options))
    stored = [(name, value) for name, value in options if f"{name} = " not in recipe.split("[[step]]")[0]]
    made._warper = made._warper.with_options(stored)
    return made


def _check_out(out: Any, dtype: Any, shape: Tuple[int, ...]) -> None:
    if out is None:
        return
    if not isinstance(out, np.ndarray) or out.dtype != dtype or out.shape != shape:
        has = f"{out.dtype} of shape {out.shape}" if isinstance(out, np.ndarray) else type(out).__name__
        raise UsageError(f"out: is {has}; it must be an array of {np.dtype(dtype)} of shape {shape}, as the points")
    if not out.flags.writeable:
        raise UsageError("out: is read-only")

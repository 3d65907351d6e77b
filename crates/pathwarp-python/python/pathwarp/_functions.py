"""Functions of Python as deformations: what they are called with, and what they may give."""

from __future__ import annotations

from typing import Any, Callable, List, Optional, Tuple

import numpy as np
from numpy.typing import NDArray

from . import _native
from ._errors import UsageError

Function = Callable[..., Any]
"""Takes two arrays, x and y, of shape (n,), and gives a pair of arrays, or of numbers where a coordinate is the same for all."""


class Caller:
    """Asks a function, its Jacobian or its inverse for many points, and checks the answers."""

    def __init__(self, function: Function, jacobian: Optional[Function], inverse: Optional[Function]) -> None:
        self._function, self._jacobian, self._inverse = function, jacobian, inverse

    def __call__(self, kind: str, points: NDArray[np.float64]) -> NDArray[np.float64]:
        if kind == "inverse":
            return np.column_stack(_pair("inverse", self._inverse, points)).ravel()
        values = _pair("the function", self._function, points)
        if kind == "points":
            return np.column_stack(values).ravel()
        x_by_x, x_by_y, y_by_x, y_by_y = _derivatives(self._jacobian, points)
        return np.column_stack([*values, x_by_x, y_by_x, x_by_y, y_by_y]).ravel()


def warper(
    function: Function,
    jacobian: Optional[Function],
    inverse: Optional[Function],
    creases: Any,
    detail: Optional[float],
) -> _native.Warper:
    """The function as a deformation."""
    for name, given in (("jacobian", jacobian), ("inverse", inverse)):
        if given is not None and not callable(given):
            raise TypeError(f"{name}: {type(given).__name__} is not a function of x and y")
    if detail is not None and not float(detail) > 0:
        raise UsageError(f"detail: {detail} is not a length above 0")
    gives = (jacobian is not None, inverse is not None)
    return _native.Warper.function(Caller(function, jacobian, inverse), gives, _creases(creases), detail)


def _creases(given: Any) -> List[str]:
    """Creases as plug-ins write them: `line A B C`, `circle X Y R`, `edge line A B C`; three numbers are a line."""
    if given is None:
        return []
    texts = [given] if isinstance(given, str) else list(given)
    return [t if isinstance(t, str) else "line " + " ".join(repr(float(v)) for v in t) for t in texts]


def _call(function: Any, points: NDArray[np.float64]) -> Any:
    # Copies: the function may change its arrays.
    return function(points[:, 0].copy(), points[:, 1].copy())


def _pair(name: str, function: Any, points: NDArray[np.float64]) -> Tuple[NDArray[np.float64], NDArray[np.float64]]:
    answer = _call(function, points)
    n = len(points)
    if isinstance(answer, (str, bytes)) or not hasattr(answer, "__len__") or len(answer) != 2:
        raise UsageError(f"{name}: gave {_described(answer)} for {n} points; it must give a pair, as (x, y + 1) is")
    return _numbers(name, "x", answer[0], n), _numbers(name, "y", answer[1], n)


def _derivatives(function: Any, points: NDArray[np.float64]) -> List[NDArray[np.float64]]:
    answer = _call(function, points)
    n = len(points)
    shape = "((dx'/dx, dx'/dy), (dy'/dx, dy'/dy))"
    if not hasattr(answer, "__len__") or len(answer) != 2 or any(not hasattr(row, "__len__") or len(row) != 2 for row in answer):
        raise UsageError(f"jacobian: gave {_described(answer)} for {n} points; it must give two pairs, {shape}")
    names = iter(("dx'/dx", "dx'/dy", "dy'/dx", "dy'/dy"))
    return [_numbers("jacobian", next(names), entry, n) for row in answer for entry in row]


def _numbers(name: str, part: str, given: Any, n: int) -> NDArray[np.float64]:
    array = np.asarray(given)
    if array.dtype.kind not in "fiub":
        raise UsageError(f"{name}: {part} is {_described(given)}, not an array of real numbers")
    if array.shape not in ((), (n,)):
        raise UsageError(f"{name}: {part} has shape {array.shape} for {n} points; it must have shape ({n},)")
    return np.broadcast_to(array.astype(np.float64), (n,))


def _described(given: Any) -> str:
    if isinstance(given, np.ndarray):
        return f"an array of {given.dtype} of shape {given.shape}"
    many = f" of {len(given)}" if isinstance(given, (tuple, list)) else ""
    return f"{type(given).__name__}{many}"

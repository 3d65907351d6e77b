"""Python's values as the command line's text."""

from __future__ import annotations

import os
from typing import Any, Iterable, List, Mapping, Tuple

import numpy as np

from ._catalog import find
from ._errors import UsageError


def parameters(deformation: str, values: Mapping[str, Any]) -> List[Tuple[str, str]]:
    """The parameters of a deformation as pairs of name and text. A value of None is not given."""
    info = find(deformation)
    repeated = {p.name for p in info.parameters if p.repeat} if info else set()
    return list(_pairs(values, repeated))


_LISTS = {"select", "exclude", "font_file", "fonts_dir", "limit"}


def options(values: Mapping[str, Any]) -> List[Tuple[str, str]]:
    """Options as pairs of name and text. A value of None is not given."""
    limit = values.get("limit")
    if isinstance(limit, Mapping):
        values = {**values, "limit": [f"{name}={'none' if n is None else text(n)}" for name, n in limit.items()]}
    return list(_pairs(values, _LISTS))


def _pairs(values: Mapping[str, Any], repeated: Iterable[str]) -> Iterable[Tuple[str, str]]:
    for name, value in values.items():
        if value is None:
            continue
        # A list of texts or of points for a parameter that repeats is one value for each.
        several = name in repeated and isinstance(value, (list, tuple)) and not _is_point(value)
        for one in value if several else [value]:
            as_text = text(one, name)
            if not (isinstance(one, (bool, np.bool_)) and not one):
                yield name.rstrip("_").replace("_", "-"), as_text


def text(value: Any, name: str = "value") -> str:
    """One value as text: numbers with all their digits, points as `x,y`, lists of points as `x,y x,y`."""
    if isinstance(value, str):
        return value
    if isinstance(value, (bytes, bytearray)):
        return os.fsdecode(bytes(value))
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if getattr(value, "shape", None) == ():
        value = value.item()
    if isinstance(value, os.PathLike):
        return os.fsdecode(value)
    if hasattr(value, "d") and callable(value.d):
        return str(value.d())
    if isinstance(value, complex):
        return f"{_number(value.real)},{_number(value.imag)}"
    try:
        return _number(value)
    except TypeError:
        pass
    try:
        items = list(value)
    except TypeError:
        raise UsageError(f"{name}: {type(value).__name__} is not a number, text, point or list of points") from None
    points = any(not _is_number(item) for item in items)
    return (" " if points else ",").join(text(item, name) for item in items)


def _number(value: Any) -> str:
    if hasattr(value, "__index__"):
        return str(int(value))
    if not hasattr(value, "__float__") or np.ndim(value):
        raise TypeError
    return repr(float(value))


def _is_number(value: Any) -> bool:
    real = not isinstance(value, (complex, np.complexfloating))
    return real and (isinstance(value, (int, float)) or (hasattr(value, "__float__") and not getattr(value, "ndim", 0)))


def _is_point(value: Any) -> bool:
    return len(value) == 2 and all(_is_number(v) for v in value)

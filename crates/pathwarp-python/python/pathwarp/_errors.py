"""The exceptions. Messages say what is wrong, where, and what to do."""

from __future__ import annotations

import functools
import re


class PathwarpError(Exception):
    """Any error of pathwarp."""

    def __init__(self, message: str = "") -> None:
        super().__init__(_in_python(message))


class UsageError(PathwarpError, ValueError):
    """A name or a value is wrong."""


class InputError(PathwarpError, ValueError):
    """A file or a drawing cannot be read."""


class GeometryError(PathwarpError, ArithmeticError):
    """The geometry does not allow the deformation."""


class LimitError(PathwarpError, RuntimeError):
    """The work exceeds a limit; the option `limit` raises it."""


class InternalError(PathwarpError, RuntimeError):
    """pathwarp itself failed. Please report it."""


def _in_python(message: str) -> str:
    """The names of options and parameters in a message as Python has them: `on-error` is `on_error`."""
    return _names().sub(lambda m: m.group().replace("-", "_"), message)


@functools.lru_cache(maxsize=None)
def _names() -> re.Pattern[str]:
    from ._catalog import names

    hyphenated = sorted((n for n in names() if "-" in n), key=len, reverse=True)
    return re.compile(r"(?<![\w./-])(?:" + "|".join(map(re.escape, hyphenated)) + r")(?![\w./-])")

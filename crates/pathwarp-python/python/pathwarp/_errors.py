"""The exceptions. Messages say what is wrong, where, and what to do."""

from __future__ import annotations

import functools
import re
from typing import Mapping, Optional, Tuple, Union


class PathwarpError(Exception):
    """Any error of pathwarp. What the message says is in the attributes too, as far as there is something to say."""

    parameter: Optional[str]
    """The parameter or option that is wrong."""
    value: Optional[str]
    """Its value, as text."""
    place: Union[str, Tuple[float, float], None]
    """The file, with the line where there is one, or the point of the drawing."""
    limit: Optional[str]
    """The limit that is exceeded: `limit={e.limit: e.needs}` raises it."""
    needs: Optional[float]
    """A value of the limit that is enough, or ten times the limit if that is not known."""

    def __init__(
        self,
        message: str = "",
        *,
        parameter: Optional[str] = None,
        value: Optional[str] = None,
        place: Union[str, Tuple[float, float], None] = None,
        limit: Optional[str] = None,
        needs: Optional[float] = None,
    ) -> None:
        self.parameter = parameter and parameter.replace("-", "_")
        text = in_python(message)
        super().__init__(text.replace(f"`{parameter}`", f"`{self.parameter}`") if parameter else text)
        self.value, self.place, self.limit, self.needs = value, place, limit, needs


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


def in_python(message: str) -> str:
    """A message of the command line as Python has it: `--fit grow` is `fit="grow"`, and `on-error` is `on_error`."""
    if "-" not in message:
        return message
    flags, names = _patterns()
    return names.sub(lambda m: m.group().replace("-", "_"), flags.sub(_argument, message))


def _argument(found: re.Match[str]) -> str:
    """A flag, with its value if one follows, as an argument of a call."""
    name, value = found["name"].replace("-", "_"), found["value"]
    if not value:
        return name
    bare = value.rstrip(".,;:") if value[0] != "'" else value
    after = value[len(bare) :]
    limit = re.fullmatch(r"([a-z]+)=(\w+)", bare) if name == "limit" else None
    if limit:
        amount = "None" if limit[2] == "none" else limit[2]
        return f'limit={{"{limit[1]}": {amount}}}{after}'
    if bare == "X,Y,W,H":
        return f"{name}=(x, y, width, height){after}"
    if bare[0] == "'":
        return f'{name}="{bare[1:-1]}"{after}'
    if all(_NUMBER.fullmatch(part) for part in bare.split(",")):
        several = bare.split(",")
        return f"{name}={several[0] if len(several) == 1 else '(' + ', '.join(several) + ')'}{after}"
    if bare[0] in "-+.0123456789" or all(word in _words()[found["name"]] for word in bare.split("|")):
        quoted = " or ".join(f'"{word}"' for word in bare.split("|"))
        return f"{name}={quoted}{after}"
    return f"{name} {value}"


_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?")


@functools.lru_cache(maxsize=None)
def _words() -> Mapping[str, Tuple[str, ...]]:
    """The names of the command line, with the words that they can be."""
    from ._catalog import words

    return words()


@functools.lru_cache(maxsize=None)
def _patterns() -> Tuple[re.Pattern[str], re.Pattern[str]]:
    names = sorted(_words(), key=len, reverse=True)
    either = "|".join(map(re.escape, names))
    flags = re.compile(rf"(?<![^\s(`“])--(?P<name>{either})(?![\w-])(?: (?P<value>'[^']*'|[^\s()`]+))?")
    hyphenated = "|".join(re.escape(n) for n in names if "-" in n)
    return flags, re.compile(rf"(?<![\w./-])(?:{hyphenated})(?![\w./-])")

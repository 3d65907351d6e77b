"""The deformations that there are, with their parameters and presets: data, from the registry."""

from __future__ import annotations

import functools
import json
import keyword
from dataclasses import dataclass
from typing import Mapping, Optional, Tuple

from . import _native


@dataclass(frozen=True)
class Parameter:
    """A parameter of a deformation."""

    name: str
    """The name in Python: `reverse_shaper` is `--reverse-shaper` on the command line."""
    kind: str
    """flag, number, numbers, length, angle, count, point, path, choice, text, name-or-file or file."""
    notation: str
    """The placeholder of the value in the command line's help."""
    choices: Tuple[str, ...]
    """The words that the value can be."""
    default: Optional[str]
    """The default as typed on the command line."""
    needed: bool
    """It must be given."""
    repeat: bool
    """It takes a list of values."""
    range: Tuple[Optional[float], Optional[float]]
    """The legal values, both ends included; None is no limit. Lengths in user units, angles in degrees."""
    slider: Tuple[float, float]
    """The range of an editor's slider."""
    help: str


@dataclass(frozen=True)
class Info:
    """A deformation."""

    name: str
    title: str
    group: str
    about: str
    source: str
    """The paper or program that the mathematics comes from."""
    parameters: Tuple[Parameter, ...]
    presets: Tuple[str, ...]
    """Names that stand for this deformation with a preset: `"arc"` for `warp` with `style="arc"`."""
    preset_parameter: Optional[str]
    """The parameter that takes a preset's name."""
    examples: Tuple[str, ...]
    """Command lines, after the word pathwarp."""


@functools.lru_cache(maxsize=None)
def deformations() -> Mapping[str, Info]:
    """All deformations by name, in the order of the menu."""
    return {d["name"]: _info(d) for d in json.loads(_native.catalog())}


@functools.lru_cache(maxsize=None)
def options() -> Mapping[str, str]:
    """The options of a warp with their help, by their names in Python."""
    return {python_name(name): help for name, help, _ in _native.option_help()}


def words() -> Mapping[str, Tuple[str, ...]]:
    """The names of all parameters and options on the command line, with the words that they can be."""
    known = {name: tuple(words) for name, _, words in _native.option_help()}
    for d in json.loads(_native.catalog()):
        for p in d["parameters"]:
            known[p["name"]] = known.get(p["name"], ()) + tuple(p["choices"])
    frames = ("artwork", "viewbox", "ink", "baseline-ascent", "baseline-capheight", "baseline-xheight")
    return {**known, "frame": frames}


def python_name(name: str) -> str:
    """A name of the command line in Python. Python's own words get an underscore: `from_`."""
    return name.replace("-", "_") + ("_" if keyword.iskeyword(name) else "")


def find(name: str) -> Optional[Info]:
    """The deformation that a name means, which may be that of a preset."""
    lower = name.lower()
    known = deformations()
    return known.get(lower) or next((d for d in known.values() if lower in d.presets), None)


def _info(d: dict[str, object]) -> Info:
    fields = dict(d)
    fields["parameters"] = tuple(_parameter(p) for p in fields["parameters"])  # type: ignore[attr-defined]
    fields["presets"] = tuple(fields["presets"])  # type: ignore[arg-type]
    fields["examples"] = tuple(fields["examples"])  # type: ignore[arg-type]
    return Info(**fields)  # type: ignore[arg-type]


def _parameter(p: dict[str, object]) -> Parameter:
    fields = dict(p)
    fields["name"] = python_name(str(fields["name"]))
    for key in ("choices", "range", "slider"):
        fields[key] = tuple(fields[key])  # type: ignore[arg-type]
    return Parameter(**fields)  # type: ignore[arg-type]

"""A function for each deformation and preset, with its parameters and help: `deform.shaper(shaper=cage)` is
`Deformation("shaper", shaper=cage)`. `help(pathwarp.deform.shaper)` describes it.
"""

from __future__ import annotations

import inspect
import textwrap
from typing import Any, Callable, Optional

from ._catalog import Info, deformations, python_name
from ._deformation import Deformation, Frame

__all__: list[str] = []


def _function(info: Info, preset: Optional[str]) -> Callable[..., Deformation]:
    name = preset or info.name

    def make(*, frame: Optional[Frame] = None, **parameters: Any) -> Deformation:
        return Deformation(name, frame=frame, **parameters)

    own = [p for p in info.parameters if not (preset and p.name == info.preset_parameter)]
    keyword = inspect.Parameter.KEYWORD_ONLY
    needed = [inspect.Parameter(p.name, keyword) for p in own if p.needed]
    optional = [inspect.Parameter(p.name, keyword, default=None) for p in own if not p.needed]
    frame = inspect.Parameter("frame", keyword, default=None)
    make.__name__ = make.__qualname__ = python_name(name)
    make.__module__ = __name__
    make.__signature__ = inspect.Signature([*needed, *optional, frame])  # type: ignore[attr-defined]
    make.__doc__ = _doc(info, preset, own)
    return make


def _doc(info: Info, preset: Optional[str], own: list[Any]) -> str:
    title = f"{info.title}: {preset}." if preset else f"{info.title}."
    about = [part for line in info.about.split("\n") for part in (textwrap.wrap(line, 100) or [""])]
    examples = [line for command in info.examples for line in ("", f"    {command}")]
    lines = [title[0].upper() + title[1:], "", *about, "", "On the command line:", *examples, ""]
    for p in own:
        default = f" Default: {p.default}." if p.default else ""
        lines.append(f"{p.name} ({p.kind})")
        lines.extend(textwrap.wrap(p.help + default, 100, initial_indent="    ", subsequent_indent="    "))
    lines += ["frame (box)", "    The box that percentages and defaults refer to: (x, y, width, height)."]
    lines += ["", f"Source: {info.source}"]
    return "\n".join(lines)


for _info in deformations().values():
    for _preset in (None, *_info.presets):
        _name = python_name(_preset or _info.name)
        globals()[_name] = _function(_info, _preset)
        __all__.append(_name)

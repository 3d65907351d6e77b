"""Prints the type stubs of pathwarp.deform, from the registry: python stubs.py > python/pathwarp/deform.pyi"""

from pathwarp._catalog import deformations, python_name

TYPES = {
    "flag": "bool",
    "number": "Number",
    "length": "Number",
    "angle": "Number",
    "count": "Union[int, str]",
    "numbers": "Union[str, Sequence[float]]",
    "point": "Point",
    "path": "PathLike",
    "text": "str",
    "choice": "str",
    "name-or-file": "File",
    "file": "File",
}

HEAD = '''"""Made by stubs.py from the registry."""

import os
from typing import Any, List, Literal, Optional, Sequence, Tuple, Union

from ._deformation import Deformation, Frame

Number = Union[float, str]
Point = Union[str, Tuple[Number, Number], complex]
File = Union[str, "os.PathLike[str]"]
'''
PATHS = """# Path data, FILE#NAME, points, the name of a shape, or a path of svgpathtools.
PathLike = Union[Shape, Any]
"""


def literal(words):
    return "Literal[" + ", ".join(f'"{w}"' for w in words) + "]"


def type_of(p):
    one = literal(p.choices) if p.kind == "choice" else TYPES[p.kind]
    return f"Union[{one}, Sequence[{one}]]" if p.repeat else one


shapes = next(p.choices for info in deformations().values() for p in info.parameters if p.kind == "path")
print(f"{HEAD}Shape = {literal(shapes)}\n{PATHS}")
for info in deformations().values():
    for preset in (None, *info.presets):
        own = [p for p in info.parameters if not (preset and p.name == info.preset_parameter)]
        print(f"def {python_name(preset or info.name)}(\n    *,")
        for p in sorted(own, key=lambda p: not p.needed):
            print(f"    {p.name}: {type_of(p)}," if p.needed else f"    {p.name}: Optional[{type_of(p)}] = None,")
        print("    frame: Optional[Frame] = None,\n) -> Deformation: ...")

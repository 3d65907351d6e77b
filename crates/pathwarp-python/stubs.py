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
# Path data, FILE#NAME, points, or a path of svgpathtools.
PathLike = Any
'''


def type_of(p):
    if p.kind == "choice":
        one = "Literal[" + ", ".join(f'"{c}"' for c in p.choices) + "]"
    else:
        one = TYPES[p.kind]
    return f"Union[{one}, Sequence[{one}]]" if p.repeat else one


print(HEAD)
for info in deformations().values():
    for preset in (None, *info.presets):
        own = [p for p in info.parameters if not (preset and p.name == info.preset_parameter)]
        print(f"def {python_name(preset or info.name)}(\n    *,")
        for p in sorted(own, key=lambda p: not p.needed):
            print(f"    {p.name}: {type_of(p)}," if p.needed else f"    {p.name}: Optional[{type_of(p)}] = None,")
        print("    frame: Optional[Frame] = None,\n) -> Deformation: ...")

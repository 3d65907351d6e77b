"""Use of the package that a strict type checker must accept."""

from pathlib import Path
from typing import Optional

import numpy as np

import pathwarp
from pathwarp import Deformation, deform

d: str = pathwarp.warp_path("M0,0 H100", "arc", bend=0.4)
shaper: Deformation = deform.shaper(shaper="M0,0 H9 V9 H0 Z", reverse_shaper=True, frame=(0, 0, 9, 9))
points = shaper.map(np.zeros((3, 2)))
points = shaper.inverse().map(points, out=points)
drawing: bytes = pathwarp.warp_svg(b"<svg/>", [shaper, "swirl"], fit="grow")
several: list[pathwarp.Warped] = [w for w in shaper.warp_svgs([b"<svg/>"]) if isinstance(w, pathwarp.Warped)]
recipe: Deformation = Deformation.chain(Path("recipe.toml"))
helps: list[str] = [p.help for i in pathwarp.deformations().values() for p in i.parameters]
error: float = pathwarp.warp_path("M0,0 H9", "arc").report["max_error"]
kept: list[pathwarp.ShapeReport] = pathwarp.warp_svg(Path("a.svg"), "arc").report["shapes"]
proven: list[float] = [s["max_error"] for s in kept if s["assurance"] == "certified"]
place: complex = shaper.map(3 + 4j)
places = shaper.map(np.zeros(3, complex), out=np.zeros(3, complex))
limit: tuple[Optional[str], Optional[float]] = (pathwarp.LimitError().limit, pathwarp.LimitError().needs)
shown: Optional[str] = shaper._repr_svg_()
function: Deformation = pathwarp.deform.arc(bend=0.4)

"""Mistakes that a type checker must find: each line is one."""

import pathwarp
from pathwarp import deform

arc = deform.arc(bend=0.4)
arc.warp_path("M0,0").report["max_eror"]
arc.warp_svg("a.svg").report["shapes"][0]["max_error"].upper()
arc.map([(0.0, 0.0)], [(0.0, 0.0)])
deform.arc(bnd=0.4)

"""Bends a figure of matplotlib along a wave, with few nodes: python plot.py FIGURE.svg OUT.svg"""

import sys
from pathlib import Path

import numpy as np

import pathwarp


def sheet(x, y):
    """A sheet of paper that hangs in the wind: the wave grows from left to right. Units are points, y down."""
    return x + 6 * np.sin(y / 40), y + (4 + x / 30) * np.sin(x / 40)


def main(figure: str, out: str) -> None:
    # matplotlib draws a curve as hundreds of straight lines. Simplified first, they are curves before they are bent.
    smooth = pathwarp.simplify(Path(figure), tolerance=0.05)
    bent = pathwarp.warp_svg(smooth, pathwarp.Deformation(sheet, detail=60), tolerance=0.05, strokes="keep", fit="grow")
    Path(out).write_bytes(bent)
    counts = [len(drawing.split(b"C")) + len(drawing.split(b"L")) for drawing in (Path(figure).read_bytes(), bytes(bent))]
    print(f"{counts[0]} pieces became {counts[1]}; {len(bent.report['shapes'])} shapes are bent")


if __name__ == "__main__":
    main(*sys.argv[1:])

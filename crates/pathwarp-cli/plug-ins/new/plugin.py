#!/usr/bin/env python3
"""@NAME@: a deformation for pathwarp. Change ENTRY and Map; `pathwarp check FILE` checks the result.

docs/plugin-protocol.md describes what pathwarp and this program say to each other.
"""

import json
import math
import re
import sys

ENTRY = {
    "pathwarp-plugin": 2,
    "protocol": "text",
    "name": "@NAME@",
    "title": "waves that run across the artwork",
    "about": "Moves every point up and down along a sine wave.",
    "source": "the plug-in pathwarp-@NAME@",
    "parameters": [
        {"name": "height", "kind": "length", "axis": "y", "default": "10%", "slider": [-100, 100],
         "help": "Height of a wave above the middle."},
        {"name": "wavelength", "kind": "length", "axis": "x", "default": "50%", "range": [0.001, 1e9],
         "slider": [1, 1000], "help": "Distance from wave to wave."},
    ],
    "examples": [
        {"what": "As it comes", "command": "@NAME@ samples/logo.svg -o out.svg"},
        {"what": "Short waves", "command": "@NAME@ samples/logo.svg --wavelength 10% --height 2% -o out.svg"},
    ],
    # What holds for every set of values; `pathwarp check` tries it over the box 0,0,100,100.
    "laws": [
        {"identity": {"height": 0}},
        {"area": [{}, 1]},
        {"undoes": [{"height": "7"}, {"height": "-7"}]},
    ],
    # Points whose images are known.
    "cases": [
        {"args": {"height": "4", "wavelength": "40"}, "at": [10, 5], "to": [10, 9], "tolerance": 1e-12},
    ],
}
REPEATED = {p["name"] for p in ENTRY["parameters"] if p.get("repeat")}


class Map:
    """The map for one set of values. Lengths are in user units, angles in degrees, y points down."""

    def __init__(self, frame, values):
        # frame is [x0, y0, x1, y1], the box that percentages refer to; a value is text, that of a repeated parameter a list of texts.
        self.height = float(values["height"])
        self.waves = math.tau / float(values["wavelength"])

    def point(self, x, y):
        return x, y + self.height * math.sin(self.waves * x)


def main():
    read, write, flush = sys.stdin.readline, sys.stdout.write, sys.stdout.flush
    write(json.dumps(ENTRY) + "\n")
    flush()
    point = None
    while line := read():
        command, count = line.split()
        lines = [read() for _ in range(int(count))]
        if command == "build":
            pairs = [line.rstrip("\n").partition(" ")[::2] for line in lines]
            values = {}
            for name, value in pairs:
                value = re.sub(r"\\(.)", lambda m: {"n": "\n", "r": "\r"}.get(m[1], m[1]), value)
                if name in REPEATED:
                    values.setdefault(name, []).append(value)
                else:
                    values[name] = value
            frame = [float(v) for v in values.pop("frame").split()]
            try:
                point = Map(frame, values).point
                write("ok\n")
            except ValueError as problem:
                write(f"error {problem}\n")
        elif command == "points":
            answers = []
            for line in lines:
                x, y = line.split()
                x, y = point(float(x), float(y))
                answers.append(f"{x!r} {y!r}\n")
            write("".join(answers))
        flush()


main()

#!/usr/bin/env python3
"""ripple: rings on water, as a plug-in in Python.

docs/plugin-protocol.md describes what pathwarp and this program say to each other.
"""

import json
import math
import re
import sys

ENTRY = {
    "pathwarp-plugin": 2,
    "protocol": "text",
    "name": "ripple",
    "title": "rings on water, spreading from a centre",
    "about": "Pushes every point along its ray from the centre, outwards and inwards in turn.",
    "source": "the plug-in pathwarp-ripple",
    "parameters": [
        {"name": "center", "kind": "point", "default": "50%,50%", "help": "Where the rings start."},
        {"name": "wavelength", "kind": "length", "default": "20%", "range": [0.001, 1e9], "slider": [1, 1000],
         "help": "Distance from ring to ring."},
        {"name": "height", "kind": "length", "default": "1%", "slider": [-100, 100],
         "help": "How far a point is pushed at most."},
    ],
    "examples": [
        {"what": "As it comes", "command": "ripple samples/grid.svg -o out.svg"},
        {"what": "From a corner", "command": "ripple samples/logo.svg --center 0%,0% --height 2% -o out.svg"},
    ],
    "laws": [{"identity": {"height": 0}}],
    "cases": [
        {"args": {"center": "50,50", "wavelength": "40", "height": "3"}, "at": [60, 50], "to": [63, 50], "tolerance": 1e-12},
    ],
}
REPEATED = {p["name"] for p in ENTRY["parameters"] if p.get("repeat")}


class Map:
    """The map for one set of values. Lengths are in user units, angles in degrees, y points down."""

    def __init__(self, frame, values):
        self.x, self.y = (float(v) for v in values["center"].split())
        self.height = float(values["height"])
        self.waves = math.tau / float(values["wavelength"])

    def point(self, x, y):
        dx, dy = x - self.x, y - self.y
        r = math.hypot(dx, dy)
        # sin(k·r)/r tends to k at the centre.
        push = self.height * (math.sin(self.waves * r) / r if r > 1e-12 else self.waves)
        return x + dx * push, y + dy * push


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

"""Compares what `unite` and `contour` make of random rectangles and circles with Shapely.

    v/bin/python areas.py 200 --program ../../target/release/pathwarp

The area between the results, by the length of the outline, is the mean distance between the two. GEOS sometimes leaves out a part of a
buffer: where a contour differs, the distances of its points from the shapes decide.
"""

import argparse
import math
import random
import re
import subprocess

from shapely.affinity import affine_transform, rotate, translate
from shapely.geometry import Point, Polygon, box
from shapely.ops import unary_union

TOLERANCE = 0.01
NUMBER = r"-?[\d.]+(?:e-?\d+)?"
# Segments of a quarter of a circle.
ROUND = 128


def rings(data, pieces=200):
    """The rings of path data with M, L, C, Q, A and Z in absolute coordinates."""
    out, ring, here = [], [], None
    for word, text in re.findall(r"([MLCQAZ])([^MLCQAZ]*)", data):
        numbers = [float(n) for n in re.findall(NUMBER, text)]
        if word == "Z":
            out.append(ring)
            ring = []
        elif word in "ML":
            ring += zip(numbers[::2], numbers[1::2])
        elif word in "CQ":
            control = [here, *zip(numbers[::2], numbers[1::2])]
            k = len(control) - 1
            for i in range(1, pieces + 1):
                t = i / pieces
                weights = [math.comb(k, j) * t**j * (1 - t) ** (k - j) for j in range(k + 1)]
                ring.append(tuple(sum(w * p[axis] for w, p in zip(weights, control)) for axis in (0, 1)))
        elif word == "A":
            r, _, _, large, sweep, x, y = numbers
            dx, dy = x - here[0], y - here[1]
            length = math.hypot(dx, dy)
            height = math.sqrt(max(r * r - length * length / 4, 0)) * (1 if large != sweep else -1)
            cx, cy = (here[0] + x) / 2 - height * dy / length, (here[1] + y) / 2 + height * dx / length
            a, b = math.atan2(here[1] - cy, here[0] - cx), math.atan2(y - cy, x - cx)
            turn = (b - a) % (2 * math.pi) if sweep else -((a - b) % (2 * math.pi))
            angles = (a + turn * i / pieces for i in range(1, pieces + 1))
            ring += [(cx + r * math.cos(t), cy + r * math.sin(t)) for t in angles]
        here = ring[-1] if ring else here
    return out


def area(data):
    """The area of rings that do not cross."""
    out = Polygon()
    for ring in rings(data):
        out = out.symmetric_difference(Polygon(ring).buffer(0))
    return out


def drawing(rng):
    shapes, body = [], ""
    for _ in range(rng.randint(2, 12)):
        x, y, turn = rng.uniform(10, 90), rng.uniform(10, 90), rng.uniform(0, 90)
        if rng.random() < 0.5:
            w, h = rng.uniform(5, 40), rng.uniform(5, 30)
            place = f"transform='translate({x} {y}) rotate({turn})'"
            body += f"<rect x='{-w / 2}' y='{-h / 2}' width='{w}' height='{h}' {place}/>"
            shapes.append(translate(rotate(box(-w / 2, -h / 2, w / 2, h / 2), turn, origin=(0, 0)), x, y))
        else:
            r = rng.uniform(3, 20)
            body += f"<circle cx='{x}' cy='{y}' r='{r}'/>"
            shapes.append(Point(x, y).buffer(r, ROUND))
    return f"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>{body}</svg>", unary_union(shapes)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("count", type=int)
    parser.add_argument("--program", default="pathwarp")
    args = parser.parse_args()
    rng, means, off, left_out = random.Random(64), [0.0, 0.0], 0.0, 0

    def run(*words):
        command = [args.program, *words, "-q", "--tolerance", str(TOLERANCE)]
        return subprocess.run(command, input=svg.encode(), capture_output=True, check=True).stdout.decode()

    for _ in range(args.count):
        svg, whole = drawing(rng)
        one = run("unite", "-", "--structure", "flatten")
        found = Polygon()
        for _, place, data in re.findall(r'(<g transform="([^"]*)">)?<path[^>]* d="([^"]*)"', one):
            part = area(data)
            if place:
                a, b, c, d, e, f = (float(n) for n in re.findall(NUMBER, place))
                part = affine_transform(part, [a, c, b, d, e, f])
            found = found.union(part)
        means[0] = max(means[0], found.symmetric_difference(whole).area / whole.length)
        by = rng.uniform(0.5, 8)
        line = run("contour", "-", "--by", str(by), "--only", "--holes", "keep")
        data = re.search(r'id="Contour-line" d="([^"]*)"', line).group(1)
        off = max(off, *(abs(whole.distance(Point(p)) - by) for ring in rings(data, 20) for p in ring))
        wanted = whole.buffer(by, ROUND)
        mean = area(data).symmetric_difference(wanted).area / wanted.length
        if mean > TOLERANCE:
            left_out += 1
        else:
            means[1] = max(means[1], mean)
    print(f"unite: up to {means[0]:.1e} in the mean; contour: up to {means[1]:.1e}, points up to {off:.1e} off;", end=" ")
    print(f"{left_out} buffers are not whole")


if __name__ == "__main__":
    main()

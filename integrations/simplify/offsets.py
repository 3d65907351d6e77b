#!/usr/bin/env python3
"""Compares `pathwarp offset` of random shapes with distances by Shapely.

    v/bin/python offsets.py 3000 --program ../../target/release/pathwarp

Points near the edges of the result and of Shapely's buffer, and points anywhere, have to lie inside where their distance from the source says
so. Shapely's buffer moves its edges by up to 2 % of the distance, so it only says where to look; bevels are compared with it that closely.
"""

import argparse
import cmath
import math
import random
import re
import subprocess

import numpy as np
from shapely import contains, distance, points
from shapely.geometry import Polygon
from shapely.ops import unary_union

STEPS = 300
TOGETHER = 40


def shape():
    """Path data of a random shape: whole numbers of arcs, curves, lines or noise around a middle."""
    kind = random.choice("polygon star round noise arcs curve hole circle".split())
    if kind == "circle":
        r = random.uniform(3, 40)
        return f"M{r:.4f},0A{r:.4f},{r:.4f} 0 0 1 {-r:.4f},0A{r:.4f},{r:.4f} 0 0 1 {r:.4f},0Z"
    if kind == "round":
        w, h = random.uniform(10, 80), random.uniform(10, 80)
        r = random.uniform(1, min(w, h) / 2)
        corner = f"A{r:.4f},{r:.4f} 0 0 1 "
        return (f"M{r:.4f},0L{w - r:.4f},0{corner}{w:.4f},{r:.4f}L{w:.4f},{h - r:.4f}{corner}{w - r:.4f},{h:.4f}"
                f"L{r:.4f},{h:.4f}{corner}0,{h - r:.4f}L0,{r:.4f}{corner}{r:.4f},0Z")
    if kind == "hole":
        return f"M0,0L{random.randint(45, 90)},0L60,50L0,50Z M15,10L15,35L40,35L40,10Z"
    count = random.randint(40, 150) if kind == "noise" else random.randint(3, 9)
    spread = {"noise": 0.6, "polygon": 5}
    radius = lambda: 30 + random.gauss(0, spread[kind]) if kind in spread else random.uniform(10, 40)
    start = random.uniform(0, 2 * math.pi)
    nodes = [cmath.rect(radius(), start + 2 * math.pi * i / count) for i in range(count)]
    out = f"M{nodes[0].real:.4f},{nodes[0].imag:.4f}"
    for p, q in zip(nodes, nodes[1:] + nodes[:1]):
        end = f"{q.real:.4f},{q.imag:.4f}"
        if kind == "arcs" and random.random() < 0.5:
            r = abs(q - p) * random.uniform(0.55, 2)
            out += f"A{r:.4f},{r:.4f} 0 0 {random.randint(0, 1)} {end}"
        elif kind == "curve":
            a, b = (p + (q - p) * s + complex(random.gauss(0, 6), random.gauss(0, 6)) for s in (0.33, 0.67))
            out += f"C{a.real:.4f},{a.imag:.4f} {b.real:.4f},{b.imag:.4f} {end}"
        else:
            out += "L" + end
    return out + "Z"


def arc(p, q, r, sweep):
    """Points of the smaller circular arc from p to q."""
    half = (q - p) / 2
    r = max(r, abs(half))
    height = math.sqrt(r * r - abs(half) ** 2)
    middle = (p + q) / 2 + half / abs(half) * 1j * (height if sweep else -height)
    first, turn = cmath.phase(p - middle), cmath.phase((q - middle) / (p - middle))
    return [middle + cmath.rect(r, first + turn * i / STEPS) for i in range(1, STEPS + 1)]


def rings(data):
    """The subpaths of absolute path data, as points."""
    out, words, command, at = [], re.findall(r"[A-Za-z]|-?\d*\.?\d+(?:e-?\d+)?", data), "", 0j
    number = lambda: float(words.pop(0))
    pair = lambda: complex(number(), number())
    ts = [i / STEPS for i in range(1, STEPS + 1)]
    while words:
        if words[0].isalpha():
            command = words.pop(0)
        if command == "Z":
            at = out[-1][0]
            continue
        if command == "M":
            at = pair()
            out.append([at])
            command = "L"
            continue
        if command == "L":
            new = [pair()]
        elif command == "H":
            new = [complex(number(), at.imag)]
        elif command == "V":
            new = [complex(at.real, number())]
        elif command == "Q":
            a, q = pair(), pair()
            new = [at * (1 - t) ** 2 + 2 * a * t * (1 - t) + q * t * t for t in ts]
        elif command == "C":
            a, b, q = pair(), pair(), pair()
            new = [at * (1 - t) ** 3 + 3 * a * t * (1 - t) ** 2 + 3 * b * t * t * (1 - t) + q * t**3 for t in ts]
        else:
            r, _, _, _, sweep = (number() for _ in range(5))
            new = arc(at, pair(), r, sweep)
        out[-1] += new
        at = new[-1]
    return [[(z.real, z.imag) for z in ring] for ring in out if len(ring) > 2]


def area(data):
    """The area within path data whose holes run the other way round; None if an outline crosses itself."""
    all_rings = rings(data)
    if not all_rings:
        return Polygon()
    if any(not Polygon(r).is_valid for r in all_rings):
        return None
    turn = lambda r: sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(r, r[1:] + r[:1]))
    outer = max(map(turn, all_rings), key=abs)
    of = lambda wanted: unary_union([Polygon(r) for r in all_rings if (turn(r) * outer > 0) == wanted])
    return of(True).difference(of(False))


def wrong(source, result, by, side, join, tolerance):
    """The number of points that lie on the wrong side of the result's edges."""
    slack = 1.1 * tolerance + 2e-4
    buffer = source.buffer(by if side == "outside" else -by, quad_segs=60, join_style=join, mitre_limit=4)
    places = []
    for edge in (g.boundary for g in (buffer, result) if not g.is_empty):
        for _ in range(150):
            p = edge.interpolate(random.random() * edge.length)
            off = cmath.rect(random.choice([1.2, 2, 6]) * slack, random.uniform(0, 2 * math.pi))
            places.append((p.x + off.real, p.y + off.imag))
    x0, y0, x1, y1 = source.bounds
    places += [(random.uniform(x0 - by, x1 + by), random.uniform(y0 - by, y1 + by)) for _ in range(100)]
    all_points = points(np.array(places))
    far, inside = distance(all_points, source.boundary), contains(source, all_points)
    has = contains(result, all_points) if not result.is_empty else np.zeros(len(places), bool)
    if side == "inside":
        must, must_not = inside & (far > by + slack), ~inside | (far < by - slack)
    else:
        near = far < by - slack
        if join != "round":
            bevels = source.buffer(by, join_style="bevel")
            near &= contains(bevels, all_points) & (distance(all_points, bevels.boundary) > 0.02 * by + slack)
        reach = 4.5 * by if join == "mitre" else by
        must, must_not = inside | near, ~inside & (far > reach + slack)
    return int(((must & ~has) | (must_not & has)).sum())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("count", type=int)
    parser.add_argument("--program", default="pathwarp")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    random.seed(options.seed)
    off = crossing = told = 0
    for _ in range(-(-options.count // TOGETHER)):
        cases = []
        while len(cases) < TOGETHER:
            data = shape()
            source = area(data)
            if source is not None and not source.is_empty:
                cases.append((data, source))
        by = random.choice([0.5, 1, 2, 3, 5, 8, 12, 20]) * random.uniform(0.8, 1.2)
        side = random.choice(["outside", "inside"])
        join = random.choice(["round", "mitre", "bevel"]) if side == "outside" else "round"
        tolerance = random.choice([0.02, 0.05, 0.1, 0.3])
        each = (f'<g transform="translate({400 * i},0)"><path id="p{i}" d="{d}"/></g>' for i, (d, _) in enumerate(cases))
        svg = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="-200 -200 20000 400">{"".join(each)}</svg>'
        words = ["--by", f"{by:.6f}", "--side", side, "--join", join.replace("mitre", "miter"), "--tolerance", str(tolerance)]
        run = subprocess.run([options.program, "offset", "-", *words], input=svg, capture_output=True, text=True)
        assert run.returncode in (0, 1), run.stderr
        named = set(re.findall(r"\bp\d+", run.stderr))
        for i, (data, source) in enumerate(cases):
            found = re.search(rf'id="p{i}"[^>]* d="([^"]*)"', run.stdout)
            result = area(found[1]) if found else Polygon()
            points_off = 0 if result is None else wrong(source, result, by, side, join, tolerance)
            if result is not None and not points_off:
                continue
            if f"p{i}" in named:
                told += 1
                continue
            off, crossing = off + (points_off > 0), crossing + (result is None)
            print("crosses itself" if result is None else f"{points_off} points off", *words, data)
    print(f"{options.count} shapes: {off} off, {crossing} cross themselves, {told} said so")


if __name__ == "__main__":
    main()

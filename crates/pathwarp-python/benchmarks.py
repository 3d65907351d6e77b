"""Measures points per second of CPU time, on one core and on all: python benchmarks.py"""

import time

import numpy as np

import pathwarp
from pathwarp import Deformation

CAGE = "M10,90 Q40,110 95,85 L90,15 5,10 Z"
COUNT = 4_000_000

CASES = {
    "shaper": Deformation("shaper", shaper=CAGE, frame=(0, 0, 100, 100)),
    "shaper, box of the points": Deformation("shaper", shaper=CAGE),
    "arc": Deformation("arc", bend=0.4, frame=(0, 0, 100, 100)),
    "swirl": Deformation("swirl", frame=(0, 0, 100, 100)),
    "projective": Deformation("projective", target="0%,100% 100%,100% 75%,0% 25%,0%", frame=(0, 0, 100, 100)),
}

points = np.random.default_rng(1).uniform(0, 100, (COUNT, 2))
out = np.empty_like(points)
for name, deformation in CASES.items():
    for threads in (1, 0):
        pathwarp.use_threads(threads)
        best_cpu = best_wall = float("inf")
        for _ in range(5):
            cpu, wall = time.process_time(), time.perf_counter()
            deformation.map(points, out=out)
            best_cpu = min(best_cpu, time.process_time() - cpu)
            best_wall = min(best_wall, time.perf_counter() - wall)
        cores = "one thread" if threads else "all cores"
        print(f"{name}, {cores}: {COUNT / best_cpu / 1e6:.0f} million points per CPU second, {COUNT / best_wall / 1e6:.0f} per second")

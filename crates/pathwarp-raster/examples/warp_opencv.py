"""Compares warped bitmaps with OpenCV: python3 warp_opencv.py FOLDER, after `warp_speed FOLDER`.

Errors are root mean squares over every 16th band of rows, against the average of 64 samples in each pixel's square at the exact
places: of the scene (the source's formula), and of the source's pixels as squares. OpenCV gets the exact places of each pixel, outside of the timed part. Times are CPU times of one thread.
"""

import sys
import time
from pathlib import Path

import cv2
import numpy as np

SIDE, RUNS, OVER, BAND = 4000, 5, 8, 16
cv2.setNumThreads(1)
folder = Path(sys.argv[1])
source = np.fromfile(folder / "source.rgba", np.uint8).reshape(SIDE, SIDE, 4)


def rings(places, channel):
    """The scene that the source samples, at any place: the function of the same name in warp_speed.rs."""
    r2 = (places.astype(np.float64) ** 2).sum(axis=2) / (4 * SIDE * 2**0.5)
    return 127.5 + 120 * np.cos(2 * np.pi * r2 + channel)


def finer(places, n):
    """Places of n x n samples per pixel, interpolated from those of the pixels."""
    return cv2.resize(places, None, fx=n, fy=n, interpolation=cv2.INTER_CUBIC)


def remap(image, places, how):
    return cv2.remap(image, places, None, how, borderMode=cv2.BORDER_CONSTANT)


def over(n, how):
    """n x n samples per pixel, averaged; band by band, so that the samples stay in the cache."""

    def run(places, prepared):
        return np.vstack([cv2.resize(remap(source, p, how), None, fx=1 / n, fy=1 / n, interpolation=cv2.INTER_AREA) for p in prepared])

    def prepare(places):
        # One row more on each side for the interpolation of places.
        padded = np.pad(places, ((1, 1), (0, 0), (0, 0)), mode="edge")
        return [finer(padded[k : k + 102], n)[n:-n].copy() for k in range(0, SIDE, 100)]

    return prepare, run


def pyramid():
    """Two levels of the pyramid, blended by the size of each pixel's footprint."""

    def prepare(places):
        dx = np.hypot(*np.moveaxis(np.gradient(places, axis=1), 2, 0))
        dy = np.hypot(*np.moveaxis(np.gradient(places, axis=0), 2, 0))
        weight = np.clip(np.log2(np.maximum(np.maximum(dx, dy), 1e-9)), 0, 1)
        return (places - 0.5) / 2 , (255 * weight).astype(np.uint8)[..., None].repeat(4, 2)

    def run(places, prepared):
        half, weight = prepared
        fine = remap(source, places, cv2.INTER_LINEAR)
        coarse = remap(cv2.resize(source, None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA), half, cv2.INTER_LINEAR)
        return cv2.add(cv2.multiply(fine, 255 - weight, scale=1 / 255), cv2.multiply(coarse, weight, scale=1 / 255))

    return prepare, run


METHODS = {
    "remap, cubic": (lambda places: None, lambda places, _: remap(source, places, cv2.INTER_CUBIC)),
    "remap, linear": (lambda places: None, lambda places, _: remap(source, places, cv2.INTER_LINEAR)),
    "pyramid": pyramid(),
    "2 x 2, linear": over(2, cv2.INTER_LINEAR),
    "2 x 2, cubic": over(2, cv2.INTER_CUBIC),
    "3 x 3, linear": over(3, cv2.INTER_LINEAR),
    "3 x 3, cubic": over(3, cv2.INTER_CUBIC),
}

print("OpenCV", cv2.__version__)
for name in ["grows", "shrinks a little", "strong"]:
    places = np.fromfile(folder / f"{name}.f32", np.float32).reshape(SIDE, SIDE, 2)
    places[~np.isfinite(places)] = -1e6
    ours = np.fromfile(folder / f"{name}.rgba", np.uint8).reshape(SIDE, SIDE, 4)
    rows = np.concatenate([np.arange(k, k + BAND) for k in range(BAND, SIDE - BAND, 16 * BAND)])
    scene, squares = [], []
    for k in range(BAND, SIDE - BAND, 16 * BAND):
        # One row more on each side for the interpolation of places.
        fine = finer(places[k - 1 : k + BAND + 1], OVER)[OVER:-OVER]
        mean = lambda samples: samples.reshape(BAND, OVER, SIDE, OVER, -1).mean(axis=(1, 3))
        scene.append(np.concatenate([mean(rings(fine, c)) for c in range(3)], 2))
        squares.append(mean(remap(source, fine, cv2.INTER_NEAREST)[..., :3]))
    scene, squares = np.concatenate(scene), np.concatenate(squares)
    inside = ((places[rows] > 2) & (places[rows] < SIDE - 3)).all(axis=2)

    def error(found):
        off = [np.sqrt(((found[rows][..., :3].astype(np.float32) - truth)[inside] ** 2).mean()) for truth in (scene, squares)]
        return "errors {:.2f}, {:.2f}".format(*off)

    print(f"{name}: ours has {error(ours)}")
    for method, (prepare, run) in METHODS.items():
        prepared, times = prepare(places), []
        for _ in range(RUNS):
            start = time.process_time()
            found = run(places, prepared)
            times.append(time.process_time() - start)
        print(f"  {method}: {sorted(times)[RUNS // 2]:.3f} s, {error(found)}")
        del prepared

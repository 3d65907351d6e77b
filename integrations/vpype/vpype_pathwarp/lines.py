"""Lines: every vertex is mapped, and straight pieces are divided until they follow their images."""

from __future__ import annotations

import numpy as np
import pathwarp as pw
import vpype as vp

DEVIATION = 0.1
"""Largest distance between a piece and its image, as a share of the quantization: a tenth of what a plotter is asked to resolve."""

ROUNDS = 24
"""Most halvings of a piece: beyond them, the map tears it apart."""


def bend(document: vp.Document, deformation: pw.Deformation, quantization: float) -> vp.Document:
    """The document with all lines bent. Units are px."""
    bounds = document.bounds()
    if bounds is None:
        return document
    if deformation._warper.frame is None:
        x0, y0, x1, y1 = bounds
        deformation = deformation.with_options(frame=(x0, y0, max(x1 - x0, 1e-9), max(y1 - y0, 1e-9)))
    result = document.clone()
    for layer, lines in document.layers.items():
        bent = [bend_line(line, deformation, DEVIATION * quantization) for line in lines]
        result.add(vp.LineCollection(bent, metadata=lines.metadata), layer, with_metadata=True)
    return result


def bend_line(line: np.ndarray, deformation: pw.Deformation, deviation: float) -> np.ndarray:
    """The image of a polyline, a complex array, with as many vertices as keep it within `deviation`."""
    source = np.asarray(line, dtype=complex)
    image = _map(deformation, source)
    for _ in range(ROUNDS):
        # A quarter and three quarters, too: halfway, an S-shaped piece may meet its chord.
        worst = np.zeros(max(len(source) - 1, 0))
        for share in (0.25, 0.5, 0.75):
            between = _map(deformation, source[:-1] + share * np.diff(source))
            worst = np.maximum(worst, abs(between - (image[:-1] + share * np.diff(image))))
        coarse = np.flatnonzero(worst > deviation)
        if not len(coarse):
            break
        halves = (source[coarse] + source[coarse + 1]) / 2
        source = np.insert(source, coarse + 1, halves)
        image = np.insert(image, coarse + 1, _map(deformation, halves))
    if not np.isfinite(image).all():
        at = source[~np.isfinite(image)][0]
        raise pw.GeometryError(f"the map is undefined at {at.real:g},{at.imag:g} (px); crop the drawing there first")
    return image


def _map(deformation: pw.Deformation, points: np.ndarray) -> np.ndarray:
    # A complex array is an array of pairs.
    pairs = np.ascontiguousarray(points).view(np.float64).reshape(-1, 2)
    return deformation.map(pairs).view(complex).reshape(-1)

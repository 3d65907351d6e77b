"""Curves: the SVG file that was read is bent, and then flattened as `read` does it."""

from __future__ import annotations

import io
import pathlib

import numpy as np
import pathwarp as pw
import vpype as vp

TOLERANCE = 0.1
"""Share of the quantization that the bent curves may be off, before they are flattened."""


def from_source(
    document: vp.Document, deformation: pw.Deformation, quantization: float
) -> tuple[vp.Document | None, str]:
    """The document read again from its bent source; None and a reason if the document is no longer as it was read."""
    sources = list(document.sources)
    if len(sources) != 1:
        return None, f"the drawing has {len(sources)} source files" if sources else "the drawing was not read from a file"
    source = pathlib.Path(sources[0])
    if not source.is_file() or source.suffix.lower() not in (".svg", ".svgz"):
        return None, f"{source} is no SVG file any more"
    try:
        plain = vp.read_multilayer_svg(str(source), quantization=quantization, crop=False)
    except Exception as e:  # vpype and svgelements raise anything
        return None, f"{source} cannot be read again: {e}"
    if not _same(document, plain):
        return None, f"the drawing is not as `read --quantization {quantization:g}px` leaves {source.name}"
    tolerance = TOLERANCE * quantization * _units_per_px(source, plain)
    warped = pw_svg(source, deformation, tolerance)
    bent = vp.read_multilayer_svg(io.StringIO(warped.decode()), quantization=quantization, crop=False)
    if set(bent.layers) != set(document.layers):
        return None, "the bent file has other layers"
    result = document.clone()
    for layer, lines in bent.layers.items():
        # Colours, names and whatever else was set for a layer stay as they are in the document.
        kept = vp.LineCollection(lines, metadata=document.layers[layer].metadata)
        result.add(kept, layer, with_metadata=True)
    return result, ""


def pw_svg(source: pathlib.Path, deformation: pw.Deformation, tolerance: float) -> bytes:
    """The bent file. Only lines matter to a plotter, so nothing else is worked on."""
    return deformation.warp_svg(
        source.read_bytes(),
        name=source,
        tolerance=tolerance,
        strokes="keep",
        text="skip",
        images="keep",
        gradients="keep",
        patterns="keep",
        structure="keep",
    )


def _same(a: vp.Document, b: vp.Document) -> bool:
    """Both have the same lines in the same layers, up to rounding."""
    if set(a.layers) != set(b.layers):
        return False
    pairs = ((a.layers[i], b.layers[i]) for i in a.layers)
    equal = lambda x, y: len(x) == len(y) and np.allclose(x, y, rtol=1e-12, atol=1e-9)  # noqa: E731
    return all(len(x) == len(y) and all(map(equal, x, y)) for x, y in pairs)


def _units_per_px(source: pathlib.Path, plain: vp.Document) -> float:
    """User units per px, which the tolerance is measured in; 1 if the file has no view box."""
    import svgelements

    svg = svgelements.SVG.parse(str(source), reify=False)
    box = svg.viewbox
    if box is None or not box.width or plain.page_size is None or not plain.page_size[0]:
        return 1.0
    return min(float(box.width) / plain.page_size[0], float(box.height) / plain.page_size[1])

"""The reports: dictionaries with the keys of the command line's `--report`."""

from __future__ import annotations

from typing import List, Literal, NamedTuple, Optional, Tuple, TypedDict

Assurance = Literal["exact", "certified", "checked", "sampled"]


class Check(NamedTuple):
    """One check of a map."""

    name: str
    detail: str
    """What was checked."""
    faults: List[str]
    """What is wrong; empty if nothing is."""

    def __str__(self) -> str:
        return "\n    ".join([f"{'FAIL' if self.faults else 'ok  '} {self.name}: {self.detail}", *self.faults])


class PathReport(TypedDict):
    """How a path was made."""

    segments_in: int
    segments_out: int
    max_error: float
    """The largest distance from the exact result."""
    assurance: Assurance
    unresolved: List[Tuple[float, float]]
    """Places where the tolerance was not met."""
    resolution: Optional[float]
    """The resolution of the coordinates, if the tolerance is below it."""
    folds: int
    """Number of orientation changes along the path, if it folds."""
    warnings: List[str]


class _Shape(TypedDict):
    id: str
    segments_in: int
    segments_out: int
    max_error: float
    share: float
    certified: bool
    assurance: Assurance
    folds: int


class ShapeReport(_Shape, total=False):
    """One shape. Keys that have nothing to say are left out."""

    steps: List[int]
    copies: int
    folded_at: List[float]
    unresolved: List[List[float]]
    resolution: float
    paint_residual: Optional[float]
    pictures: int
    stroke_error: Optional[float]
    outlined_strokes: int


class Skipped(TypedDict):
    """A shape that was left unchanged."""

    id: str
    why: str


class _Selection(TypedDict):
    deformation: str
    select: List[str]
    frame: List[float]


class Selection(_Selection, total=False):
    """A step with its part of the artwork."""

    exclude: List[str]


class _Report(TypedDict):
    file: str
    output: Optional[str]
    tolerance: Optional[float]
    frame: Optional[List[float]]
    shapes: List[ShapeReport]
    skipped: List[Skipped]
    warnings: List[str]


class Report(_Report, total=False):
    """What was done with a drawing, shape by shape."""

    selections: List[Selection]
    baseline: float
    page: List[float]

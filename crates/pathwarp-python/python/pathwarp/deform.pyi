"""Made by stubs.py from the registry."""

import os
from typing import Any, List, Literal, Optional, Sequence, Tuple, Union

from ._deformation import Deformation, Frame

Number = Union[float, str]
Point = Union[str, Tuple[Number, Number], complex]
File = Union[str, "os.PathLike[str]"]
Shape = Literal["ribbon", "leaf", "hexagon", "diamond", "pill", "drop", "triangle", "pentagon", "house", "bottle", "cloud", "arrow", "heart", "shield", "star", "circle", "egg", "banner", "semicircle", "crescent", "badge", "bubble", "pick", "flag"]
# Path data, FILE#NAME, points, the name of a shape, or a path of svgpathtools.
PathLike = Union[Shape, Any]

def shaper(
    *,
    shaper: Optional[PathLike] = None,
    net: Optional[Union[PathLike, Sequence[PathLike]]] = None,
    base: Optional[PathLike] = None,
    target: Optional[PathLike] = None,
    bottom: Optional[str] = None,
    reverse_shaper: Optional[bool] = None,
    base_as_drawn: Optional[bool] = None,
    target_as_drawn: Optional[bool] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def envelope(
    *,
    envelope: Optional[PathLike] = None,
    bottom: Optional[PathLike] = None,
    top: Optional[PathLike] = None,
    left: Optional[PathLike] = None,
    right: Optional[PathLike] = None,
    height: Optional[Number] = None,
    sides: Optional[Literal["straight", "square"]] = None,
    by: Optional[Literal["length", "parameter", "extent"]] = None,
    corners: Optional[str] = None,
    bottom_side: Optional[Union[int, str]] = None,
    reverse: Optional[bool] = None,
    keep: Optional[Literal["auto", "nothing", "verticals", "horizontals", "lines"]] = None,
    lines: Optional[Literal["fit", "together"]] = None,
    ends: Optional[Number] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def warp(
    *,
    style: Optional[File] = None,
    bend: Optional[Number] = None,
    axis: Optional[Literal["horizontal", "vertical"]] = None,
    horizontal: Optional[Number] = None,
    vertical: Optional[Number] = None,
    keep: Optional[Literal["nothing", "verticals", "horizontals", "lines"]] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def arc(
    *,
    bend: Optional[Number] = None,
    axis: Optional[Literal["horizontal", "vertical"]] = None,
    horizontal: Optional[Number] = None,
    vertical: Optional[Number] = None,
    keep: Optional[Literal["nothing", "verticals", "horizontals", "lines"]] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def arc_lower(
    *,
    bend: Optional[Number] = None,
    axis: Optional[Literal["horizontal", "vertical"]] = None,
    horizontal: Optional[Number] = None,
    vertical: Optional[Number] = None,
    keep: Optional[Literal["nothing", "verticals", "horizontals", "lines"]] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def arc_upper(
    *,
    bend: Optional[Number] = None,
    axis: Optional[Literal["horizontal", "vertical"]] = None,
    horizontal: Optional[Number] = None,
    vertical: Optional[Number] = None,
    keep: Optional[Literal["nothing", "verticals", "horizontals", "lines"]] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def arch(
    *,
    bend: Optional[Number] = None,
    axis: Optional[Literal["horizontal", "vertical"]] = None,
    horizontal: Optional[Number] = None,
    vertical: Optional[Number] = None,
    keep: Optional[Literal["nothing", "verticals", "horizontals", "lines"]] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def shell_lower(
    *,
    bend: Optional[Number] = None,
    axis: Optional[Literal["horizontal", "vertical"]] = None,
    horizontal: Optional[Number] = None,
    vertical: Optional[Number] = None,
    keep: Optional[Literal["nothing", "verticals", "horizontals", "lines"]] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def shell_upper(
    *,
    bend: Optional[Number] = None,
    axis: Optional[Literal["horizontal", "vertical"]] = None,
    horizontal: Optional[Number] = None,
    vertical: Optional[Number] = None,
    keep: Optional[Literal["nothing", "verticals", "horizontals", "lines"]] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def flag(
    *,
    bend: Optional[Number] = None,
    axis: Optional[Literal["horizontal", "vertical"]] = None,
    horizontal: Optional[Number] = None,
    vertical: Optional[Number] = None,
    keep: Optional[Literal["nothing", "verticals", "horizontals", "lines"]] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def fish(
    *,
    bend: Optional[Number] = None,
    axis: Optional[Literal["horizontal", "vertical"]] = None,
    horizontal: Optional[Number] = None,
    vertical: Optional[Number] = None,
    keep: Optional[Literal["nothing", "verticals", "horizontals", "lines"]] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def rise(
    *,
    bend: Optional[Number] = None,
    axis: Optional[Literal["horizontal", "vertical"]] = None,
    horizontal: Optional[Number] = None,
    vertical: Optional[Number] = None,
    keep: Optional[Literal["nothing", "verticals", "horizontals", "lines"]] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def fisheye(
    *,
    bend: Optional[Number] = None,
    axis: Optional[Literal["horizontal", "vertical"]] = None,
    horizontal: Optional[Number] = None,
    vertical: Optional[Number] = None,
    keep: Optional[Literal["nothing", "verticals", "horizontals", "lines"]] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def inflate(
    *,
    bend: Optional[Number] = None,
    axis: Optional[Literal["horizontal", "vertical"]] = None,
    horizontal: Optional[Number] = None,
    vertical: Optional[Number] = None,
    keep: Optional[Literal["nothing", "verticals", "horizontals", "lines"]] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def squeeze(
    *,
    bend: Optional[Number] = None,
    axis: Optional[Literal["horizontal", "vertical"]] = None,
    horizontal: Optional[Number] = None,
    vertical: Optional[Number] = None,
    keep: Optional[Literal["nothing", "verticals", "horizontals", "lines"]] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def twist(
    *,
    bend: Optional[Number] = None,
    axis: Optional[Literal["horizontal", "vertical"]] = None,
    horizontal: Optional[Number] = None,
    vertical: Optional[Number] = None,
    keep: Optional[Literal["nothing", "verticals", "horizontals", "lines"]] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def wordart(
    *,
    preset: File,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def plain(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def stop(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def triangle_inverted(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def chevron(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def chevron_inverted(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def ring_inside(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def ring_outside(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def arch_up(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def arch_down(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def circle(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def button(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def arch_up_pour(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def arch_down_pour(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def circle_pour(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def button_pour(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def curve_up(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def curve_down(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def can_up(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def can_down(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def wave1(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def wave2(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def double_wave1(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def wave4(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def deflate(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def inflate_bottom(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def deflate_bottom(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def inflate_top(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def deflate_top(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def deflate_inflate(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def deflate_inflate_deflate(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def fade_right(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def fade_left(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def fade_up(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def fade_down(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def slant_up(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def slant_down(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def cascade_up(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def cascade_down(
    *,
    adj: Optional[Union[str, Sequence[str]]] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    box: Optional[str] = None,
    split: Optional[str] = None,
    padding: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def bilinear(
    *,
    base: Optional[PathLike] = None,
    target: Optional[PathLike] = None,
    base_as_drawn: Optional[bool] = None,
    target_as_drawn: Optional[bool] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def birational(
    *,
    top: Optional[PathLike] = None,
    bottom: Optional[PathLike] = None,
    left: Optional[PathLike] = None,
    right: Optional[PathLike] = None,
    spline: Optional[Union[int, str]] = None,
    meet: Optional[Point] = None,
    spacing: Optional[Number] = None,
    q0: Optional[Point] = None,
    q1: Optional[Point] = None,
    weight: Optional[Union[str, Sequence[str]]] = None,
    region: Optional[str] = None,
    allow_poles: Optional[bool] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def bend(
    *,
    along: Optional[PathLike] = None,
    stretch: Optional[Literal["keep", "scale", "fit", "repeat"]] = None,
    align: Optional[Literal["start", "middle", "end"]] = None,
    offset: Optional[Number] = None,
    copies: Optional[str] = None,
    gap: Optional[Number] = None,
    baseline: Optional[Number] = None,
    width: Optional[Number] = None,
    by: Optional[Literal["arclength", "parameter"]] = None,
    handles: Optional[File] = None,
    spline: Optional[Union[int, str]] = None,
    interpolate: Optional[bool] = None,
    preset: Optional[Literal["stretch", "swell", "taper"]] = None,
    factor: Optional[Number] = None,
    glyphs: Optional[Literal["bend", "rotate", "skew", "ribbon", "stair"]] = None,
    objects: Optional[bool] = None,
    skew: Optional[bool] = None,
    ribbon: Optional[bool] = None,
    spacing: Optional[Literal["baseline", "even"]] = None,
    as_drawn: Optional[bool] = None,
    reverse: Optional[bool] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def polar(
    *,
    sweep: Optional[Number] = None,
    inner: Optional[Number] = None,
    outer: Optional[Number] = None,
    turn: Optional[Number] = None,
    center: Optional[Point] = None,
    gap: Optional[Number] = None,
    spacing: Optional[Literal["even", "conformal"]] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def ffd(
    *,
    degree: Optional[str] = None,
    region: Optional[str] = None,
    move: Optional[Union[str, Sequence[str]]] = None,
    at: Optional[Union[str, Sequence[str]]] = None,
    weight: Optional[Union[str, Sequence[str]]] = None,
    pin: Optional[Union[str, Sequence[str]]] = None,
    freeze: Optional[str] = None,
    extend: Optional[bool] = None,
    spline: Optional[bool] = None,
    cells: Optional[str] = None,
    lattice: Optional[File] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def mesh(
    *,
    net: Optional[PathLike] = None,
    mesh: Optional[File] = None,
    psd: Optional[File] = None,
    layer: Optional[str] = None,
    region: Optional[str] = None,
    smooth: Optional[bool] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def triangle(
    *,
    reference: Optional[str] = None,
    degree: Optional[Union[int, str]] = None,
    move: Optional[Union[str, Sequence[str]]] = None,
    at: Optional[Union[str, Sequence[str]]] = None,
    weight: Optional[Union[str, Sequence[str]]] = None,
    birational: Optional[bool] = None,
    extend: Optional[bool] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def mls(
    *,
    pair: Optional[Union[str, Sequence[str]]] = None,
    pin: Optional[Union[str, Sequence[str]]] = None,
    from_: Optional[PathLike] = None,
    to: Optional[PathLike] = None,
    kind: Optional[Literal["rigid", "similar", "affine"]] = None,
    alpha: Optional[Number] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def projective(
    *,
    target: PathLike,
    base: Optional[PathLike] = None,
    base_as_drawn: Optional[bool] = None,
    target_as_drawn: Optional[bool] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def anamorph(
    *,
    eye: Optional[Point] = None,
    distance: Optional[Number] = None,
    eye_height: Optional[Number] = None,
    picture_width: Optional[Number] = None,
    length: Optional[Number] = None,
    onto: Optional[str] = None,
    mirror: Optional[str] = None,
    foot: Optional[Point] = None,
    sight_mark: Optional[bool] = None,
    seen: Optional[bool] = None,
    view: Optional[str] = None,
    reference: Optional[str] = None,
    degree: Optional[str] = None,
    push: Optional[Union[str, Sequence[str]]] = None,
    away: Optional[Union[str, Sequence[str]]] = None,
    at: Optional[Union[str, Sequence[str]]] = None,
    point: Optional[Union[str, Sequence[str]]] = None,
    local: Optional[bool] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def wave(
    *,
    height: Optional[Number] = None,
    length: Optional[Number] = None,
    angle: Optional[Number] = None,
    phase: Optional[Number] = None,
    grow: Optional[Number] = None,
    kind: Optional[Literal["shear", "push"]] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def swirl(
    *,
    angle: Optional[Number] = None,
    center: Optional[Point] = None,
    radius: Optional[Number] = None,
    falloff: Optional[Literal["soft", "sharp", "endless"]] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def bulge(
    *,
    amount: Optional[Number] = None,
    center: Optional[Point] = None,
    radius: Optional[Number] = None,
    edge: Optional[Literal["soft", "sharp"]] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def lens(
    *,
    from_: Optional[Literal["rectilinear", "stereographic", "equidistant", "equisolid", "orthographic"]] = None,
    to: Optional[Literal["rectilinear", "stereographic", "equidistant", "equisolid", "orthographic"]] = None,
    field: Optional[Number] = None,
    center: Optional[Point] = None,
    keep: Optional[Literal["corners", "middle"]] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def mobius(
    *,
    pole: Optional[Point] = None,
    from_: Optional[PathLike] = None,
    to: Optional[PathLike] = None,
    coefficients: Optional[Union[str, Sequence[float]]] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def expr(
    *,
    x: Optional[str] = None,
    y: Optional[str] = None,
    let: Optional[Union[str, Sequence[str]]] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def similitude(
    *,
    target: PathLike,
    base: Optional[PathLike] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...
def affine(
    *,
    matrix: Optional[Union[str, Sequence[float]]] = None,
    scale_x: Optional[Number] = None,
    scale_y: Optional[Number] = None,
    skew_x: Optional[Number] = None,
    skew_y: Optional[Number] = None,
    rotate: Optional[Number] = None,
    move_x: Optional[Number] = None,
    move_y: Optional[Number] = None,
    about: Optional[Point] = None,
    frame: Optional[Frame] = None,
) -> Deformation: ...

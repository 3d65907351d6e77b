"""The command line: `pathwarp DEFORMATION [OPTIONS]`, with the deformation's own parameters as options."""

from __future__ import annotations

import dataclasses
import logging
import runpy
import textwrap
from typing import Any

import click
import pathwarp as pw
import vpype as vp
import vpype_cli

from .curves import from_source
from .lines import bend

CURVES = ("auto", "source", "lines")

HELP = """Bend the drawing by a deformation of pathwarp.

    DEFORMATION is one of pathwarp's (shaper, bend, wave, swirl…) or one of its presets (arc, flag, arch…); its parameters follow as
    options, as on pathwarp's command line. `pathwarp list` shows them all, and `vpype pathwarp DEFORMATION --help` those of one.
    FILE.py:NAME is a function of your own: it takes arrays of x and y in px, and gives a pair of such arrays.

    If the drawing is as `read` left it, its SVG file is bent and then flattened, so that curves are as smooth as if they had been
    drawn bent. Otherwise the lines are bent as they are, straight ones as finely as --quantization asks.

    Examples:

        vpype read logo.svg pathwarp arc --bend 40% write out.svg

        vpype read logo.svg crop 0 0 10cm 10cm pathwarp shaper --shaper cage.svg write out.svg

        vpype read logo.svg pathwarp maps.py:breeze write out.svg
"""


@dataclasses.dataclass(frozen=True)
class Call:
    """A parsed call. vpype substitutes expressions between `%` in texts, so texts like 0%,100% are kept from it in here."""

    deformation: pw.Deformation
    curves: str


def common() -> list[click.Option]:
    """The options that every deformation has here."""
    return [
        click.Option(
            ["--curves"],
            type=click.Choice(CURVES),
            default="auto",
            help="Bend the SVG file that was read (source), the lines that vpype made of it (lines), or the file if the drawing is "
            "still as it was read (auto).",
        ),
        click.Option(
            ["-q", "--quantization"],
            type=vpype_cli.LengthType(),
            default="0.1mm",
            help="Longest straight piece of a curve. Give the value that `read` had, so that auto finds the drawing unchanged.",
        ),
        click.Option(
            ["--frame"],
            help="Box that percentages and defaults refer to: X,Y,W,H, artwork, or viewbox (with the source). "
            "[default: the artwork's bounding box]",
        ),
        click.Option(["--inverse"], is_flag=True, help="Undo the deformation (give --frame: the source's box)."),
    ]


def options_of(info: pw.Info, preset: bool) -> list[click.Option]:
    """The parameters of a deformation as options."""
    made = []
    for p in info.parameters:
        if preset and p.name == info.preset_parameter:
            continue
        flag = "--" + p.name.replace("_", "-")
        help = p.help + (f" [default: {p.default}]" if p.default else "")
        if p.kind == "flag":
            made.append(click.Option([flag, p.name], is_flag=True, help=help))
        else:
            kind = click.Choice(p.choices, case_sensitive=False) if p.kind == "choice" else click.STRING
            notation = None if p.kind == "choice" else p.notation
            made.append(click.Option([flag, p.name], type=kind, metavar=notation, multiple=p.repeat, help=help))
    return made


class PathwarpCommand(click.Command):
    """A command whose options depend on its first word."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        name = args[0] if args else ""
        if not name or name.startswith("-"):
            return super().parse_args(ctx, args or ["--help"])
        info = pw.find(name)
        if ".py:" in name:
            own, about = [], f"{name} — a function of x and y in px"
        elif info is None:
            raise click.UsageError(str(_error(lambda: pw.Deformation(name))), ctx)
        else:
            own = options_of(info, preset=name.lower() != info.name)
            about = f"{info.name} — {info.title}\n\n{textwrap.fill(info.about, 100)}"
        inner = click.Command(f"pathwarp {name}", params=[*own, *common()], help=about)
        settings = {"allow_extra_args": True, "allow_interspersed_args": False}
        with inner.make_context(f"pathwarp {name}", args[1:], parent=ctx.parent, **settings) as parsed:
            values = dict(parsed.params)
            rest = parsed.args
        # A length may hold an expression, which vpype evaluates when the command runs.
        ctx.params = {"quantization": values.pop("quantization"), "call": call(ctx, name, values)}
        ctx.args = rest
        return rest


def call(ctx: click.Context, name: str, values: dict[str, Any]) -> Call:
    curves, frame, inverse = values.pop("curves"), values.pop("frame"), values.pop("inverse")
    given = {k: list(v) if isinstance(v, tuple) else v for k, v in values.items() if v not in (None, (), False)}
    made_of: Any = name
    if ".py:" in name:
        if curves == "source":
            raise click.UsageError("a function of px bends lines; --curves source bends the file, in its user units", ctx)
        made_of, curves = function(name, ctx), "lines"
    try:
        deformation = pw.Deformation(made_of, frame=frame, **given)
        return Call(deformation.inverse() if inverse else deformation, curves)
    except pw.PathwarpError as e:
        raise click.UsageError(str(e), ctx) from None


def function(name: str, ctx: click.Context) -> Any:
    """The function that FILE.py:NAME names. The file runs as a program does."""
    file, _, word = name.rpartition(":")
    try:
        return runpy.run_path(file)[word]
    except KeyError:
        raise click.UsageError(f"{file} has no function `{word}`", ctx) from None
    except Exception as e:  # the file may do anything
        raise click.UsageError(f"{file}: {type(e).__name__}: {e}", ctx) from e


def _error(failing: Any) -> Exception:
    try:
        failing()
    except pw.PathwarpError as e:
        return e
    return pw.UsageError("")


VISIBLE = 1e-3
"""Smallest overhang that counts, as a fraction of the page: one pixel in a thousand."""


def overhang(document: vp.Document) -> float:
    """How far the drawing extends past its page, in px; 0 if that is not to be seen."""
    size, bounds = document.page_size, document.bounds()
    if not size or bounds is None:
        return 0.0
    x0, y0, x1, y1 = bounds
    most = max(-x0, -y0, x1 - size[0], y1 - size[1])
    return most if most > VISIBLE * max(size) else 0.0


@click.command("pathwarp", cls=PathwarpCommand, help=HELP)
@vpype_cli.global_processor
def pathwarp(document: vp.Document, call: Call, quantization: float) -> vp.Document:
    before = overhang(document)
    bent = warped(document, call, quantization)
    after = overhang(bent)
    if after > before:
        advice = "`layout tight` fits the page to it"
        logging.warning("pathwarp: the drawing extends past the page by %.1f px; %s", after, advice)
    return bent


def warped(document: vp.Document, call: Call, quantization: float) -> vp.Document:
    try:
        if call.curves != "lines":
            bent, reason = from_source(document, call.deformation, quantization)
            if bent is not None:
                return bent
            if call.curves == "source":
                raise click.ClickException(f"pathwarp: {reason}")
            # `read` with other options, or commands in between: nothing unusual, so no warning.
            logging.info("pathwarp: bending lines: %s", reason)
        return bend(document, call.deformation, quantization)
    except pw.PathwarpError as e:
        raise click.ClickException(f"pathwarp: {e}") from None


pathwarp.help_group = "Plugins"

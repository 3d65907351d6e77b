"""Paths and drawings, against the command line: byte for byte."""

import json
import pathlib
import pickle
import re

import pytest

import pathwarp
from pathwarp import Deformation
from conftest import SAMPLES

PATHS = [
    "M0,0 H100 V50 H0 Z",
    "M10,80 C40,10 65,10 95,80 S150,150 180,80",
    "M20,20 A30,20 30 1 1 60,60 Q80,0 100,40 T140,40 Z M30,30 h5 v5 z",
]

SHORT = [
    (["warp", "--style", "arc", "--bend", "40%"], {"bend": 0.4}, "arc"),
    (["swirl"], {}, "swirl"),
    (["affine", "--rotate", "30", "--about", "10,20"], {"rotate": 30, "about": (10, 20)}, "affine"),
    (["mobius"], {}, "mobius"),
]


@pytest.mark.parametrize("d", PATHS)
@pytest.mark.parametrize("words,values,name", SHORT, ids=[s[2] for s in SHORT])
@pytest.mark.parametrize("options", [{}, {"tolerance": 0.5, "nodes": "source"}, {"certify": True, "precision": 3}], ids=str)
def test_a_path_is_the_command_lines(cli, d, words, values, name, options):
    # Without fill, so that open paths stay as they are. The tolerance of a drawing is a share of what is painted, stroke included; a
    # path alone has none, so this one is as thin.
    page = "viewBox='-1000 -1000 3000 3000'"
    svg = f"<svg xmlns='http://www.w3.org/2000/svg' {page}><path fill='none' stroke='#000' stroke-width='1e-9' d='{d}'/></svg>"
    flags = [w for k, v in options.items() for w in ([f"--{k}"] if v is True else [f"--{k}", v])]
    out = cli(*words, "-", "--strokes", "keep", *flags, stdin=svg.encode()).decode()
    warped = pathwarp.warp_path(d, name, **values, **options)
    assert warped == re.search(r" d='([^']*)'", out).group(1)
    report = warped.report
    assert report["max_error"] <= options.get("tolerance", 1) and report["segments_out"] > 0
    # A swirl is not rational, so nothing about it can be proven.
    assert not options.get("certify") or name != "arc" or report["assurance"] == "certified"


@pytest.mark.parametrize("sample", ["logo.svg", "lettering.svg", "icon.svg"])
def test_a_drawing_is_the_command_lines(cli, tmp_path, sample):
    source = (SAMPLES / sample).read_bytes()
    report = tmp_path / "report.json"
    words = ["--strokes", "outline", "--fit", "grow", "--tolerance", "0.02"]
    by_cli = cli("shaper", f"samples/{sample}", "--shaper", "samples/banner.svg", *words, "--report", report)
    warped = pathwarp.warp_svg(
        source, "shaper", name=f"samples/{sample}", shaper=pathlib.Path("samples/banner.svg"),
        strokes="outline", fit="grow", tolerance=0.02,
    )
    assert warped == by_cli
    assert warped.report == json.loads(report.read_text())["inputs"][0]
    assert warped.warnings == warped.report["warnings"]


def test_many_drawings_are_those_warped_singly():
    names = [str(p) for p in sorted(SAMPLES.glob("*.svg"))]
    drawings = [pathlib.Path(name).read_bytes() for name in names]
    arc = Deformation("arc", bend=0.4)
    done = arc.warp_svgs([*drawings, b"<svg"], names=[*names, "broken.svg"], fit="grow")
    for drawing, name, warped in zip(drawings, names, done):
        alone = arc.warp_svg(drawing, name=name, fit="grow")
        assert (warped, warped.report, warped.warnings) == (alone, alone.report, alone.warnings)
    assert len(done) == len(names) + 1 and isinstance(done[-1], pathwarp.InputError) and "broken.svg" in str(done[-1])
    assert arc.warp_svgs([]) == []
    with pytest.raises(pathwarp.UsageError):
        arc.warp_svgs(drawings, names=names[1:])


@pytest.mark.parametrize("format", ["pdf", "dxf", "svgz"])
def test_other_formats(cli, tmp_path, format):
    file = tmp_path / f"out.{format}"
    cli("swirl", "samples/logo.svg", "--fit", "none", "-o", file)
    warped = pathwarp.warp_svg((SAMPLES / "logo.svg").read_bytes(), "swirl", name="samples/logo.svg", format=format)
    assert warped == file.read_bytes()


def test_recipes_chains_and_embedded_sources(cli, tmp_path):
    recipe = tmp_path / "both.toml"
    words = ["projective", "samples/logo.svg", "--target", "0%,100% 100%,100% 75%,0% 25%,0%", "--tolerance", "0.03"]
    by_cli = cli(*words, "+", "shaper", "--shaper", "samples/banner.svg", "--write-recipe", recipe, "-o", tmp_path / "a.svg")
    by_cli = (tmp_path / "a.svg").read_bytes()
    source = (SAMPLES / "logo.svg").read_bytes()
    chain = Deformation("projective", target="0%,100% 100%,100% 75%,0% 25%,0%") + Deformation("shaper", shaper="samples/banner.svg")
    assert chain.steps == ["projective", "shaper"]
    name = "samples/logo.svg"
    assert chain.warp_svg(source, name=name, tolerance=0.03) == by_cli
    assert pathwarp.warp_svg(source, recipe, name=name) == by_cli
    # A recipe that Python writes runs on the command line.
    again = tmp_path / "again.toml"
    again.write_text(chain.with_options(tolerance=0.03).to_recipe(tmp_path))
    assert cli("run", again, name) == by_cli
    embedded = chain.warp_svg(source, name=name, embed_recipe=True)
    assert cli("unwarp", "-", stdin=bytes(embedded)) == source


def test_deformations_can_be_pickled_and_compared():
    d = Deformation("shaper", shaper="samples/banner.svg", frame=(0, 0, 10, 10)).with_options(tolerance=0.1, limit={"work": 1e9})
    again = pickle.loads(pickle.dumps(d))
    assert again == d and hash(again) == hash(d) and again.map((3, 4)).tolist() == d.map((3, 4)).tolist()
    assert d != Deformation("swirl") and repr(d).startswith("Deformation('shaper', shaper='samples/banner.svg').with_options(frame='0,0,10,10', tol")


def test_guides_of_the_drawing_itself():
    svg = (SAMPLES / "paper-four-anchors.svg").read_bytes()
    warped = pathwarp.warp_svg(svg, "shaper", base="#Base", target="#Target", shaper="#Shaper")
    assert warped.startswith(b"<") and {s["id"] for s in warped.report["shapes"]}.isdisjoint({"Base", "Target", "Shaper"})
    with pytest.raises(pathwarp.InputError, match="no input document"):
        pathwarp.warp_path("M0,0 H1", "shaper", shaper="#Shaper")


ERRORS = [
    (pathwarp.UsageError, "did you mean `shaper`", lambda: Deformation("shapre")),
    (pathwarp.UsageError, "did you mean `reverse_shaper`", lambda: Deformation("shaper", reverse_shapre=True)),
    (pathwarp.UsageError, "one already", lambda: Deformation("arc", style="flag")),
    (pathwarp.UsageError, "shaper is needed", lambda: pathwarp.warp_path("M0,0 H9", "shaper")),
    (pathwarp.UsageError, "bend", lambda: pathwarp.warp_path("M0,0 H9", "arc", bend="much")),
    (pathwarp.UsageError, "program", lambda: Deformation("arc").with_options(out_dir="x")),
    (pathwarp.UsageError, "tolerance", lambda: pathwarp.warp_path("M0,0 H9", "arc", tolerance=-1)),
    (pathwarp.UsageError, "single path", lambda: pathwarp.warp_path("M0,0 H9", "arc", strokes="keep")),
    (pathwarp.UsageError, "writes a file", lambda: Deformation("anamorph", mesh="x.obj")),
    (pathwarp.UsageError, "not a number", lambda: Deformation("arc", bend=object())),
    (pathwarp.UsageError, "empty", lambda: Deformation.chain([])),
    (pathwarp.InputError, "path data", lambda: pathwarp.warp_path("M0,0 H", "arc")),
    (pathwarp.InputError, "missing.svg", lambda: Deformation("shaper", shaper="missing.svg")),
    (pathwarp.InputError, "missing.toml", lambda: Deformation.chain(pathlib.Path("missing.toml"))),
    (pathwarp.InputError, "recipe", lambda: Deformation.from_recipe("pathwarp = 2")),
    (pathwarp.InputError, "drawing", lambda: pathwarp.warp_svg(b"<svg", "arc")),
    (pathwarp.GeometryError, "anchors", lambda: pathwarp.warp_path("M0,0 H9 V9", "shaper", shaper="M0,0 H9 V9 Z")),
    (pathwarp.LimitError, "limit", lambda: pathwarp.warp_svg((SAMPLES / "logo.svg").read_bytes(), "arc", limit="elements=2")),
]


@pytest.mark.parametrize("kind,text,call", ERRORS, ids=[f"{e[0].__name__}-{e[1]}" for e in ERRORS])
def test_errors_are_exceptions(kind, text, call):
    with pytest.raises(kind, match=re.escape(text)) as caught:
        call()
    assert isinstance(caught.value, pathwarp.PathwarpError) and "--" not in str(caught.value)
    assert issubclass(pathwarp.UsageError, ValueError) and issubclass(pathwarp.InputError, ValueError)

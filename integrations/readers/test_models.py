"""Models as trimesh reads them: of the size drawn, in the unit of the format."""

import numpy as np
import pytest
import trimesh
from conftest import SAMPLES

# A plate of 122 by 40 mm, 3 mm thick, in a drawing of its size.
PLATE = (
    "<svg xmlns='http://www.w3.org/2000/svg' width='140mm' height='60mm' viewBox='0 0 140 60'>"
    "<rect x='9' y='10' width='122' height='40'/></svg>"
)
SIZE = np.array([122.0, 40.0, 3.0])
STAY = ("bend", "--preset", "twist", "--angle", "0deg")


def loaded(path):
    return trimesh.load(path, force="mesh")


@pytest.mark.parametrize("name, unit", [("a.glb", 1e-3), ("a.gltf", 1e-3), ("a.ply", 1.0), ("a.stl", 1.0), ("a.obj", 1.0)])
def test_a_drawing_has_its_size(run, tmp_path, name, unit):
    (tmp_path / "in.svg").write_text(PLATE)
    run("solid", *STAY, "in.svg", "--extrude", "3mm", "-o", name)
    mesh = loaded(tmp_path / name)
    np.testing.assert_allclose(mesh.extents, SIZE * unit, rtol=1e-6)
    mesh.merge_vertices(merge_norm=True, merge_tex=True)
    assert mesh.is_watertight
    np.testing.assert_allclose(abs(mesh.volume), SIZE.prod() * unit**3, rtol=1e-5)


def test_a_model_in_metres_keeps_its_size(run, tmp_path):
    trimesh.creation.box(extents=[0.122, 0.04, 0.003]).export(tmp_path / "in.glb")
    run("solid", *STAY, "in.glb", "-o", "out.glb")
    run("solid", *STAY, "in.glb", "-o", "out.stl")
    np.testing.assert_allclose(loaded(tmp_path / "out.glb").extents, SIZE / 1000, rtol=1e-6)
    np.testing.assert_allclose(loaded(tmp_path / "out.stl").extents, SIZE, rtol=1e-6)
    # A length of 61 mm is half the width.
    run("solid", "wrap", "in.glb", "--diameter", "61mm", "--refine", "0.01mm", "-o", "round.glb")
    assert abs(loaded(tmp_path / "round.glb").extents[0] - (0.061 + 2 * 0.003)) < 1e-4


def test_faces_of_different_sizes(run, tmp_path):
    (tmp_path / "house.obj").write_text(
        "v 0 0 0\nv 4 0 0\nv 4 3 0\nv 2 5 0\nv 0 3 0\nv 2 2 6\nf 5 4 3 2 1\nf 1 2 6\nf 2 3 6\nf 3 4 6\nf 4 5 6\nf 5 1 6\n"
    )
    run("solid", *STAY, "house.obj", "-o", "house.ply")
    mesh = loaded(tmp_path / "house.ply")
    assert len(mesh.faces) == 3 + 5 and mesh.is_watertight
    # A third of the area of the base, 16, by the height.
    np.testing.assert_allclose(abs(mesh.volume), 32.0, rtol=1e-6)
    (tmp_path / "quads.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
    run("solid", *STAY, "quads.obj", "-o", "quads.ply")
    assert abs(loaded(tmp_path / "quads.ply").area - 1) < 1e-9


def test_a_sample_becomes_a_solid(run, tmp_path):
    run("solid", "wrap", SAMPLES / "lettering.svg", "--extrude", "3mm", "--diameter", "64mm", "--top-diameter", "80mm", "--refine", "0.1mm", "-o", "a.ply")
    assert len(loaded(tmp_path / "a.ply").faces) > 1000

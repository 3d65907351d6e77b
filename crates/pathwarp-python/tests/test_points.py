"""Points and Jacobians, against the command line and against differences."""

import multiprocessing
import sys

import numpy as np
import pytest

import pathwarp
from pathwarp import Deformation

CAGE = "M10,90 Q40,110 95,85 L90,15 5,10 Z"
FRAME = (0, 0, 100, 100)
RNG = np.random.default_rng(7)
POINTS = RNG.uniform(0, 100, (500, 2))

CASES = [
    (["shaper", "--shaper", CAGE], Deformation("shaper", shaper=CAGE)),
    (["warp", "--style", "arc", "--bend", "40%"], Deformation("arc", bend=0.4)),
    (["swirl"], Deformation("swirl")),
    (["bulge"], Deformation("bulge")),
    (["bend", "--along", "M0,100 Q150,20 300,100"], Deformation("bend", along="M0,100 Q150,20 300,100")),
    (["affine", "--rotate", "30", "--about", "10,20"], Deformation("affine", rotate=30, about=(10, 20))),
    (
        ["mls", "--pin", "0%,100%", "--pin", "100%,100%", "--pair", "50%,0%:55%,-20%"],
        Deformation("mls", pin=["0%,100%", "100%,100%"], pair="50%,0%:55%,-20%"),
    ),
    (
        ["projective", "--target", "0%,100% 100%,100% 75%,0% 25%,0%", "+", "shaper", "--shaper", CAGE],
        Deformation("projective", target="0%,100% 100%,100% 75%,0% 25%,0%") + Deformation("shaper", shaper=CAGE),
    ),
]


def by_cli(cli, words, points, *more):
    text = "".join(f"{float(x)!r} {float(y)!r}\n" for x, y in points)
    out = cli("map", words[0], *more, *words[1:], stdin=text.encode()).split()
    return np.array(out, dtype=float).reshape(len(points), -1)


@pytest.mark.parametrize("words,deformation", CASES, ids=lambda v: v[0] if isinstance(v, list) else "")
def test_the_numbers_are_the_command_lines(cli, words, deformation):
    expected = by_cli(cli, words, POINTS, "--jacobian")
    # The batches of the two may round differently in the last place.
    np.testing.assert_allclose(deformation.map(POINTS), expected[:, :2], rtol=1e-14, atol=1e-12)
    jacobian = deformation.jacobian(POINTS)
    np.testing.assert_allclose(jacobian.transpose(0, 2, 1).reshape(-1, 4), expected[:, 2:], rtol=1e-12, atol=1e-12)


def test_a_frame_gives_percentages_their_meaning(cli):
    expected = by_cli(cli, ["shaper", "--shaper", CAGE], POINTS[:9], "--frame", "-10,-20,200,300")
    framed = Deformation("shaper", shaper=CAGE, frame=(-10, -20, 200, 300))
    np.testing.assert_allclose(framed.map(POINTS[:9]), expected, rtol=1e-14)


def test_jacobians_are_derivatives():
    swirl = Deformation("swirl", frame=FRAME)
    points, h = POINTS[:50], 1e-5
    for axis in range(2):
        step = np.zeros(2)
        step[axis] = h
        difference = (swirl.map(points + step) - swirl.map(points - step)) / (2 * h)
        np.testing.assert_allclose(swirl.jacobian(points)[:, :, axis], difference, atol=1e-7)


def test_the_inverse_undoes():
    shaper = Deformation("shaper", shaper=CAGE, frame=FRAME)
    np.testing.assert_allclose(shaper.inverse().map(shaper.map(POINTS)), POINTS, atol=1e-9)
    with pytest.raises(pathwarp.UsageError, match="frame"):
        Deformation("swirl").inverse()
    swirl = Deformation("swirl", frame=FRAME)
    np.testing.assert_allclose(Deformation("swirl").inverse(FRAME).map(swirl.map(POINTS)), POINTS, atol=1e-9)


def test_arrays_are_read_and_written_where_they_are():
    arc = Deformation("arc", bend=0.4, frame=FRAME)
    expected = arc.map(POINTS)
    # Views with strides, other orders and other types.
    wide = np.zeros((len(POINTS), 5))
    wide[:, 1:4:2] = POINTS
    assert np.array_equal(arc.map(wide[:, 1:4:2]), expected)
    assert np.array_equal(arc.map(np.asfortranarray(POINTS)), expected)
    assert np.array_equal(arc.map(POINTS[::-1]), expected[::-1])
    assert np.array_equal(arc.map(POINTS.tolist()), expected)
    out = np.full((len(POINTS), 5), 7.0)
    view = out[:, 2:4]
    assert arc.map(POINTS, out=view) is view
    assert np.array_equal(out[:, 2:4], expected) and (out[:, [0, 1, 4]] == 7).all()
    same = POINTS.copy()
    assert arc.map(same, out=same) is same and np.array_equal(same, expected)
    assert np.array_equal(arc.map(POINTS[3]), expected[3]) and arc.jacobian(POINTS[3]).shape == (2, 2)
    assert arc.map(np.empty((0, 2))).shape == (0, 2)


def test_wrong_arrays_are_refused():
    swirl = Deformation("swirl", frame=FRAME)
    for wrong in (np.zeros(3), np.zeros((4, 3)), np.zeros((2, 2, 2))):
        with pytest.raises(pathwarp.UsageError, match="points"):
            swirl.map(wrong)
    for out in (np.zeros((3, 2)), np.zeros((500, 2), dtype=np.float32), POINTS.tolist()):
        with pytest.raises(pathwarp.UsageError, match="out"):
            swirl.map(POINTS, out=out)
    both = np.zeros((501, 2))
    with pytest.raises(pathwarp.UsageError, match="out"):
        swirl.map(both[:500], out=both[1:])
    frozen = np.zeros((500, 2))
    frozen.flags.writeable = False
    with pytest.raises(pathwarp.UsageError, match="out"):
        swirl.map(POINTS, out=frozen)


def test_points_outside_of_the_domain_are_nan(cli):
    words = ["projective", "--base", "0,0 10,0 10,10 0,10", "--target", "0,0 10,0 8,6 2,6"]
    tilt = Deformation("projective", base="0,0 10,0 10,10 0,10", target=[(0, 0), (10, 0), (8, 6), (2, 6)])
    points = np.array([[5.0, 5.0], [5.0, -100.0], [np.nan, 1.0]])
    mapped = tilt.map(points)
    assert np.isfinite(mapped[0]).all() and np.isnan(mapped[1:]).all()
    text = b"5 5\n5 -100\n"
    assert cli("map", *words, stdin=text, status=1).split()[2:] == [b"nan", b"nan"]


def test_results_do_not_depend_on_the_number_of_threads():
    many = RNG.uniform(0, 100, (200_000, 2))
    swirl = Deformation("swirl", frame=FRAME)
    try:
        results = []
        for threads in (1, 2, 5, 0):
            pathwarp.use_threads(threads)
            results.append(swirl.map(many))
    finally:
        pathwarp.use_threads(0)
    assert all(np.array_equal(results[0], r) for r in results[1:])


def _mapped(_):
    return Deformation("swirl", frame=FRAME).map(np.ones((100_000, 2)) * 30).sum()


@pytest.mark.skipif(sys.platform != "linux", reason="fork")
def test_a_forked_process_has_its_own_threads():
    here = _mapped(0)
    with multiprocessing.get_context("fork").Pool(2) as pool:
        assert pool.map_async(_mapped, range(4)).get(timeout=1000) == [here] * 4

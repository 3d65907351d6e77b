"""Ctrl-C and progress, in a process of their own."""

import os
import subprocess
import sys
import textwrap

import pytest

import pathwarp
from pathwarp import Deformation
from conftest import SAMPLES

SETTING = """
import os, signal, sys, threading, time
import numpy as np
from pathwarp import Deformation
swirl = Deformation("swirl", frame=(0, 0, 100, 100))
noisy = Deformation("expr", x="x+sin(x*y)", y="y+sin(x*y)", frame=(0, 0, 100, 100)).with_options(limit={"work": None}, tolerance=1e-7)
points = np.random.default_rng(1).uniform(0, 100, (4_000_000, 2))
curves = "M0,0" + "".join(f"C{i * 37 % 100},{i * 7 % 100} {i * 13 % 100},{i * 29 % 100} {i % 100},{i % 97}" for i in range(20000))
svg = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 99 99"><path d="{curves}"/></svg>'
def again(f):
    while True:
        f()
"""

WORK = {
    "points": "again(lambda: swirl.map(points))",
    "points in place": "again(lambda: swirl.map(points, out=points))",
    "points of an inverse": "swirl.inverse().map(np.tile(points, (8, 1)))",
    "jacobians": "again(lambda: swirl.jacobian(points))",
    "a path": "noisy.warp_path(curves)",
    "a drawing": "noisy.warp_svg(svg)",
    "many drawings": "swirl.warp_svgs(['samples/logo.svg'] * 20000)",
    "a picture": "swirl.warp_svg(np.zeros((8000, 8000, 3), np.uint8), limit={'work': None, 'memory': None})",
}


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
@pytest.mark.parametrize("work", WORK.values(), ids=WORK)
def test_ctrl_c_ends_work_soon(work):
    code = SETTING + textwrap.dedent(f"""
        def interrupt():
            time.sleep(0.3)
            print(time.process_time())
            os.kill(os.getpid(), signal.SIGINT)
        threading.Thread(target=interrupt).start()
        try:
            {work}
        except KeyboardInterrupt:
            print(time.process_time())
            # What is left works as before.
            assert np.isfinite(swirl.map(points[:1000])).all()
        else:
            print("done")
        sys.stdout.flush()
        os._exit(0)
    """)
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=1000)
    began, ended = map(float, out.stdout.split()) if not out.stderr else pytest.fail(out.stderr)
    # A quarter of a second is promised; all threads work on for so long. The work itself takes many seconds of each.
    assert ended - began < 2.5 * os.cpu_count()


def test_progress_counts_to_the_end():
    drawings = [SAMPLES / "logo.svg"] * 40 + ["no.svg", None]
    seen = []
    done = Deformation("arc").warp_svgs(drawings, progress=seen.append)
    assert seen == sorted(set(seen)) and seen[-1] == len(done) == 42 and isinstance(done[-2], pathwarp.InputError)

    def full(n):
        raise OSError("no room on the screen")

    with pytest.raises(OSError, match="no room"):
        Deformation("arc").warp_svgs(drawings, progress=full)

"""Runs the program that $PATHWARP names, in an empty folder."""

import os
import subprocess
from pathlib import Path

import pytest

SAMPLES = Path(__file__).resolve().parents[2] / "samples"


@pytest.fixture
def run(tmp_path):
    def run(*args, code=0):
        done = subprocess.run([os.environ["PATHWARP"], *map(str, args)], cwd=tmp_path, capture_output=True, text=True)
        assert done.returncode == code, f"{args}: {done.stderr}"
        return done.stderr

    return run

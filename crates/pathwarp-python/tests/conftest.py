"""The command line to compare with: the program that PATHWARP names, or the one that cargo built last."""

import os
import pathlib
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[3]
SAMPLES = ROOT / "samples"


@pytest.fixture(scope="session")
def cli():
    program = pathlib.Path(os.environ.get("PATHWARP", ROOT / "target/debug/pathwarp"))
    assert program.is_file(), f"{program} is not built: cargo build, or name it in PATHWARP"

    def run(*words, stdin=None, status=0):
        done = subprocess.run([program, *map(str, words)], input=stdin, capture_output=True, cwd=ROOT)
        assert done.returncode == status, done.stderr.decode()
        return done.stdout

    return run


@pytest.fixture(autouse=True)
def in_root(monkeypatch):
    monkeypatch.chdir(ROOT)

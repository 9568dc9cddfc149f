"""A small case, and two ways to run a command: in this process, and as a process of its own."""

import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest
from typer.testing import CliRunner

from axlespan.cli.app import app

CASE = """\
title: Footbridge
structure:
  kind: simple-span
  length: 25 m
  youngs_modulus: 34 GPa
  second_moment: 0.9 m^4
  mass_per_length: 12 t/m
  elements: 20
train:
  - vehicle: sprung-mass
    mass: 5750 kg
    stiffness: 1595 kN/m
crossing:
  speed: 80 km/h
analysis:
  time_step: 1 ms
  steps: 50
output:
  sensors:
    midspan: 12.5 m
"""
COMMAND = Path(sys.executable).with_name("axlespan")


class Answer(NamedTuple):
    """What a command said, and its exit code."""

    code: int
    out: str
    err: str


def in_process(*words):
    """Run a command here; anything but its own exit is a failure."""
    done = CliRunner().invoke(app, [str(word) for word in words])
    if done.exception is not None and not isinstance(done.exception, SystemExit):
        raise done.exception
    return Answer(done.exit_code, done.stdout, done.stderr)


def started(*words, prefix=(), **options):
    """Start a command as a process."""
    environment = os.environ | {"MPLBACKEND": "Agg", "OMP_NUM_THREADS": "1"} | options.pop("env", {})
    # A parent that runs in the background ignores SIGINT, and its children would too.
    attended = {"preexec_fn": lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)}
    given = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "env": environment, **attended} | options
    return subprocess.Popen([*prefix, str(COMMAND), *map(str, words)], **given)


def process(*words, **options):
    """Run a command as a process to its end."""
    with started(*words, **options) as running:
        out, err = (text.decode("utf-8") if text else "" for text in running.communicate(timeout=60))
    return Answer(running.returncode, out, err)


@pytest.fixture(scope="session")
def axlespan():
    """Run a command in this process: ``axlespan("run", case, "-o", folder)``."""
    return in_process


@pytest.fixture(scope="session")
def axlespan_process():
    """Run a command as a process of its own."""
    return process


@pytest.fixture(scope="session")
def command():
    """Path of the command."""
    return str(COMMAND)


@pytest.fixture(scope="session")
def axlespan_started():
    """Start a command as a process of its own, and go on."""
    return started


@pytest.fixture
def case(tmp_path):
    """Write the small case with pieces of its text replaced; its path."""

    def write(*edits, name="case.yaml"):
        text = CASE
        for old, new in edits:
            assert old in text, f"{old!r} is not in the case"
            text = text.replace(old, new, 1)
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    return write

"""Small studies, and runs of them in processes of their own."""

import os
import subprocess
import sys
import textwrap

import numpy as np
import pytest

BASE = """\
  structure: {kind: simple-span, length: 10 m, youngs_modulus: 34 GPa, second_moment: 0.1 m^4, mass_per_length: 8 t/m,
    elements: 6}
  train: [{vehicle: sprung-mass, mass: 12 t, stiffness: 1.5 MN/m, damping: 20 kNs/m, count: 2, spacing: 5 m}]
  crossing: {speed: 100 km/h}
  analysis: {time_step: 4 ms, alpha: -0.1}
  output: {sensors: {midspan: 5 m}, line: 5}
"""

STUDY = f"""\
title: A small study
base:
{BASE}\
vary:
  crossing.speed: {{from: 100 km/h, to: 300 km/h, step: 40 km/h}}
  structure.second_moment: {{factor: [0.9, 1.1]}}
  crossing.irregularity:
    - {{kind: none}}
    - {{kind: harmonic, amplitude: 0.5 mm, wavelength: 4 m}}
passage: {{after: 0.1 s}}
"""

# A run in a process of its own that writes each task at once, in tasks of a few scenarios.
_RUN = """\
import sys
from axlespan.study.sweep import planning, store
store._SECONDS = 0.0
planning.MOST_LANES = 2
from axlespan.study.sweep import study
study.lanes_for = lambda scenarios, workers, most: 2
if __name__ == "__main__":
    from axlespan.cli.entry import main
    main()
"""


@pytest.fixture
def study_file(tmp_path):
    """Writes a study file."""

    def write(text=STUDY, name="study.yaml"):
        path = tmp_path / name
        path.write_text(textwrap.dedent(text))
        return path

    return write


@pytest.fixture
def start(tmp_path):
    """Starts ``axlespan sweep`` in a process of its own."""
    script = tmp_path / "run.py"
    script.write_text(_RUN)
    running = []

    def begin(*arguments, **options):
        command = [sys.executable, str(script), "sweep", *map(str, arguments), "--no-figures"]
        environment = {**os.environ, "OMP_NUM_THREADS": "1"}
        process = subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment, **options
        )
        running.append(process)
        return process

    yield begin
    for process in running:
        process.kill()
        process.communicate()


def numbers_differ(one, other):
    """Largest difference of two tables, relative to the peak of each column; other columns must be equal."""
    assert list(one.index) == list(other.index)
    worst = 0.0
    for name in one.columns:
        a, b = one[name], other[name]
        if name == "seconds" or name.endswith("_residual"):
            continue
        if a.dtype.kind == "f":
            assert (a.isna() == b.isna()).all(), name
            peak = np.nanmax(np.abs(a)) if a.notna().any() else 0.0
            if peak > 0.0:
                worst = max(worst, float(np.nanmax(np.abs(a - b)) / peak))
        elif name not in ("histories", "records"):
            assert a.equals(b), name
    return worst

"""A run whose steps do not converge: cut, and in the end given up with exit code 3, its history kept."""

import json

import pytest
import xarray as xr

from axlespan.interaction.nonlinear.contact import NonlinearCoupling, StepNotConverged

CASE = """
structure: {kind: simple-span, length: 25 m, youngs_modulus: 2.87 GPa, second_moment: 2.90 m^4,
            mass_per_length: 2303 kg/m, elements: 8}
train:
  - vehicle: multibody
    bodies: [{name: body, mass: 5 t, position: 0 m}]
    wheels: [{position: 0 m, mass: 500 kg}]
    suspensions: [{between: [body, wheel1], stiffness: 1595 kN/m, damping: 20 kNs/m,
                   bump_stop: {gap: 30 mm, stiffness: 10 MN/m}}]
crossing: {speed: 30 m/s}
analysis: {time_step: 1 ms, steps: 100, contact: hertz, cuts: 3}
output: {sensors: {midspan: 12.5 m}}
"""


@pytest.fixture
def run(axlespan, tmp_path, monkeypatch):
    """Run the case with steps that fail from one on, unless they are made in so many parts."""
    plain = NonlinearCoupling.__call__

    def begin(first, enough):
        def call(self, convoy, stretch, k, external):
            parts = round(1e-3 / self.time_step)
            if (stretch.first + k - 1) // parts + 1 >= first and parts < enough:
                raise StepNotConverged("", "contact 1.1", 12.0, 60)
            return plain(self, convoy, stretch, k, external)

        monkeypatch.setattr(NonlinearCoupling, "__call__", call)
        case = tmp_path / "case.yaml"
        case.write_text(CASE, encoding="utf-8")
        return axlespan("run", case, "-o", tmp_path / "out", "--no-figures"), tmp_path / "out"

    return begin


def test_cut_steps_are_told(run):
    answer, folder = run(98, 4)
    assert answer.code == 0
    assert ", 3 steps cut, " in answer.out
    assert (
        "3 steps (98, 99, 100) did not converge as a whole and went in parts of 0.00025 s at least"
        in answer.out
    )
    computation = json.loads((folder / "summary.json").read_text(encoding="utf-8"))["computation"]
    assert computation["cut_steps"] == 3 and computation["smallest_time_step_s"] == 2.5e-4


def test_what_was_computed_is_kept(run):
    answer, folder = run(41, 16)
    assert answer.code == 3
    said = "did not converge as a whole, nor in 8 parts of 0.000125 s"
    assert f"step 41, t = 0.041 s: the interface of wheels and springs {said}" in answer.err
    assert "worst at contact 1.1" in answer.err and "Use a smaller time step" in answer.err
    with xr.open_dataset(folder / "result.nc") as data:
        assert data.attrs["outcome"] == "failed" and said in data.attrs["outcome_message"]
        assert data.sizes["time"] == 41
        assert abs(data["sensor_displacement"].values[-1, 0]) > 0.0

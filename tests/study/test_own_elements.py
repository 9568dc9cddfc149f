"""Nonlinear elements in Python files that a case names: runs against the same in Python, and what is said of wrong ones."""

import numpy as np
import pytest

import axlespan as asp
from axlespan.errors import InputError
from axlespan.interaction.runs import run_plan
from axlespan.model.nonlinear_elements import with_nonlinear_element
from axlespan.study.build import build
from axlespan.study.loader import load_case

PAIR = """
import numpy as np


class Pair:
    \"\"\"k e^3 + c de/dt between two d.o.f.\"\"\"

    def __init__(self, k, c=0.0):
        self.k, self.c = k, c

    def force(self, u, v, state):
        return (self.k * (u[0] - u[1]) ** 3 + self.c * (v[0] - v[1])) * np.array([1.0, -1.0])

    def tangent(self, u, v, state):
        pair = np.array([[1.0, -1.0], [-1.0, 1.0]])
        return 3.0 * self.k * (u[0] - u[1]) ** 2 * pair, self.c * pair

    def advanced(self, u, v, state):
        return state
"""
ON_DECK = "own_elements: [{file: pair.py, element: Pair, dofs: [n3.z, n7.z], arguments: {k: 4e11, c: 3e5}}]"
IN_CAR = "own_elements: [{file: pair.py, element: Pair, dofs: [body.z, wheel1.z], arguments: {k: 2e10}, name: stop}]"
CASE = f"""
structure:
  kind: simple-span
  length: 25 m
  youngs_modulus: 2.87 GPa
  second_moment: 2.90 m^4
  mass_per_length: 2303 kg/m
  elements: 8
  {ON_DECK}
train:
  - vehicle: multibody
    bodies: [{{name: body, mass: 5750 kg, position: 0 m}}]
    wheels: [{{position: 0 m, mass: 800 kg}}]
    suspensions: [{{between: [body, wheel1], stiffness: 1595 kN/m, damping: 20 kNs/m}}]
    {IN_CAR}
crossing: {{speed: 40 m/s, irregularity: {{kind: harmonic, amplitude: 3 mm, wavelength: 6 m}}}}
analysis: {{time_step: 1 ms, steps: 300}}
output: {{sensors: {{m: 12.5 m}}}}
"""


@pytest.fixture
def made(tmp_path):
    def make(*edits, element=PAIR):
        text = CASE
        for old, new in edits:
            assert old in text
            text = text.replace(old, new)
        (tmp_path / "pair.py").write_text(element, encoding="utf-8")
        (tmp_path / "case.yaml").write_text(text, encoding="utf-8")
        return build(load_case(tmp_path / "case.yaml"))

    return make


def test_elements_of_a_case_are_those_of_python(made):
    space = {}
    exec(PAIR, space)
    bridge = asp.bridges.simple_span(
        length=25.0, youngs_modulus=2.87e9, second_moment=2.90, mass_per_length=2303.0, elements=8
    )
    bridge = with_nonlinear_element(bridge, space["Pair"](4e11, 3e5), ["n3.z", "n7.z"])
    car = asp.vehicles.multibody(
        bodies=[asp.vehicles.Body("body", 5750.0, 0.0)],
        wheels=[asp.vehicles.Wheel(0.0, 800.0)],
        suspensions=[asp.vehicles.Suspension(("body", "wheel1"), 1.595e6, 20e3)],
    )
    car = with_nonlinear_element(car, space["Pair"](2e10), ["body.z", "wheel1.z"])
    waves = asp.irregularity.Harmonic(amplitude=3e-3, wavelength=6.0)
    crossing = asp.Crossing(bridge, asp.Train.of(car), speed=40.0, irregularity=waves)
    own = asp.simulate(crossing, time_step=1e-3, steps=300, sensors={"m": 12.5})
    built = made()
    result = run_plan(built.plan)
    np.testing.assert_array_equal(result.sensor_displacement, own.sensor_displacement)
    np.testing.assert_array_equal(result.contact_force, own.contact_force)
    names = [springs.name for springs in built.crossing.structure.system.nonlinear]
    names += [item.vehicle.system.nonlinear[0].name for item in built.crossing.placements]
    assert names == ["Pair", "stop"]
    without = run_plan(made((f"  {ON_DECK}\n", ""), (f"    {IN_CAR}\n", "")).plan)
    for name in ("sensor_displacement", "contact_force"):
        change = np.abs(getattr(without, name) - getattr(own, name)).max()
        assert change > 0.005 * np.abs(getattr(own, name)).max(), name


@pytest.mark.parametrize(
    ("edit", "words"),
    [
        (("file: pair.py, element: Pair, dofs: [n3", "file: pear.py, element: Pair, dofs: [n3"),
         r"9:25: structure\.own_elements\.0\.file = pear\.py: no such file\. Did you mean pair\.py\?"),
        (("element: Pair, dofs: [n3", "element: Pear, dofs: [n3"),
         r"9:43: structure\.own_elements\.0\.element = Pear: is no class in pair\.py\. Did you mean Pair\?"),
        (("{k: 4e11, c: 3e5}", "{k: 4e11, d: 1}"),
         r"arguments = \{k: 4e11, d: 1\}: do not fit Pair\(k, c=0\.0\): got an unexpected keyword argument 'd'"),
        (("{k: 4e11, c: 3e5}", "{c: 3e5}"), r"do not fit Pair\(k, c=0\.0\): missing a required argument: 'k'"),
        (("{k: 4e11, c: 3e5}", "{k: stiff}"), r"arguments\.k = stiff: must be a number"),
        (("n7.z", "n77.z"), r"own_elements\.0\.dofs = n77\.z: is not a known degree of freedom\. Did you mean 'n7\.z'\?"),
        (("n7.z", "n3.z"), r"own_elements\.0\.dofs = \[n3\.z, n3\.z\]: must name d\.o\.f\., each once"),
        (("[n3.z, n7.z]", "[]"), r"own_elements\.0\.dofs = \[\]: must name d\.o\.f\., each once"),
        (("[n3.z, n7.z]", "[n3.z, n7.z, n8.z]"),
         r"element = Pair: has a force of the shape \(2,\); it must have the shape \(3,\)"),
        (("wheel1.z]", "wheel.z]"), r"15:57: train\.0\.own_elements\.0\.dofs = wheel\.z: is not a known"),
    ],
)  # fmt: skip
def test_what_is_said_of_a_wrong_entry(made, edit, words):
    with pytest.raises(InputError, match=words):
        made(edit)


@pytest.mark.parametrize(
    ("element", "words"),
    [
        ("def f(:", r"file = pair\.py: cannot be run: SyntaxError in line 1: "),
        ("x = 1\nimport nothing_of_this_name", r"cannot be run: ModuleNotFoundError in line 2: No module named"),
        ("class Pair:\n  def __init__(self, k, c=0): raise ValueError('too soft')",
         r"element = Pair: cannot be made: ValueError in line 2: too soft"),
        ("import sys\nsys.exit(5)", r"file = pair\.py: cannot be run: SystemExit in line 2: 5"),
        (PAIR.replace("return state", "return state\n\n    def __init__(self, k, c=0): raise SystemExit('no licence')"),
         r"element = Pair: cannot be made: SystemExit in line \d+: no licence"),
        (PAIR.replace("* np.array([1.0, -1.0])", "* np.array([np.nan, 1.0])"),
         r"element = Pair: has a force of \[nan, 0\.0\]; it must be finite numbers at rest"),
        (PAIR.replace("self.c * pair", "np.inf * np.abs(pair)"),
         r"element = Pair: has a tangent of \[\[inf, inf\], \[inf, inf\]\]; it must be finite numbers at rest"),
        (PAIR.replace("def tangent", "def slope"), r"element = Pair: has no method tangent\(u, v, state\)"),
        (PAIR.replace("advanced(self, u, v, state)", "advanced(self, u)"),
         r"element = Pair: has advanced\(u\), which must take \(u, v, state\)"),
        (PAIR.replace("self.k * (u[0] - u[1]) ** 3", "u[7]"), r"element = Pair: fails at rest: IndexError in line 12: index 7"),
        ("Pair = 3", r"element = Pair: is no class in pair\.py$"),
    ],
)  # fmt: skip
def test_what_is_said_of_a_wrong_file(made, element, words):
    with pytest.raises(InputError, match=words):
        made(element=element)


def test_a_file_that_is_no_python(made, tmp_path):
    (tmp_path / "pair.txt").write_text(PAIR, encoding="utf-8")
    with pytest.raises(InputError, match=r"file = pair\.txt: is no Python file\. Use pair\.py"):
        made(("file: pair.py, element: Pair, dofs: [n3", "file: pair.txt, element: Pair, dofs: [n3"))

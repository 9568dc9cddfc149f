"""Beam elements: order of convergence, frequencies, continuous beams."""

from __future__ import annotations

import numpy as np

import axlespan as asp
from axlespan.bridges import SupportAt
from axlespan.linalg.eigen import lowest_modes
from axlespan.reference import (
    euler_bernoulli_frequencies,
    point_load_deflection,
    timoshenko_frequencies,
)
from axlespan.reference.beam_frequencies import Supports
from axlespan.verification.case import FloatArray, Row, case, history, value
from axlespan.verification.models import BENDING_STIFFNESS, LENGTH, MASS_PER_LENGTH, axle, beam

_BLEVINS = "R.D. Blevins, Formulas for Natural Frequency and Mode Shape (1979), table 8-1"
_CLAPEYRON = "Clapeyron's equation of three moments"
_LOAD = 1e5  # [N]


@case(
    "beam-order",
    "Deflection between nodes is of fourth order in the element size",
    "G. Strang, G.J. Fix, An Analysis of the Finite Element Method (1973): cubic elements",
)
def beam_order() -> list[Row]:
    """1600 equal forces stand side by side on a simple span, as good as a uniform load q; elements of size h.

    Nodes are exact, so it is measured in the middle of elements, where q h^4 / 384 EI is missing.
    """
    count = 1600
    share = LENGTH / count
    place = (np.arange(count) + 0.5) * share
    behind = tuple(place - place[0])
    train = asp.Train.of(asp.vehicles.axle_loads(loads=_LOAD * share, positions=behind))
    errors = {}
    for elements in (8, 16):
        middle = (np.arange(elements) + 0.5) * LENGTH / elements
        sensors = {f"element {i + 1}": float(x) for i, x in enumerate(middle)}
        crossing = asp.Crossing(beam(elements), train, speed=0.0, start=float(place[-1]))
        result = asp.simulate(crossing, time_step=1e-3, steps=1, sensors=sensors)
        exact = point_load_deflection(
            middle[:, np.newaxis],
            force=_LOAD * share,
            at=place,
            length=LENGTH,
            bending_stiffness=BENDING_STIFFNESS,
        ).sum(axis=1)
        errors[elements] = np.abs(result.sensor_displacement[0] - exact).max()
    missing = _LOAD * (LENGTH / 16) ** 4 / (384.0 * BENDING_STIFFNESS)
    order = np.log2(errors[8] / errors[16])
    return [
        value("order in the element size", "-", 4.0, order, 0.05, "cubic elements", scale=1.0, of="1"),
        value("missing amid an element of 16", "mm", 1e3 * missing, 1e3 * errors[16], 0.01, "q h^4 / 384 EI"),
    ]


@case("beam-frequencies", "Frequencies of thin beams", _BLEVINS)
def beam_frequencies() -> list[Row]:
    """The three lowest frequencies of beams with pinned, fixed and free ends; 50 elements.

    Cubic elements with consistent mass are too stiff by (λ h / L)^4 / 1440 in a frequency: 2e-6 here.
    """
    fixed = ("z", "ry")
    ends: dict[Supports, list[SupportAt]] = {
        "pinned-pinned": [SupportAt(0.0), SupportAt(LENGTH)],
        "fixed-free": [SupportAt(0.0, fixed)],
        "fixed-fixed": [SupportAt(0.0, fixed), SupportAt(LENGTH, fixed)],
        "fixed-pinned": [SupportAt(0.0, fixed), SupportAt(LENGTH)],
    }
    rows = []
    for name, supports in ends.items():
        exact = euler_bernoulli_frequencies(LENGTH, BENDING_STIFFNESS, MASS_PER_LENGTH, 3, name)
        obtained = _bending_frequencies(beam(supports=supports), 3)
        rows += [
            value(f"{name}, mode {i + 1}", "Hz", exact[i] / (2.0 * np.pi), obtained[i], 1e-5, "roots (R23)")
            for i in range(3)
        ]
    return rows


@case(
    "timoshenko-frequencies",
    "Frequencies of a deep beam with shear and rotary inertia",
    "S.P. Timoshenko, Phil. Mag. 41 (1921) 744-746; theory page 'Reference solutions', (R24)",
)
def timoshenko() -> list[Row]:
    """A steel bar of 0.5 m x 1.0 m, simply supported over 10 m: shear takes a quarter of the fifth frequency.

    Elements with shear deformation converge with the square of their size; 400 elements.
    """
    length, width, depth = 10.0, 0.5, 1.0
    modulus, ratio, density = 210e9, 0.3, 7850.0
    area, second_moment = width * depth, width * depth**3 / 12.0
    obtained = {
        elements: _bending_frequencies(
            asp.bridges.simple_span(
                length=length,
                youngs_modulus=modulus,
                poisson_ratio=ratio,
                second_moment=second_moment,
                area=area,
                shear_area=5.0 / 6.0 * area,
                mass_per_length=density * area,
                elements=elements,
            ),
            5,
        )
        for elements in (100, 200, 400)
    }
    shear = 5.0 / 6.0 * modulus / (2.0 * (1.0 + ratio)) * area
    exact = timoshenko_frequencies(
        length, modulus * second_moment, shear, density * area, density * second_moment, 5
    ) / (2.0 * np.pi)
    printed = (23.068, 88.152, 185.720, 305.751, 440.375)
    rows = [
        value(f"mode {i + 1}", "Hz", printed[i], obtained[400][i], 1e-4, "root of (R24), as printed")
        for i in range(5)
    ]
    order = np.log2((obtained[100][4] - exact[4]) / (obtained[200][4] - exact[4]))
    return [*rows, value("order, mode 5", "-", 2.0, order, 0.05, "linear shear", scale=1.0, of="1")]


def _bending_frequencies(structure: asp.Structure, count: int) -> FloatArray:
    """The lowest frequencies [Hz] of modes that move more up and down than along."""
    blocks = structure.system.partition
    modes = lowest_modes(blocks.K_FF, blocks.M_FF, min(3 * count, blocks.K_FF.shape[0]))
    components = np.array(structure.system.components)[structure.system.independent[structure.system.free]]
    size = {part: np.abs(modes.shapes[components == part]).sum(axis=0) for part in ("x", "z")}
    return np.asarray(modes.frequencies[size["z"] > size["x"]][:count])


@case("two-spans", "A force on a continuous beam of two spans", _CLAPEYRON)
def two_spans() -> list[Row]:
    """A force stands in the middle of a span, and crosses at 1 m/s; 20 elements a span, 5 % damping.

    The influence line of the middle reaction is x (3 - x^2) / 2, x = distance from the near end over the span. The
    first and the last 5 % of a span are left out: the entry shakes the beam.
    """
    structure = beam(20, spans=2, damping=asp.Modal(0.05))
    rows = _standing(structure, 0, (13 / 32, 22 / 32, -3 / 32), (-23 / 1536, 3 / 512))
    crossing = asp.Crossing(structure, axle(_LOAD), speed=1.0)
    result = asp.simulate(crossing, time_step=1e-2, steps=5000)
    x = result.contact_position[:, 0] / LENGTH
    near = np.minimum(x, 2.0 - x)
    window = np.flatnonzero((x > 0.05) & (x < 1.95))
    rows.append(
        history(
            "slow force: middle reaction over the force",
            "-",
            x[window],
            _middle_reaction(near[window]),
            result.support_reaction[window, 1] / _LOAD,
            1e-3,
            _CLAPEYRON,
        )
    )
    return rows


def _middle_reaction(x: FloatArray) -> FloatArray:
    """Influence line of the middle of three supports; x is the distance from the near end over the span."""
    return 0.5 * x * (3.0 - x**2)


@case("three-spans", "A force on a continuous beam of three spans", _CLAPEYRON)
def three_spans() -> list[Row]:
    """A force stands in the middle of the first, then of the second span; 20 elements a span."""
    structure = beam(20, spans=3)
    return [
        *_standing(structure, 0, (0.4, 0.725, -0.15, 0.025), (-7 / 480, 3 / 640, -1 / 640), "first span: "),
        *_standing(
            structure, 1, (-0.075, 0.575, 0.575, -0.075), (3 / 640, -11 / 960, 3 / 640), "second span: "
        ),
    ]


def _standing(
    structure: asp.Structure,
    loaded: int,
    reactions: tuple[float, ...],
    deflections: tuple[float, ...],
    word: str = "",
) -> list[Row]:
    """Reactions [P] and mid-span deflections [P L^3 / EI] under a force P in the middle of a span."""
    middles = {f"midspan {i + 1}": (i + 0.5) * LENGTH for i in range(len(deflections))}
    crossing = asp.Crossing(structure, axle(_LOAD), speed=0.0, start=(loaded + 0.5) * LENGTH)
    result = asp.simulate(crossing, time_step=1e-2, steps=1, sensors=middles)
    rows = [
        value(
            f"{word}reaction {i + 1} over the force",
            "-",
            expected,
            result.support_reaction[0, i] / _LOAD,
            1e-8,
            _CLAPEYRON,
            scale=1.0,
            of="force",
        )
        for i, expected in enumerate(reactions)
    ]
    unit = _LOAD * LENGTH**3 / BENDING_STIFFNESS
    return rows + [
        value(
            f"{word}deflection {i + 1} over P L^3 / EI",
            "-",
            expected,
            result.sensor_displacement[0, i] / unit,
            1e-8,
            _CLAPEYRON,
        )
        for i, expected in enumerate(deflections)
    ]


CASES = (beam_order, beam_frequencies, timoshenko, two_spans, three_spans)

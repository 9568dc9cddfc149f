"""Beams of solid elements: frequencies, deflections, and N12's example 3.2 on 10 000 of them."""

from __future__ import annotations

from dataclasses import replace
from importlib.resources import as_file, files

import numpy as np
import numpy.typing as npt

import axlespan as asp
from axlespan.interaction.runs import run_plan
from axlespan.linalg.eigen import lowest_modes
from axlespan.linalg.factor import factorize
from axlespan.reference import timoshenko_frequencies
from axlespan.reference.neves2012 import mass_train
from axlespan.study.build import BuiltCase, build
from axlespan.study.loader import load_case
from axlespan.verification.case import Row, case, history, value
from axlespan.verification.models import (
    BENDING_STIFFNESS,
    LENGTH,
    MASS_PER_LENGTH,
    SECOND_MOMENT,
    YOUNGS_MODULUS,
)

FloatArray = npt.NDArray[np.float64]

_N12 = "S.G.M. Neves, A.F.M. Azevedo, R. Calçada, Engineering Structures (2012)"
_WIDTH, _DEPTH, _POISSON_RATIO = 2.2272, 2.5, 0.2  # [m], [m], [-]
_SHEAR_STIFFNESS = 5.0 / 6.0 * YOUNGS_MODULUS / (2.0 * (1.0 + _POISSON_RATIO)) * _WIDTH * _DEPTH  # [N]
_ROTARY = MASS_PER_LENGTH / (_WIDTH * _DEPTH) * SECOND_MOMENT  # [kg m]
_THICK = "thick (Timoshenko) beam, shear area 5/6 of the area"


def _shipped(name: str) -> BuiltCase:
    """A case that comes with the package."""
    with as_file(files("axlespan") / "examples" / f"{name}.yaml") as path:
        return build(load_case(path))


def _first_bending(built: BuiltCase) -> float:
    """Lowest angular frequency whose mode moves the middle of the running line [rad/s]."""
    modes = lowest_modes(built.plan.structure.K, built.plan.structure.M, 4)
    moved = np.abs(_middle(built) @ modes.shapes)
    return float(modes.angular_frequencies[np.argmax(moved)])


def _middle(built: BuiltCase) -> FloatArray:
    """Weights of the free d.o.f. under a wheel at mid-span."""
    system, line = built.crossing.structure.system, built.crossing.structure.line()
    return np.asarray(line.rows(np.array([0.5 * LENGTH]), system.size)[:, system.free].toarray()[0])


def _frequency_row(built: BuiltCase, tolerance: float) -> Row:
    beam = (LENGTH, BENDING_STIFFNESS, _SHEAR_STIFFNESS, MASS_PER_LENGTH, _ROTARY)
    exact = float(timoshenko_frequencies(*beam, 1)[0])
    return value("first bending frequency", "rad/s", exact, _first_bending(built), tolerance, _THICK)


@case("coarse-solids", "A coarse beam of solid elements", "beam theory; example solid-beam-coarse")
def coarse_beam() -> list[Row]:
    """N12's beam as 50 x 2 x 4 hexahedra with incompatible modes, pinned along the mid-height lines of its ends.

    A wheel in a point dents the top by some percent of the deflection, which grows as elements get smaller: the
    deflection under it is compared with that in mind.
    """
    built = _shipped("solid-beam-coarse")
    row = _middle(built)
    deflection = 1e9 * float(row @ factorize(built.plan.structure.K).solve(row.copy()))
    exact = 1e9 * (LENGTH**3 / (48.0 * BENDING_STIFFNESS) + LENGTH / (4.0 * _SHEAR_STIFFNESS))
    return [
        _frequency_row(built, 3e-3),
        value(
            "deflection under a unit load", "mm/MN", exact, deflection, 0.06, f"{_THICK}, without the dent"
        ),
    ]


@case(
    "neves-3.2-solid",
    "Fifty sprung masses on 10 000 solids",
    f"{_N12}, example 3.2, figures 12 and 13",
    long=True,
)
def example_32_solid() -> list[Row]:
    """N12's solid mesh, 36 597 free d.o.f., full integration, 14 000 steps of 1 ms.

    The mesh is softer than the thin beam of the semi-analytical solution: by shear (3 % of the mid-span deflection) and by
    the dent under a wheel that stands on a point (5 % at mid-span, more at the ends). Led along the mid-height, where there
    is hardly a dent, the first mass follows a thick beam within 0.3 % of its peak; on top, as here, within 1.6 %, the last
    mass within 1.8 %.
    """
    built = _shipped("neves2012-3.2-solid")
    rows = [
        value("free d.o.f.", "", 36_597, built.plan.structure.size, 0.0, "N12"),
        _frequency_row(built, 3e-3),
    ]
    result = run_plan(built.plan)
    thin = np.asarray(mass_train().body_displacement[:, [0, 49]], dtype=np.float64)
    rows += _mass_rows(result, thin, "thin", 0.045, "N12 (38) to (42), 20 modes")
    return rows + _mass_rows(result, _thick_beam(built), "thick", 0.025, f"{_THICK}, 50 elements")


def _thick_beam(built: BuiltCase) -> FloatArray:
    """Displacements (14 001, 2) of the first and the last mass over beam elements with shear deformation [m]."""
    area = _WIDTH * _DEPTH
    beam = asp.bridges.simple_span(
        length=LENGTH,
        youngs_modulus=YOUNGS_MODULUS,
        second_moment=SECOND_MOMENT,
        mass_per_length=MASS_PER_LENGTH,
        elements=50,
        area=area,
        shear_area=5.0 / 6.0 * area,
        poisson_ratio=_POISSON_RATIO,
    )
    settings = built.plan.settings
    crossing = replace(built.crossing, structure=beam)
    result = asp.simulate(
        crossing, time_step=settings.time_step, steps=settings.steps, method=settings.method
    )
    names = ("1.body.z", "50.body.z")
    return np.column_stack([result.at("vehicle_displacement", name) for name in names])


def _mass_rows(
    result: asp.Result, expected: FloatArray, beam: str, tolerance: float, origin: str
) -> list[Row]:
    """First mass until 3 s, last mass from 11 s, as in N12's figures; expected (n_time, 2) [m]."""
    rows = []
    windows = (("first", 1, slice(0, 3001)), ("last", 50, slice(11_000, 14_001)))
    for column, (who, vehicle, window) in enumerate(windows):
        obtained = 1e3 * result.at("vehicle_displacement", f"{vehicle}.body.z")[window]
        theirs = 1e3 * expected[window, column]
        name, time = f"{who} mass, {beam} beam", result.time[window]
        rows.append(history(name, "mm", time, theirs, obtained, tolerance, origin))
        peak = float(np.abs(theirs).max())
        for end, find in (("lowest", np.min), ("highest", np.max)):
            pair = float(find(theirs)), float(find(obtained))
            rows.append(value(f"{name}, {end}", "mm", *pair, 0.02, origin, scale=peak, of="peak"))
    return rows


CASES = (coarse_beam, example_32_solid)

"""Load trains at their resonance speeds, and the speeds at which a load leaves a span at rest."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

import axlespan as asp
from axlespan.reference import Motion, SimplySupportedBeam, cross_forces
from axlespan.vehicles import load_trains
from axlespan.verification.case import Row, case, history, value

_FRYBA = (
    "L. Frýba, A rough assessment of railway bridges for high speed trains, Eng. Struct. 23 (2001) 548-556"
)
_RATIO = 0.005

# A span that is not 1.5 coaches of 18 m long, where resonance and cancellation would meet
_BEAM = SimplySupportedBeam(length=15.0, bending_stiffness=34e9 * 0.45, mass_per_length=12e3)
_MIDDLE = {"midspan": 7.5}


def _bridge() -> asp.Structure:
    return asp.bridges.simple_span(
        length=_BEAM.length,
        youngs_modulus=34e9,
        second_moment=0.45,
        mass_per_length=_BEAM.mass_per_length,
        elements=20,
        damping=asp.Modal(_RATIO),
    )


def _peaked(speeds: npt.NDArray[np.float64], answers: npt.NDArray[np.float64]) -> float:
    """The speed of the largest answer, by the parabola through it and its neighbors."""
    i = int(np.clip(answers.argmax(), 1, len(speeds) - 2))
    left, top, right = answers[i - 1 : i + 2]
    return float(speeds[i] + 0.5 * (speeds[1] - speeds[0]) * (left - right) / (left - 2.0 * top + right))


@case("hslm-resonance", "HSLM-A1 at its resonance speeds", _FRYBA)
def hslm_resonance() -> list[Row]:
    """Coaches of d = 18 m over a span of 15 m: the largest deflection over speed peaks at v = f1 d / i.

    Seven speeds within 2.4 % of each, in one go; 0.5 % damping, 20 elements, steps of 1 ms. What the span does at
    the deepest of them is held against the closed form.
    """
    structure, train = _bridge(), load_trains.hslm_a(1)
    frequency = float(_BEAM.angular_frequencies(1)[0]) / (2.0 * np.pi)
    rows = []
    for i in (1, 2):
        speeds = frequency * 18.0 / i * np.linspace(0.976, 1.024, 7)
        steps = [int(np.ceil((train.wheelbase + _BEAM.length) / v / 1e-3)) for v in speeds]
        results = asp.simulate_many(
            [asp.Crossing(structure, train, speed=float(v)) for v in speeds],
            time_step=1e-3,
            steps=steps,
            sensors=_MIDDLE,
        )
        depth = np.array([-result.sensor_displacement.min() for result in results])
        theory = frequency * 18.0 / i
        rows.append(
            value(f"resonance speed, i = {i}", "m/s", theory, _peaked(speeds, depth), 5e-3, "v = f1 d / i")
        )
        top = results[int(depth.argmax())]
        motion = Motion(float(speeds[depth.argmax()]), tuple(train.offsets.tolist()))
        exact = cross_forces(
            _BEAM, train.static_forces().tolist(), motion, top.time[::10], modal_damping=_RATIO
        )
        rows.append(
            history(
                f"mid-span at the peak, i = {i}",
                "mm",
                top.time[::10],
                1e3 * exact.displacement_at(7.5),
                1e3 * top.sensor_displacement[::10, 0],
                2e-2,  # steps make the period 2e-4 longer, and resonance counts forty of them
                "closed form, 51 modes",
            )
        )
    return rows


@case("cancellation", "The speeds at which a load leaves a span at rest", _FRYBA)
def cancellation() -> list[Row]:
    """One force at some speeds near v = 2 f1 L / (2 i + 1): what vibration it leaves, and where that is least.

    The first mode alone, from mid-span displacement and velocity after the exit; no damping, 20 elements, steps of
    0.2 ms.
    """
    structure = asp.bridges.simple_span(
        length=_BEAM.length,
        youngs_modulus=34e9,
        second_moment=0.45,
        mass_per_length=_BEAM.mass_per_length,
        elements=20,
    )
    train = asp.Train.of(asp.vehicles.axle_loads(loads=200e3))
    omega = float(_BEAM.angular_frequencies(1)[0])
    wave = np.pi * np.arange(1, 20) / 20.0
    sensors = {f"s{k}": _BEAM.length * (k + 1) / 20.0 for k in range(19)}
    rows = []
    for i in (1, 2):
        theory = omega / np.pi * _BEAM.length / (2 * i + 1)
        speeds = theory * np.array([0.96, 0.97, 0.98, 1.02, 1.03, 1.04])
        steps = [int(np.ceil(_BEAM.length / v / 2e-4)) + 1 for v in speeds]
        results = asp.simulate_many(
            [asp.Crossing(structure, train, speed=float(v)) for v in speeds],
            time_step=2e-4,
            steps=steps,
            sensors=sensors,
        )
        # amplitude of the first mode left behind, with the sign that it changes at the cancellation speed
        left = []
        for v, result in zip(speeds, results, strict=True):
            q = 0.1 * np.sin(wave) @ result.sensor_displacement[-1]
            rate = 0.1 * np.sin(wave) @ result.sensor_velocity[-1]
            left.append(np.sign(v - theory) * np.hypot(q, rate / omega))
        least = float(np.roots(np.polyfit(speeds / theory - 1.0, left, 2))[-1].real) * theory + theory
        rows.append(
            value(f"cancellation speed, i = {i}", "m/s", theory, least, 2e-3, "v = 2 f1 L / (2 i + 1)")
        )
    return rows


CASES = (hslm_resonance, cancellation)

"""Supports: settlements, moving ground, reactions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import axlespan as asp
from axlespan.bridges import SupportAt
from axlespan.model.motions import Constant, FunctionMotion, HarmonicMotion
from axlespan.model.motions import Motion as SupportMotion
from axlespan.reference import Motion, cross_forces
from axlespan.reference.neves2012 import BEAM
from axlespan.verification.case import FloatArray, Row, case, history, value
from axlespan.verification.models import BENDING_STIFFNESS, LENGTH, MASS_PER_LENGTH, axle, beam

_CLOUGH = "R.W. Clough, J. Penzien, Dynamics of Structures, 2nd ed. (1993), support excitation"
_HETENYI = "M. Hetényi, Beams on Elastic Foundation (1946); L. Frýba (1999)3: moving force"
_LOAD = 1e5  # [N]


@case("settlement", "The middle support of two spans settles under a force", "beam theory: superposition")
def settlement() -> list[Row]:
    """The middle support goes down by 10 mm while 100 kN stand in the middle of the first span."""
    drop = -10e-3
    supports = [
        SupportAt(0.0, name="first"),
        SupportAt(LENGTH, (), motion={"z": Constant(drop)}, name="middle"),
        SupportAt(2.0 * LENGTH, name="last"),
    ]
    crossing = asp.Crossing(beam(20, spans=2, supports=supports), axle(_LOAD), speed=0.0, start=0.5 * LENGTH)
    sensors = {"midspan 1": 0.5 * LENGTH, "middle": LENGTH}
    result = asp.simulate(crossing, time_step=1e-3, steps=10, sensors=sensors)
    # a beam over 2 L, pulled down amid by F = 48 EI drop / (2 L)^3
    pull = 6.0 * BENDING_STIFFNESS * drop / LENGTH**3
    expected = (-0.5 * pull + 13 / 32 * _LOAD, pull + 22 / 32 * _LOAD, -0.5 * pull - 3 / 32 * _LOAD)
    names = ("first", "middle", "last")
    rows = [
        value(
            f"reaction, {name}",
            "kN",
            1e-3 * force,
            1e-3 * result.at("support_reaction", f"{name}.z")[-1],
            1e-8,
            "superposition",
            scale=1e-3 * _LOAD,
            of="force",
        )
        for name, force in zip(names, expected, strict=True)
    ]
    sag = 11 / 16 * drop - 23 / 1536 * _LOAD * LENGTH**3 / BENDING_STIFFNESS
    deflections = {"midspan 1": sag, "middle": drop}
    return rows + [
        value(
            f"displacement, {name}",
            "mm",
            1e3 * w,
            1e3 * result.at("sensor_displacement", name)[-1],
            1e-8,
            "superposition",
        )
        for name, w in deflections.items()
    ]


@case("moving-ground", "Both supports of a simple span move", _CLOUGH)
def moving_ground() -> list[Row]:
    """The ground moves by A cos Ωt from rest (2 mm, 2 Hz): displacements.

    Reactions come from a ground that starts smoothly, A sin^3 Ωt: a sudden start shakes all modes, and theirs in the
    reactions would be undamped noise. 50 elements, steps of 0.1 ms.
    """
    amplitude, omega = 2e-3, 4.0 * np.pi
    result = _shaken(HarmonicMotion(amplitude, 2.0, 0.5 * np.pi))
    exact = ShakenSpan(result.time, ((amplitude, omega, 0.5 * np.pi),))
    rows = [
        history(
            f"cosine: displacement, {name}",
            "mm",
            result.time,
            1e3 * exact.displacement(x),
            1e3 * result.at("sensor_displacement", name),
            1e-4,
            "modes in closed form",
        )
        for name, x in (("midspan", 0.5 * LENGTH), ("quarter", 0.25 * LENGTH))
    ]
    result = _shaken(_sine_cubed(amplitude, omega))
    exact = ShakenSpan(result.time, ((0.75 * amplitude, omega, 0.0), (-0.25 * amplitude, 3.0 * omega, 0.0)))
    return [
        *rows,
        history(
            "sine cubed: displacement, midspan",
            "mm",
            result.time,
            1e3 * exact.displacement(0.5 * LENGTH),
            1e3 * result.at("sensor_displacement", "midspan"),
            1e-4,
            "modes in closed form",
        ),
        history(
            "sine cubed: reaction",
            "kN",
            result.time,
            1e-3 * exact.reaction(),
            1e-3 * result.at("support_reaction", "left.z"),
            1e-3,
            "modes in closed form",
        ),
    ]


def _shaken(motion: SupportMotion) -> asp.Result:
    """One second of ground motion; a force of next to nothing comes to the beam at its end."""
    supports = [
        SupportAt(0.0, (), motion={"z": motion}, name="left"),
        SupportAt(LENGTH, (), motion={"z": motion}, name="right"),
    ]
    crossing = asp.Crossing(beam(supports=supports), axle(1e-6), speed=20.0, start=-20.0)
    sensors = {"midspan": 0.5 * LENGTH, "quarter": 0.25 * LENGTH}
    return asp.simulate(crossing, time_step=1e-4, steps=10_000, sensors=sensors)


def _sine_cubed(amplitude: float, omega: float) -> FunctionMotion:
    def displacement(t: FloatArray) -> FloatArray:
        return np.asarray(amplitude * np.sin(omega * t) ** 3)

    def rate(t: FloatArray) -> FloatArray:
        return np.asarray(3.0 * amplitude * omega * np.sin(omega * t) ** 2 * np.cos(omega * t))

    def second_rate(t: FloatArray) -> FloatArray:
        s, c = np.sin(omega * t), np.cos(omega * t)
        return np.asarray(3.0 * amplitude * omega**2 * s * (2.0 * c**2 - s**2))

    return FunctionMotion(displacement, rate, second_rate)


@dataclass(frozen=True)
class ShakenSpan:
    """A simple span over ground that moves as u = Σ A sin(Ω t + φ): w = u + Σ φ_n q_n, 200 modes.

    ``q_n'' + ω_n² q_n = -Γ_n u''`` with ``Γ_n = 4 / nπ`` for odd n, 0 for even n; all at rest relative to the ground
    at t = 0.
    """

    time: FloatArray  # (n_time,) [s]
    harmonics: tuple[tuple[float, float, float], ...]  # A [m], Ω [rad/s], φ [rad]

    @property
    def numbers(self) -> FloatArray:
        """Numbers n (n_mode,) of the modes that take part."""
        return np.arange(1.0, 400.0, 2.0)

    def ground(self, derivative: int = 0) -> FloatArray:
        """The motion u (n_time,) of the ground, or a time derivative of it."""
        turn = 0.5 * np.pi * derivative
        terms = [a * w**derivative * np.sin(w * self.time + p + turn) for a, w, p in self.harmonics]
        return np.asarray(np.sum(terms, axis=0))

    def modal(self) -> tuple[FloatArray, FloatArray]:
        """Coordinates q and their accelerations, both (n_time, n_mode)."""
        t, w = self.time[:, np.newaxis], BEAM.angular_frequencies(399)[::2]
        q, rate2 = np.zeros((2, len(t), len(w)))
        for amplitude, omega, phase in self.harmonics:
            factor = 4.0 / (np.pi * self.numbers) * amplitude * omega**2 / (w**2 - omega**2)
            forced = np.sin(omega * t + phase)
            free = np.sin(phase) * np.cos(w * t) + np.cos(phase) * omega / w * np.sin(w * t)
            q += factor * (forced - free)
            rate2 += factor * (w**2 * free - omega**2 * forced)
        return q, rate2

    def displacement(self, x: float) -> FloatArray:
        """At a point [m], (n_time,) [m]."""
        return np.asarray(self.ground() + self.modal()[0] @ np.sin(self.numbers * np.pi * x / LENGTH))

    def reaction(self) -> FloatArray:
        """Of either support, (n_time,) [N]: half the inertia of the beam."""
        inertia = LENGTH * self.ground(2) + self.modal()[1] @ (2.0 * LENGTH / (np.pi * self.numbers))
        return np.asarray(0.5 * MASS_PER_LENGTH * inertia)


@case("reactions", "Reactions balance wheels, inertia and damping", "statics; Frýba (1999)")
def reactions() -> list[Row]:
    """A force stands at 0.3 of the span; then it crosses at 100 km/h with 5 % damping in every mode.

    In the crossing both reactions together are the force and the inertia of 99 modes, from 50 ms after the entry
    until the exit: the entry shakes modes that no time step resolves. 50 elements, steps of 0.1 ms.
    """
    standing = asp.Crossing(beam(), axle(_LOAD), speed=0.0, start=0.3 * LENGTH)
    result = asp.simulate(standing, time_step=1e-3, steps=1)
    rows = [
        value(
            f"standing: reaction {side} / P",
            "-",
            share,
            result.at("support_reaction", f"{side}.z")[0] / _LOAD,
            1e-9,
            "lever",
            scale=1.0,
            of="force",
        )
        for side, share in (("left", 0.7), ("right", 0.3))
    ]
    ratio, speed = 0.05, 100.0 / 3.6
    crossing = asp.Crossing(beam(damping=asp.Modal(ratio)), axle(_LOAD), speed=speed)
    result = asp.simulate(crossing, time_step=1e-4, steps=9500)
    exact = cross_forces(BEAM, [_LOAD], Motion(speed), result.time, modes=99, modal_damping=ratio)
    odd = np.arange(1, 100, 2)
    omega = BEAM.angular_frequencies(99)[::2]
    rates = exact.modal_acceleration[:, ::2] + 2.0 * ratio * omega * exact.modal_velocity[:, ::2]
    total = _LOAD + MASS_PER_LENGTH * rates @ (2.0 * LENGTH / (np.pi * odd))
    window = np.flatnonzero((result.time > 0.05) & (result.time < LENGTH / speed - 1e-6))
    residual = float(result.checks["equilibrium_residual"])
    return [
        *rows,
        history(
            "crossing: sum of reactions / P",
            "-",
            result.time[window],
            total[window] / _LOAD,
            result.support_reaction.sum(axis=1)[window] / _LOAD,
            1e-3,
            "modes in closed form",
            scale=1.0,
            of="force",
        ),
        value("crossing: imbalance, own check", "-", 0.0, residual, 1e-8, "statics", scale=1.0, of="forces"),
    ]


CASES = (settlement, moving_ground, reactions)

"""Vehicles of any number of bodies on a simply supported beam: modes and vehicles in one dense system."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg import block_diag

from ._inputs import STANDARD_GRAVITY, FloatArray, damping_ratios, increasing_times, require_same_length
from .beam_modes import ModalResponse, SimplySupportedBeam
from .collocation import GaussRule
from .linear_march import LinearMarch
from .motion import Motion
from .plain_vehicles import PlainVehicle
from .profiles import Profile, level
from .wheel_path import WheelPath
from .wheel_unit import UnitTable

_RUN = 100  # intervals between breaks that are computed at once


@dataclass(frozen=True)
class PlainResponse:
    """A crossing; all motions upward positive and from the static position on level ground."""

    time: FloatArray  # (time,) [s]
    beam: ModalResponse
    displacement: FloatArray  # of all vehicles' d.o.f. that are no wheels (time, d.o.f.) [m, rad]
    acceleration: FloatArray  # (time, d.o.f.)
    wheel_displacement: FloatArray  # (time, wheel) [m]
    contact_force: FloatArray  # (time, wheel), compression positive [N]


def cross_plain_vehicles(
    beam: SimplySupportedBeam,
    vehicles: Sequence[PlainVehicle],
    motion: Motion,
    time: npt.ArrayLike,
    *,
    modes: int = 20,
    profile: Profile | None = None,
    modal_damping: float | Sequence[float] = 0.0,
    gravity: float = STANDARD_GRAVITY,
    max_step: float = 1e-3,
    stages: int = 3,
) -> PlainResponse:
    """Return the crossing of vehicles whose wheels follow beam and irregularity: theory, (R32) to (R35).

    Parameters
    ----------
    motion : Motion
        One offset per wheel, vehicle by vehicle. No wheel stands on the beam at t = 0.
    time : array_like
        Increasing times from zero or later, (time,) [s].
    modes, profile, modal_damping, gravity, max_step, stages
        As in `cross_wheel_units`.
    """
    times = increasing_times(time)
    motion.require_forward(float(times[-1]))
    model = _Coupled.of(beam, vehicles, motion, profile or level(), modes, modal_damping, gravity)
    marching = LinearMarch(model.equations, GaussRule.with_stages(stages))
    events = model.path.event_times(float(times[-1]))
    breaks = np.unique(np.concatenate(([0.0], times, events)))
    # breaks that differ by rounding only are one
    breaks = breaks[np.diff(breaks, prepend=-1.0) > 1e-9 * max_step]
    x, v = model.start()
    record = np.zeros((times.size, 2, x.size))
    output = np.searchsorted(breaks, times - 1e-9 * max_step)
    for begin, step, count in _runs(breaks, events, max_step):
        if np.any(np.abs(events - begin) < 1e-9 * max_step):
            v = model.passed(x, v, begin)
        elif begin == 0.0 and times[0] == 0.0:
            record[0] = x, v
        states = marching.advance(x, v, begin + step * np.arange(count), step)
        x, v = states[-1]
        ends = np.searchsorted(breaks, begin + step * np.arange(1, count + 1) - 1e-9 * max_step)
        met = np.abs(breaks[ends] - begin - step * np.arange(1, count + 1)) < 1e-9 * max_step
        for i in np.flatnonzero(met & np.isin(ends, output)):
            record[np.searchsorted(output, ends[i])] = states[i]
    return model.response(times, record)


def _runs(breaks: FloatArray, events: FloatArray, max_step: float) -> Iterator[tuple[float, float, int]]:
    """Yield start [s], length [s] and number of equal steps, in runs that begin at events."""
    pieces = np.ceil(np.diff(breaks) / max_step * (1.0 - 1e-9)).astype(int)
    length = np.diff(breaks) / pieces
    passed = np.searchsorted(events, breaks[:-1] + 1e-9 * max_step)
    first = 0
    while first < length.size:
        same = np.abs(length[first:] - length[first]) < 1e-9 * length[first]
        same &= passed[first:] == passed[first]
        last = first + (same.size if same.all() else int(np.argmin(same)))
        last = min(last, first + _RUN)
        yield float(breaks[first]), float(length[first]), int(pieces[first:last].sum())
        first = last


@dataclass(frozen=True)
class _Coupled:
    """Modes q and free d.o.f. f of all vehicles, x = (q, f), and wheels that follow the path."""

    path: WheelPath
    ratios: FloatArray  # (mode,)
    mass: FloatArray  # of the vehicles, (f + wheel, f + wheel)
    damping: FloatArray
    stiffness: FloatArray
    static: FloatArray  # contact forces at rest (wheel,) [N]

    @classmethod
    def of(
        cls,
        beam: SimplySupportedBeam,
        vehicles: Sequence[PlainVehicle],
        motion: Motion,
        profile: Profile,
        modes: int,
        modal_damping: float | Sequence[float],
        gravity: float,
    ) -> _Coupled:
        total = sum(len(vehicle.names) for vehicle in vehicles)
        ends = np.cumsum([0, *(len(vehicle.names) for vehicle in vehicles)])
        wheel = np.zeros(total, dtype=bool)
        for vehicle, first in zip(vehicles, ends, strict=False):
            wheel[first + vehicle.free : first + len(vehicle.names)] = True
        order = np.argsort(wheel, kind="stable")  # wheels of all vehicles last
        m, c, k = (
            block_diag(*(getattr(vehicle, name) for vehicle in vehicles))[np.ix_(order, order)]
            for name in ("mass", "damping", "stiffness")
        )
        count = int(wheel.sum())
        require_same_length("motion.offsets", len(motion.offsets), count)
        none = np.zeros(count)
        dashpots = np.abs(c[-count:]).sum(axis=1)
        path = WheelPath(beam, modes, motion, profile, UnitTable(np.diag(m)[-count:], none, none, dashpots))
        static = np.concatenate([vehicle.static_loads(gravity) for vehicle in vehicles])
        return cls(path, damping_ratios(modal_damping, modes), m, c, k, static)

    @property
    def free(self) -> int:
        return len(self.mass) - self.static.size

    def follow(self, time: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """T of z = T x + r and its first two rates, each (time, f + wheel, mode + f)."""
        path, n = self.path, self.free
        phi, slope, curvature = path.shapes(path.motion.position(time))
        speed = path.motion.speed_at(time)[:, np.newaxis, np.newaxis]
        shape = (time.size, len(self.mass), path.modes + n)
        turn, rate, second = (np.zeros(shape) for _ in range(3))
        turn[:, :n, path.modes :] = np.eye(n)
        turn[:, n:, : path.modes] = phi
        rate[:, n:, : path.modes] = speed * slope
        second[:, n:, : path.modes] = speed**2 * curvature + path.motion.acceleration * slope
        return turn, rate, second

    def ground(self, time: FloatArray) -> FloatArray:
        """Irregularity under the wheels and its rates with zeros for the bodies, (time, 3, f + wheel)."""
        under = self.path.ground(time)
        return np.concatenate((np.zeros((time.size, 3, self.free)), under), axis=-1)

    def equations(self, time: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """(R34)."""
        path, modes = self.path, self.path.modes
        turn, rate, second = self.follow(time)
        back = np.swapaxes(turn, 1, 2)
        m, c, k = self.mass, self.damping, self.stiffness
        mass = back @ m @ turn
        damping = back @ (2.0 * m @ rate + c @ turn)
        stiffness = back @ (m @ second + c @ rate + k @ turn)
        omega, own = path.beam.angular_frequencies(modes), np.arange(modes)
        mass[:, own, own] += path.beam.modal_mass
        damping[:, own, own] += path.beam.modal_mass * 2.0 * self.ratios * omega
        stiffness[:, own, own] += path.beam.modal_mass * omega**2
        r = self.ground(time)
        inner = r[:, 2] @ m.T + r[:, 1] @ c.T + r[:, 0] @ k.T
        inner[:, self.free :] += self.static
        return mass, damping, stiffness, -np.matmul(back, inner[..., np.newaxis])[..., 0]

    def start(self) -> tuple[FloatArray, FloatArray]:
        """Static equilibrium on the irregularity, bodies without velocity, the beam at rest."""
        n = self.free
        x = np.zeros(self.path.modes + n)
        r = self.ground(np.zeros(1))[0, 0, n:]
        x[self.path.modes :] = np.linalg.solve(self.stiffness[:n, :n], -self.stiffness[:n, n:] @ r)
        return x, np.zeros_like(x)

    def passed(self, x: FloatArray, v: FloatArray, time: float) -> FloatArray:
        """Velocities after wheels with mass turned into new directions: momenta stay, as in (R18)."""
        if not np.any(np.diag(self.mass)[self.free :]):
            return v
        aside = 1e-7 / float(self.path.motion.speed_at(time))
        before, after = np.array([time - aside]), np.array([time + aside])
        turn = self.follow(np.array([time]))[0][0]
        on = self.path.on_beam(self.path.motion.position(time - aside))
        on = on * self.path.on_beam(self.path.motion.position(time + aside))
        turn[self.free :] *= on[:, np.newaxis]  # the support takes what happens at it
        jump = (self.follow(after)[1] - self.follow(before)[1])[0] @ x
        jump += self.ground(after)[0, 1] - self.ground(before)[0, 1]
        mass = turn.T @ self.mass @ turn
        own = np.arange(self.path.modes)
        mass[own, own] += self.path.beam.modal_mass
        velocity: FloatArray = v - np.linalg.solve(mass, turn.T @ self.mass @ jump)
        return velocity

    def response(self, time: FloatArray, record: FloatArray) -> PlainResponse:
        """Accelerations and contact forces that go with the states (time, 2, mode + f)."""
        x, v = record[:, 0], record[:, 1]
        n, modes = self.free, self.path.modes
        a, z = np.zeros_like(x), np.zeros((3, time.size, len(self.mass)))
        for first in range(0, time.size, 500):
            rows = slice(first, first + 500)
            mass, damping, stiffness, load = self.equations(time[rows])
            rest = load - np.einsum("tij,tj->ti", damping, v[rows])
            rest -= np.einsum("tij,tj->ti", stiffness, x[rows])
            a[rows] = np.linalg.solve(mass, rest[..., np.newaxis])[..., 0]
            turn, rate, second = self.follow(time[rows])
            r = self.ground(time[rows])

            def along(parts: FloatArray, what: FloatArray) -> FloatArray:
                total: FloatArray = np.einsum("tij,tj->ti", parts, what)
                return total

            z[0, rows] = along(turn, x[rows]) + r[:, 0]
            z[1, rows] = along(turn, v[rows]) + along(rate, x[rows]) + r[:, 1]
            z[2, rows] = along(turn, a[rows]) + 2.0 * along(rate, v[rows]) + along(second, x[rows]) + r[:, 2]
        inner = z[2] @ self.mass.T + z[1] @ self.damping.T + z[0] @ self.stiffness.T
        return PlainResponse(
            time,
            ModalResponse(self.path.beam, time, x[:, :modes], v[:, :modes], a[:, :modes]),
            x[:, modes:],
            a[:, modes:],
            z[0, :, n:],
            inner[:, n:] + self.static,
        )

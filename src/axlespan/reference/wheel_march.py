"""The time march of wheels on the beam: predict the stages, solve for the contact forces, correct."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ._inputs import FloatArray, IntArray
from .collocation import GaussRule, OscillatorStages
from .responses import Impact
from .wheel_path import States, WheelPath


@dataclass(frozen=True)
class Block:
    """Steps of equal length between two events: the same wheels are on the beam all along."""

    start: FloatArray  # (step,) [s]
    step: float  # [s]
    output: list[int]  # (step,) which of the times asked for ends the step, -1 where none does


def march(
    path: WheelPath, time: FloatArray, ratios: FloatArray, gravity: float, max_step: float, stages: int
) -> States:
    """Return the states at ``time`` of vehicles in equilibrium at t = 0: theory, (R14) to (R18)."""
    rule = GaussRule.with_stages(stages)
    modal: FloatArray = np.zeros((2, path.modes))
    body: FloatArray = np.zeros((2, path.units.mass.size))
    body[0] = path.ground(np.zeros(1))[0, 0] * (path.units.body_mass > 0.0)
    modal_record = np.zeros((time.size, *modal.shape))
    body_record = np.zeros((time.size, *body.shape))
    body_record[0] = body  # holds when the first time is zero, overwritten otherwise
    events = _events(path, time, max_step)
    impacts: list[Impact] = []
    for block in _blocks(path, time, events, max_step):
        if block.start[0] in events:
            modal, passed = pass_event(path, float(block.start[0]), modal)
            impacts.extend(passed)
        operators = StepOperators.of(path, block, rule, ratios, gravity)
        for k, output in enumerate(block.output):
            modal, body = operators.advance(k, modal, body)
            if output >= 0:
                modal_record[output], body_record[output] = modal, body
    return States(
        time, modal_record[:, 0], modal_record[:, 1], body_record[:, 0], body_record[:, 1], tuple(impacts)
    )


def _events(path: WheelPath, time: FloatArray, max_step: float) -> FloatArray:
    """Return the event times; one that misses an output time by rounding takes its value."""
    events = path.event_times(float(time[-1]))
    outputs = np.concatenate(([0.0], time))
    nearest = outputs[np.argmin(np.abs(events[:, np.newaxis] - outputs), axis=1)]
    events = np.unique(np.where(np.abs(nearest - events) < 1e-9 * max_step, nearest, events))
    apart = np.diff(events, prepend=0.0) > 1e-9 * max_step
    kept: FloatArray = events[apart & (events < time[-1])]
    return kept


def _blocks(path: WheelPath, time: FloatArray, events: FloatArray, max_step: float) -> Iterator[Block]:
    """Cut 0 to the last time at events and outputs, each piece into equal steps, and gather equal ones."""
    breaks = np.unique(np.concatenate(([0.0], time, events)))
    pieces = np.ceil(np.diff(breaks) / max_step * (1.0 - 1e-9)).astype(int)
    step = np.repeat(np.diff(breaks) / pieces, pieces)
    start: FloatArray = np.repeat(breaks[:-1], pieces) + step * _counted(pieces)
    output = np.full(start.size, -1)
    last = np.cumsum(pieces) - 1
    asked = np.isin(breaks[1:], time)
    output[last[asked]] = np.searchsorted(time, breaks[1:][asked])
    event = np.searchsorted(events, start + 0.5 * step)
    longest = max(1, min(512, 200_000 // (path.modes * (1 + path.units.mass.size))))
    first = 0
    while first < start.size:
        same = (event == event[first]) & (np.abs(step - step[first]) < 1e-9 * step[first])
        same[:first] = False
        run = np.argmin(same[first:]) if not same[first:].all() else start.size - first
        rows = slice(first, first + min(int(run), longest))
        yield Block(start[rows], float(step[first]), output[rows].tolist())
        first = rows.stop


def _counted(pieces: IntArray) -> IntArray:
    """0, 1, ..., n - 1 for every n in ``pieces``, one after another."""
    ends = np.cumsum(pieces)
    return np.arange(ends[-1] if ends.size else 0) - np.repeat(ends - pieces, pieces)


def pass_event(path: WheelPath, time: float, modal: FloatArray) -> tuple[FloatArray, list[Impact]]:
    """Return the modal state after a kink in the path of wheels with mass, and the impulses: theory, (R18).

    The momenta ``M_n q'_n + sum m phi_n y'`` of the beam and the wheels on it stay what they were while
    the wheels turn into their new directions. At the supports phi_n = 0: the beam gets nothing.
    """
    mass = path.units.wheel_mass
    position = path.motion.position(time)
    aside = 4e-9 * max(path.beam.length, 1.0)  # beyond the slack of supports and profiles
    places = np.array([0.0, path.beam.length, *path.profile.kinks])
    hit = (np.abs(position[:, np.newaxis] - places) < aside).any(axis=1) & (mass > 0.0)
    if not hit.any():
        return modal, []
    speed = path.motion.speed_at(time)
    before, after = path.on_beam(position - aside), path.on_beam(position + aside)
    bend = path.profile.derivative(1, position + aside) - path.profile.derivative(1, position - aside)
    phi, slope, _ = path.shapes(position)
    phi = phi * (before * after)[:, np.newaxis]
    turn: FloatArray = speed * np.where(hit, bend + (after - before) * (slope @ modal[0]), 0.0)
    inertia = path.beam.modal_mass * np.eye(path.modes) + (mass * phi.T) @ phi
    change = np.linalg.solve(inertia, -phi.T @ (mass * turn))
    impulse = mass * (turn + phi @ change)
    impacts = [Impact(time, int(i), float(impulse[i])) for i in np.flatnonzero(impulse)]
    return np.stack((modal[0], modal[1] + change)), impacts


@dataclass(frozen=True)
class StepOperators:
    """What the steps of one block need, computed for all of them at once."""

    rule: GaussRule
    step: float  # [s]
    modes: OscillatorStages
    bodies: OscillatorStages
    on: IntArray  # (wheel,) indices of the vehicles on the beam
    stiffness: FloatArray  # k / M (vehicle,) [1/s2]
    damping: FloatArray  # c / M (vehicle,) [1/s]
    wheel_mass: FloatArray  # (wheel,) [kg]
    body_mass: FloatArray  # (wheel,) [kg]
    weight: FloatArray  # (wheel,) [N]
    load: FloatArray  # modal load per contact force, -phi / M_n (step, stage, wheel, mode) [1/kg]
    follow: FloatArray  # wheel motion from modal motion (step, stage, 3 wheel, 3 mode)
    ground: FloatArray  # (step, stage, 3, vehicle)
    contact: FloatArray  # inverse of the contact system (step, stage wheel, stage wheel)

    @classmethod
    def of(
        cls, path: WheelPath, block: Block, rule: GaussRule, ratios: FloatArray, gravity: float
    ) -> StepOperators:
        """Return the operators of ``block``."""
        units, h = path.units, block.step
        omega = path.beam.angular_frequencies(path.modes)
        modes = OscillatorStages.over(h, rule, 2.0 * ratios * omega, omega**2)
        k, c = units.body_rate(units.stiffness), units.body_rate(units.damping)
        bodies = OscillatorStages.over(h, rule, c, k)
        middle = path.motion.position(float(block.start[0]) + 0.5 * h)
        on = np.flatnonzero(path.on_beam(middle))
        time = block.start[:, np.newaxis] + h * rule.nodes
        phi, follow = _following(path, time, on)
        load = -phi / path.beam.modal_mass
        mass = units.wheel_mass[on], units.body_mass[on]
        inertia = _inertia_of_contact(bodies, on, mass[0], mass[1], k[on], c[on])
        contact = _contact_inverse(modes, load, follow, inertia)
        weight = units.mass[on] * gravity
        ground = path.ground(time)
        return cls(rule, h, modes, bodies, on, k, c, *mass, weight, load, follow, ground, contact)

    def advance(self, k: int, modal: FloatArray, body: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the modal and body states (2, mode) and (2, vehicle) after step ``k`` of the block."""
        ground = self.ground[k].copy()
        stages = self.modes.free(modal[0], modal[1])
        body_free = self.bodies.free(body[0], body[1])
        if self.on.size:
            # contact forces of the free stages, then those that close the loop
            wheel = self._wheels(k, stages)
            force = self.weight + self.wheel_mass * wheel[:, 2]
            force += self.body_mass * self._body_stages(body_free, wheel)[:, 2]
            force = (self.contact[k] @ force.ravel()).reshape(force.shape)
            stages = stages + self.modes.forced(np.matmul(force[:, np.newaxis], self.load[k])[:, 0])
            ground[:, :, self.on] = self._wheels(k, stages)
        drive = self.stiffness * ground[:, 0] + self.damping * ground[:, 1]
        body_stages = body_free + self.bodies.forced(drive)
        return self._step(modal, stages[:, 2]), self._step(body, body_stages[:, 2])

    def _wheels(self, k: int, stages: FloatArray) -> FloatArray:
        """Wheel displacement, velocity and acceleration at the stages, (stage, 3, wheel)."""
        count = stages.shape[0]
        followed = np.matmul(self.follow[k], stages.reshape(count, -1, 1))
        wheels: FloatArray = followed.reshape(count, 3, self.on.size) + self.ground[k][:, :, self.on]
        return wheels

    def _body_stages(self, free: FloatArray, wheel: FloatArray) -> FloatArray:
        on = self.on
        drive = self.stiffness[on] * wheel[:, 0] + self.damping[on] * wheel[:, 1]
        answer = self.bodies.from_load[..., on] * drive[:, np.newaxis]
        stages: FloatArray = free[:, :, on] + answer.sum(axis=1)
        return stages

    def _step(self, state: FloatArray, accelerations: FloatArray) -> FloatArray:
        h, rule = self.step, self.rule
        displacement = state[0] + h * state[1] + h**2 * (rule.double_weights @ accelerations)
        return np.stack((displacement, state[1] + h * (rule.weights @ accelerations)))


def _following(path: WheelPath, time: FloatArray, on: IntArray) -> tuple[FloatArray, FloatArray]:
    """Modes under the wheels, and the matrix that turns modal into wheel motion: theory, (R10), (R11)."""
    phi, slope, curvature = path.shapes(path.motion.position(time)[..., on])
    speed = path.motion.speed_at(time)[..., np.newaxis, np.newaxis]
    none = np.zeros_like(phi)
    convective = speed**2 * curvature + path.motion.acceleration * slope
    rows = [
        np.concatenate((phi, none, none), axis=-1),
        np.concatenate((speed * slope, phi, none), axis=-1),
        np.concatenate((convective, 2.0 * speed * slope, phi), axis=-1),
    ]
    return phi, np.concatenate(rows, axis=-2)


def _inertia_of_contact(
    bodies: OscillatorStages,
    on: IntArray,
    wheel_mass: FloatArray,
    body_mass: FloatArray,
    stiffness: FloatArray,
    damping: FloatArray,
) -> FloatArray:
    """Contact forces per wheel motion, (stage, wheel, stage, 3): own inertia and what the body answers."""
    answer = body_mass * bodies.from_load[:, :, 2, on]  # (stage, stage, wheel)
    own = np.eye(answer.shape[0])[..., np.newaxis] * wheel_mass
    return np.stack((answer * stiffness, answer * damping, own), axis=-1).transpose(0, 2, 1, 3)


def _contact_inverse(
    modes: OscillatorStages, load: FloatArray, follow: FloatArray, inertia: FloatArray
) -> FloatArray:
    """Inverse of the system for the contact forces at all stages of a step: theory, (R16)."""
    steps, stages, wheels, modal = load.shape
    size = stages * wheels
    # wheel motions that unit contact forces cause: at stage i by a force at stage j
    forced = np.einsum("ijan,tjwn->tianjw", modes.from_load, load).reshape(steps, stages, 3 * modal, size)
    motion = np.matmul(follow, forced).reshape(steps, stages, 3, wheels, size)
    caused = np.einsum("iwja,tjawx->tiwx", inertia, motion).reshape(steps, size, size)
    return np.linalg.inv(np.eye(size) - caused)

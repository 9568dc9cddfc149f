"""Steps with laws of contact and nonlinear springs in the compiled loop, where structure, vehicles and laws allow it."""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from axlespan.compiled import Loop
from axlespan.interaction.contact_system import Stretch
from axlespan.interaction.convoy import Convoy
from axlespan.interaction.drive import Couple, Leaper
from axlespan.interaction.fused.march import FusedMarch
from axlespan.interaction.nonlinear.contact import NonlinearCoupling
from axlespan.interaction.nonlinear.interface_solver import LIMIT
from axlespan.interaction.nonlinear.law_codes import (
    COLUMN,
    DONE,
    LARGEST,
    SPRING_ROWS,
    VECTORS,
    WHEEL_ROWS,
    CodedSprings,
    CodedWheels,
)

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


@cache
def _march() -> Loop:
    from axlespan.interaction.nonlinear.march_kernel import march  # numba is an optional part

    return march


class NonlinearMarch(FusedMarch):
    """Consecutive steps of one crossing; those out of the ordinary are made by the coupling.

    These are steps in which a wheel lifts off a one-sided contact or lands on one, or in which Newton's method does not
    converge.
    """

    needs_systems = True
    damps_modes = False
    _coupling: NonlinearCoupling

    @classmethod
    def led_by(cls, coupling: NonlinearCoupling, couple: Couple) -> Leaper:
        """How to make many steps at once that a coupling would make one by one, by ``couple``."""

        def leap(convoy: Convoy) -> NonlinearMarch | None:
            field = coupling.field
            springs, wheels = CodedSprings.of(field.springs), CodedWheels.of(coupling.laws)
            if springs is None or wheels is None or field.n_fleet or len(convoy.lanes) > 1:
                return None
            made = cls.of(convoy)
            if made is not None:
                made._begin(coupling, couple, springs, wheels)
            return made

        return leap

    def _begin(
        self, coupling: NonlinearCoupling, couple: Couple, springs: CodedSprings, wheels: CodedWheels
    ) -> None:
        self._coupling, self._couple, convoy = coupling, couple, self._convoy
        (self._chunk,) = self._chunks
        field, self._wheel_laws = coupling.field, (wheels.kinds, wheels.numbers)
        body = convoy.prepared.banded
        assert body is not None
        self._columns = field.columns(convoy.structure)
        self._coded = (springs.kinds, springs.numbers, springs.points)
        self._at = body.rank[self._columns.dofs]
        self._slowest, self._vehicles = np.zeros(LIMIT), self._vehicle_blocks()
        self._work = _room(len(coupling.laws.rigid), field.n)
        self._follows = True  # whether the loop stands where the bodies stand, or is ahead of them
        self._columns.need(field.active)

    def _vehicle_blocks(self) -> tuple[IntArray, IntArray, FloatArray]:
        """Where wheels of each vehicle begin, and compliance of vehicles by themselves, one block after the other."""
        fleet = self._convoy.fleet
        if fleet is None:
            return np.zeros(1, dtype=np.int64), np.zeros(0, dtype=np.int64), np.zeros(0)
        owner, S = fleet.fleet.vehicle_of, fleet.compliance
        starts = np.append(np.searchsorted(owner, np.unique(owner)), len(owner)).astype(np.int64)
        blocks = [S[a:b][:, a:b].toarray() for a, b in pairwise(starts.tolist())]
        begin = np.cumsum([0, *(block.size for block in blocks)])[:-1].astype(np.int64)
        return starts, begin, np.concatenate([(0.5 * (block + block.T)).ravel() for block in blocks])

    # --- steps -----------------------------------------------------------------------------------

    def go(self, stretch: Stretch, first: int, stop: int, external: FloatArray | None) -> None:
        """Make steps ``first`` to ``stop`` of a stretch, and write them on the tape.

        Raises
        ------
        AnalysisError
            As the coupling.
        """
        if stretch is not self._stretch:
            self._enter(stretch)
        tape, k = self._convoy.tape, first
        while k < stop:
            if self._is_usual():
                before, (k, why, spring) = k, self._leap(stretch, k, stop, external)
                tape.filled = k
                if why == DONE:
                    return
                if k > before:
                    self.show(stretch, k - 1, states=True)
                if why == COLUMN:
                    self._columns.need(np.array([spring]))
                    continue
            self._make_one(stretch, k, None if external is None else external[k])
            k += 1

    def _is_usual(self) -> bool:
        """Whether the loop can go on from here: not too many springs deviate."""
        return len(self._coupling.field.active) <= LARGEST

    def _make_one(self, stretch: Stretch, k: int, external: FloatArray | None) -> None:
        """Have the coupling make a step, with the bodies of the convoy."""
        convoy = self._convoy
        forces = self._couple(convoy, stretch, k, external)
        convoy.tape.take(convoy.structure, convoy.fleet, forces)
        self._follows = False

    def _follow(self) -> None:
        """Let the loop stand where the bodies of the convoy stand."""
        convoy = self._convoy
        if not self._follows:
            self._chunk.take(convoy.structure)
            if convoy.fleet is not None:
                self._fleet[0][...] = convoy.fleet.forces
            self._follows = True
        self._chunk.carry(convoy.structure, self._numbers[3])

    def _enter(self, stretch: Stretch) -> None:
        """Lay out what the loop needs of a stretch."""
        convoy, chunk = self._convoy, self._chunk
        self._stretch = stretch
        convoy.tape.arrays[2][...] = convoy.joint.weight  # moving forces stay so
        chunk.prepare(stretch, 1)
        systems = [system for system in stretch.systems if system.matrices.size]
        contacts = systems[0].contacts if systems else np.empty(0, dtype=np.int64)
        matrices = systems[0].matrices.reshape(-1) if systems else np.empty(0)
        place, weights, into = (np.ascontiguousarray(part) for part in chunk.wheels)
        at = self._columns.place[np.minimum(stretch.flat, len(self._columns.place) - 1)]
        self._rows = (place, weights, into, at, np.searchsorted(contacts, into))
        self._system = (contacts, matrices)
        starts, begin, blocks = self._vehicles
        on_line = np.zeros(starts[-1], dtype=bool)
        on_line[contacts] = True
        rigid = self._coupling.laws.rigid
        apart = [
            i for i, (a, b) in enumerate(pairwise(starts.tolist())) if not (on_line[a] or rigid[a:b].all())
        ]
        self._apart = (np.array(apart, dtype=np.int64), starts, begin, blocks)

    def _leap(
        self, stretch: Stretch, first: int, stop: int, external: FloatArray | None
    ) -> tuple[int, int, int]:
        """Make steps in the compiled loop; the first one that is not made, why, and the spring whose column it needs."""
        convoy, chunk, coupling, field = self._convoy, self._chunk, self._coupling, self._coupling.field
        near, vehicles, forces, sums = convoy.tape.arrays
        columns = self._columns
        self._follow()
        forced = external is not None or bool(len(stretch.forced)) or self._numbers[3] != 0.0
        approaches = np.stack([coupling.approach, coupling.before, coupling.earlier])
        last, n_step = np.stack([field.q, field.e, field.rate]), stop - first
        counts, history = (
            np.zeros(n_step, dtype=np.int64),
            np.zeros((n_step if field.on_ground else 0, field.n)),
        )
        flown = np.zeros((2, n_step, approaches.shape[1]))
        most = np.array([len(coupling.residuals), field.largest])
        k, why, spring = _march()(
            (0,),
            (0,) * self._width,
            self._numbers,
            self._structure,
            chunk.arrays(forced),
            self._rows,
            chunk.known(convoy.joint.weight),
            (self._vectors, np.empty((stretch.n_step, 0)) if external is None else external),
            self._fleet_of(chunk, stretch),
            self._system,
            (near, self._watched, vehicles, forces, sums, self._sums, chunk.lane),
            (
                (*self._wheel_laws, approaches, coupling.time_step),
                coupling.touching,
                self._apart,
                coupling.scale,
            ),
            (self._coded, self._at, columns.weights, columns.values, columns.at, columns.slot),
            (last, counts, history, flown),
            (self._slowest, most),
            self._work,
            first,
            stop,
        )
        made = k - first
        if most[0] > len(coupling.residuals):
            coupling.residuals = self._slowest[: most[0]].tolist()
        if made:
            field.went(last, int(most[1]), history[:made])
            coupling.iterations.extend(counts[:made].tolist())
            self._tell(stretch, first, flown[:, :made], approaches)
        return k, why, spring

    def _tell(self, stretch: Stretch, first: int, flown: FloatArray, approaches: FloatArray) -> None:
        """Tell the coupling of the gaps of the free response and the approaches (2, n_step, n_coupled) of steps."""
        coupling, tape, n_step = self._coupling, self._convoy.tape, flown.shape[1]
        forces = tape.arrays[2][first : first + n_step][:, self._convoy.joint.coupled]
        if not coupling.flights.any_in_air and np.all(forces[:, coupling.laws.may_part] > 0.0):
            coupling.went(stretch.first + first + n_step - 1, approaches)
            return
        for j in range(n_step):
            tape.filled = first + j  # the steps before are good, whatever is found now
            coupling.flew(stretch.first + first + j, forces[j], flown[1, j], flown[0, j])

    def show(self, stretch: Stretch, k: int, *, states: bool) -> None:
        """Bring the bodies of the convoy to the step just made, unless they made it."""
        if not self._follows:
            return
        super().show(stretch, k, states=states)
        structure, inner = self._convoy.structure, self._coupling.field.force()
        if inner is not None:
            structure.carry(structure.load_of(0) - inner)


def _room(n_wheel: int, n_spring: int) -> tuple[Any, ...]:
    """Arrays that the loop works in: of wheels, of springs, and of an interface."""
    size = n_wheel + LARGEST
    springs = (np.zeros(n_spring, dtype=bool), np.arange(n_spring), np.zeros((SPRING_ROWS, n_spring)))
    names, vectors = np.zeros(size, dtype=np.int64), np.zeros((VECTORS, size))
    interface = (np.zeros((size, size)), np.zeros((size, size)), names, vectors, np.zeros(LIMIT))
    return np.zeros((WHEEL_ROWS, n_wheel)), springs, interface

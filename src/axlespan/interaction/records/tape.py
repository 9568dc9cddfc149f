"""What the time loop writes down at every step: plain copies into arrays made once for a stretch."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from axlespan.interaction.bodies import FleetBody, StructureBody
from axlespan.interaction.records.sums import Sums

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class LaneTape:
    """The tape of one crossing over consecutive steps."""

    near: FloatArray  # (3, n_step, n_selected) displacement, velocity, acceleration of selected d.o.f.
    vehicles: FloatArray  # (3, n_step, n_vehicle_dof)
    forces: FloatArray  # (n_step, n_contact) [N]
    sums: FloatArray  # (n_step, n_sum) weighted sums over the structure

    def upto(self, n_step: int) -> LaneTape:
        """The first steps only."""
        return LaneTape(
            self.near[:, :n_step], self.vehicles[:, :n_step], self.forces[:n_step], self.sums[:n_step]
        )


@dataclass(frozen=True, eq=False)
class Watched:
    """What of the structure is written down: d.o.f., and sums over all d.o.f."""

    dofs: IntArray  # (n_selected,) of all crossings together, sorted
    sums: Sums
    shapes: FloatArray | None = (
        None  # (n, m) all d.o.f. from m coordinates of the state; None: it holds the d.o.f.
    )
    reading: FloatArray | None = field(init=False)  # (n_selected, m)
    sums_reading: FloatArray | None = field(init=False)  # (n_sum, 3, m)

    def __post_init__(self) -> None:
        given = self.shapes
        object.__setattr__(self, "reading", None if given is None else given[self.dofs])
        through = None if given is None else self.sums.read_through(given)
        object.__setattr__(self, "sums_reading", through)


class Tape:
    """The tape of all crossings that advance side by side."""

    def __init__(self, watched: Watched, lanes: int, n_vehicle_dof: int, n_contact: int) -> None:
        self.watched, self._lanes = watched, lanes
        self._sizes = (n_vehicle_dof, n_contact)
        places = watched.dofs if watched.reading is None else np.arange(watched.reading.shape[1])
        self._flat = (
            places * lanes + np.arange(lanes)[:, None]
        ).ravel()  # what belongs to a lane in one piece
        self._n_step = 0

    def start(self, n_step: int) -> None:
        """Make room for a stretch."""
        self.filled = 0
        if n_step <= self._n_step:
            return
        self._n_step = n_step
        n_vehicle_dof, n_contact = self._sizes
        self._near = np.zeros((n_step, 3, len(self._flat)))
        self._vehicles = np.zeros((n_step, 3, n_vehicle_dof))
        self._forces = np.zeros((n_step, n_contact))
        # Times in one piece; an odd number of cache lines between two sums, so that they do not drive each other out.
        lines = (n_step // 8 + 1) | 1
        self._sums = np.zeros((self._lanes, self.watched.sums.count, 8 * lines))

    def take(self, structure: StructureBody, fleet: FleetBody | None, forces: FloatArray) -> None:
        """Write down the step just completed."""
        k = self.filled
        values = structure.state.values
        if len(self._flat):
            values.reshape(3, -1).take(self._flat, axis=1, out=self._near[k], mode="clip")
        if fleet is not None:
            self._vehicles[k] = fleet.state.values
        self._forces[k] = forces
        if self.watched.sums_reading is None:
            self._sums[:, :, k] = self.watched.sums.of(values).reshape(-1, self._lanes).T
        self.filled = k + 1

    @property
    def arrays(self) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """What is written for the stretch: d.o.f. lane after lane (n_step, 3, …), vehicles, forces, sums."""
        return self._near, self._vehicles, self._forces, self._sums

    def is_good(self, largest: float) -> bool:
        """Whether all that is written is finite, and no contact force is so large."""
        n = self.filled
        if not n:
            return True
        with np.errstate(
            all="ignore"
        ):  # what is not finite once stays so, and a sum is finite only if all in it is
            parts = (self._near[n - 1], self._vehicles[n - 1], self._sums[:, :, n - 1])
            if not all(bool(np.isfinite(part.sum())) for part in parts if part.size):
                return False
            forces = self._forces[:n]
            return bool(forces.max(initial=0.0) < largest and forces.min(initial=0.0) > -largest)

    def last_forces(self, contacts: slice) -> FloatArray:
        """Forces (n_contact,) of the last step."""
        return self._forces[self.filled - 1, contacts].copy()

    def of(self, lane: int, dofs: IntArray, vehicle_dofs: slice, contacts: slice, own: slice) -> LaneTape:
        """The tape of one crossing: some watched d.o.f. (n_selected,), its vehicles' d.o.f. and contacts, its own sums."""
        n = self.filled
        at, reading = np.searchsorted(self.watched.dofs, dofs), self.watched.reading
        width = len(self._flat) // self._lanes
        near = self._near[:n, :, lane * width : (lane + 1) * width]
        sums, weights = self._sums[lane, own, :n].T, self.watched.sums_reading
        if weights is not None:
            weights = weights[own]
            sums = near.reshape(n, 3 * width) @ weights.reshape(len(weights), 3 * width).T
        if reading is not None:
            near = near @ reading[at].T
        elif len(at) < width:
            near = near[:, :, at]
        return LaneTape(
            near.transpose(1, 0, 2),
            self._vehicles[:n, :, vehicle_dofs].transpose(1, 0, 2),
            self._forces[:n, contacts],
            sums,
        )

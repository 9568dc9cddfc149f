"""Contact rows: under each wheel and time, the weights E of the structure's d.o.f. and the gap r (N12 (27), (28))."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.contact.motion import Course
from axlespan.irregularity.profile import Profile, Smooth
from axlespan.running.path import PolynomialPath

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class WheelPath:
    """What one group of wheels runs on: a path split into free and prescribed d.o.f., and a profile."""

    wheels: IntArray  # (n_wheel,) positions among the contacts of the train
    free: PolynomialPath  # in the numbers of the structure's free d.o.f.
    prescribed: PolynomialPath | None  # in the numbers of the prescribed d.o.f. that move; None: none does
    profile: Profile


@dataclass(frozen=True, eq=False)
class RowBlock:
    """Rows for the wheels of one group at several times."""

    dofs: IntArray  # (n_time, n_wheel, n_local)
    weights: FloatArray  # (n_time, n_wheel, n_local); zero off the structure
    prescribed_dofs: IntArray  # (n_time, n_wheel, n_local_p)
    prescribed_weights: FloatArray  # (n_time, n_wheel, n_local_p)


@dataclass(frozen=True, eq=False)
class Wheels:
    """The wheels of one train: consecutive contacts that move as one."""

    course: Course
    offsets: FloatArray  # (n_wheel,) distances behind the head [m]

    def positions(self, time: FloatArray) -> FloatArray:
        """Positions (n_time, n_wheel) along the line [m]."""
        head = self.course.head(time)
        return np.asarray(head[:, None] - self.course.direction * self.offsets[None, :])


@dataclass(frozen=True, eq=False)
class TrainRows:
    """The contact rows of all trains of a crossing on their ways over a structure."""

    trains: Sequence[Wheels]  # their contacts are numbered on
    paths: Sequence[WheelPath]

    @property
    def n_contact(self) -> int:
        """Number of contacts."""
        return sum(len(train.offsets) for train in self.trains)

    def positions(self, time: FloatArray) -> FloatArray:
        """Positions (n_time, n_contact) of the wheels along their lines [m]."""
        if len(self.trains) == 1:
            return self.trains[0].positions(time)
        return np.concatenate([train.positions(time) for train in self.trains], axis=1)

    def n_entries(self, begin: float, end: float) -> int:
        """Entries of the rows of a step between two times: contacts that stand on the structure, and what they load."""
        ends, total = self.positions(np.array([begin, end])), 0
        low, high = ends.min(axis=0), ends.max(axis=0)
        for path in self.paths:
            there = (high[path.wheels] >= path.free.start) & (low[path.wheels] <= path.free.stop)
            total += int(np.count_nonzero(there)) * path.free.dofs.shape[1]
        return total

    def motion(self, time: float) -> tuple[FloatArray, FloatArray]:
        """Velocities (n_contact,) [m/s] and accelerations [m/s^2] of the wheels along their lines."""
        now = np.array([time])
        sizes = [len(train.offsets) for train in self.trains]
        velocity = [train.course.velocity(now)[0] for train in self.trains]
        acceleration = [train.course.acceleration(now)[0] for train in self.trains]
        return np.repeat(velocity, sizes), np.repeat(acceleration, sizes)

    def on_structure(self, positions: FloatArray) -> npt.NDArray[np.bool_]:
        """Which wheels (n_time, n_contact) touch the structure, their footprints included."""
        if len(self.paths) == 1:
            return self.paths[0].free.carries(positions)
        result = np.zeros(positions.shape, dtype=bool)
        for path in self.paths:
            result[:, path.wheels] = path.free.carries(positions[:, path.wheels])
        return result

    def irregularity(self, positions: FloatArray, derivative: int = 0) -> FloatArray:
        """R (n_time, n_contact) [m] under the wheels, or its derivatives along the line."""
        result = np.zeros(positions.shape)
        for path in self.paths:
            if isinstance(path.profile, Smooth):
                continue
            read = (path.profile.value, path.profile.slope, path.profile.curvature)[derivative]
            if len(path.wheels) == self.n_contact:
                return np.asarray(read(positions))
            result[:, path.wheels] = read(positions[:, path.wheels])
        return result

    def dofs_passed(self, ends: FloatArray, wheels: IntArray) -> list[IntArray]:
        """Free d.o.f. that some wheels load between two times, from their positions (2, n_contact), for each path."""
        result = []
        for path in self.paths:
            here = wheels[np.isin(wheels, path.wheels)]
            result.append(path.free.dofs_between(ends[:, here].min(axis=0), ends[:, here].max(axis=0)))
        return result

    def rows(self, positions: FloatArray, wheels: IntArray, derivative: int = 0) -> RowBlock:
        """Rows for some wheels, at their positions (n_time, n_wheel), or derivatives along the line."""
        n_local = max(path.free.dofs.shape[1] for path in self.paths)
        moving = [path.prescribed for path in self.paths if path.prescribed is not None]
        n_prescribed = max((path.dofs.shape[1] for path in moving), default=0)
        shape = positions.shape
        block = RowBlock(
            np.zeros((*shape, n_local), dtype=np.int64),
            np.zeros((*shape, n_local)),
            np.zeros((*shape, n_prescribed), dtype=np.int64),
            np.zeros((*shape, n_prescribed)),
        )
        for path in self.paths:
            one = len(self.paths) == 1
            here = np.arange(len(wheels)) if one else np.flatnonzero(np.isin(wheels, path.wheels))
            path.free.fill_rows(positions, here, here, block.dofs, block.weights, derivative)
            if path.prescribed is not None:
                path.prescribed.fill_rows(
                    positions, here, here, block.prescribed_dofs, block.prescribed_weights, derivative
                )
        return block

"""A System: matrices with named d.o.f., what is prescribed and what is applied; structure and vehicle alike."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.linalg.low_rank import LowRank
from axlespan.model.dofs import nearest
from axlespan.model.motions import Motion
from axlespan.model.nonlinear import SpringLaw

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Load:
    """Nodal loads vector · history(t)."""

    vector: FloatArray  # (n,) [N, N m]
    history: Callable[[FloatArray], FloatArray] | None = None  # factor [-] of time [s]; None: constant

    def factor(self, time: FloatArray) -> FloatArray:
        """The history's factor at times [s]."""
        if self.history is None:
            return np.ones(np.shape(time))
        return np.asarray(self.history(time), float)


@dataclass(frozen=True, eq=False)
class SpringRows:
    """Nonlinear springs of one law; their reference stiffness and damping are in the matrices of the system."""

    name: str
    law: SpringLaw
    rows: sp.csr_array  # (n_spring, n): elongations e = rows @ u [m]
    gap: FloatArray  # (n_spring,) added to the elongations [m]
    stiffness: float | FloatArray = 0.0  # reference, in the matrices; of all or of each [N/m]
    damping: float | FloatArray = 0.0  # [N s/m]


@dataclass(frozen=True, eq=False)
class Partition:
    """Blocks of a system's matrices: F free, P prescribed (N12, table 1)."""

    K_FF: sp.csr_array
    K_FP: sp.csr_array
    K_PP: sp.csr_array
    M_FF: sp.csr_array
    M_FP: sp.csr_array
    M_PP: sp.csr_array
    C_FF: sp.csr_array
    C_FP: sp.csr_array
    C_PP: sp.csr_array


@dataclass(frozen=True, eq=False)
class System:
    """M ü + C u̇ + K u = loads, over independent d.o.f., of which some are prescribed.

    The d.o.f. of the model are ``elimination @ u``: ties and rigid links are already eliminated.
    """

    stiffness: sp.csr_array  # (n, n) [N/m]
    mass: sp.csr_array  # (n, n) [kg]
    damping: sp.csr_array  # (n, n) [N s/m]
    dof_names: tuple[str, ...]  # of all d.o.f. of the model (n_full)
    elimination: sp.csr_array  # (n_full, n)
    prescribed: IntArray  # (n_P,) positions among the n
    support_names: tuple[str, ...] = ()  # (n_P,)
    motions: tuple[Motion, ...] = ()  # (n_P,)
    loads: tuple[Load, ...] = ()
    modal_damping: LowRank | None = None  # over the free d.o.f.
    independent: IntArray = field(default_factory=lambda: np.empty(0, dtype=np.int64))  # (n,) in dof_names
    components: tuple[str, ...] = ()  # (n_full,) x, y, …, rz; from the names when left out
    nonlinear: tuple[SpringRows, ...] = ()

    def __post_init__(self) -> None:
        if not self.components:
            parts = tuple(name.rsplit(".", 1)[-1] for name in self.dof_names)
            object.__setattr__(self, "components", parts)

    @property
    def size(self) -> int:
        """Number of independent d.o.f., free and prescribed."""
        return int(self.stiffness.shape[0])

    @cached_property
    def free(self) -> IntArray:
        """Positions (n_F,) of the free d.o.f. among the n."""
        mask = np.ones(self.size, dtype=bool)
        mask[self.prescribed] = False
        return np.flatnonzero(mask)

    @cached_property
    def partition(self) -> Partition:
        """Blocks F and P of the three matrices."""
        blocks = {}
        for letter, matrix in (("K", self.stiffness), ("M", self.mass), ("C", self.damping)):
            row = np.repeat(np.arange(self.size), np.diff(matrix.indptr))
            blocks[f"{letter}_FF"] = _block(matrix, row, self.free, self.free)
            blocks[f"{letter}_FP"] = _block(matrix, row, self.free, self.prescribed)
            blocks[f"{letter}_PP"] = _block(matrix, row, self.prescribed, self.prescribed)
        return Partition(**blocks)

    @cached_property
    def _positions(self) -> dict[str, int]:
        return {name: i for i, name in enumerate(self.dof_names)}

    def dof(self, name: str) -> int:
        """Position of a d.o.f. of the model in ``dof_names``.

        Raises
        ------
        InputError
            If there is none of that name; the message names the nearest.
        """
        if name not in self._positions:
            raise nearest(name, list(self.dof_names), "degree of freedom")
        return self._positions[name]

    def free_name(self, i: int) -> str:
        """Name of the i-th free d.o.f."""
        return self.dof_names[int(self.independent[self.free[i]])]

    def translation(self, component: str) -> FloatArray:
        """Rigid translation (n,) by 1 along a component, of all independent d.o.f."""
        return np.asarray(self._components_of_independent == component, dtype=np.float64)

    @cached_property
    def _components_of_independent(self) -> npt.NDArray[np.str_]:
        return np.array(self.components, dtype=np.str_)[self.independent]

    def total_mass(self, component: str = "z") -> float:
        """Mass [kg] that moves with a rigid translation along a component."""
        t = self.translation(component)
        return float(t @ (self.mass @ t))

    def weight(self, gravity: float) -> FloatArray:
        """Nodal loads (n,) [N] of gravity [m/s^2], downward."""
        return np.asarray(-gravity * (self.mass @ self.translation("z")))

    def renamed(self, names: Mapping[str, str]) -> System:
        """Return the same system with other names for some d.o.f."""
        return replace(self, dof_names=tuple(names.get(name, name) for name in self.dof_names))

    def with_loads(self, *loads: Load) -> System:
        """Return the same system with further loads."""
        return replace(self, loads=(*self.loads, *loads))


def _block(matrix: sp.csr_array, row: IntArray, rows: IntArray, columns: IntArray) -> sp.csr_array:
    """Some rows and columns of a matrix whose entries stand in ``row`` (nnz,), without zeros, sorted."""
    whole = np.int32 if matrix.nnz < np.iinfo(np.int32).max else np.int64
    numbers = np.full((2, matrix.shape[0]), -1, dtype=whole)
    numbers[0, rows], numbers[1, columns] = np.arange(len(rows)), np.arange(len(columns))
    i, j = numbers[0, row], numbers[1, matrix.indices]
    kept = np.flatnonzero((i >= 0) & (j >= 0) & (matrix.data != 0.0))
    i = i[kept]
    if np.any(i[1:] < i[:-1]):  # prescribed d.o.f. in another order
        order = np.argsort(i, kind="stable")
        i, kept = i[order], kept[order]
    begins = np.zeros(len(rows) + 1, dtype=whole)
    np.cumsum(np.bincount(i, minlength=len(rows)), out=begins[1:])
    result = sp.csr_array((matrix.data[kept], j[kept], begins), shape=(len(rows), len(columns)))
    result.sort_indices()
    return result

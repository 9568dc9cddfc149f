"""Matrices of a model from another program: K, M, C with named d.o.f., checked when built."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_array

from axlespan.errors import InputError
from axlespan.io.matrices.names import DofMap, NodeTable, joined_dofs
from axlespan.model.dofs import COMPONENTS

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

#: Largest entry accepted; numbers beyond it are damage, not stiffness.
LARGEST_ENTRY = 1e60
#: Asymmetry, relative to the largest entry, that is put down to the digits of the export.
SYMMETRY_TOLERANCE = 1e-6


@dataclass(frozen=True, eq=False)
class MatrixModel:
    """Stiffness, mass and damping with named d.o.f.; checked when built.

    Parameters
    ----------
    stiffness, mass : sparse array (n_dof, n_dof)
        K [N/m, N, N m] and M [kg, kg m, kg m^2], symmetric.
    damping : sparse array (n_dof, n_dof), optional
        C [N s/m, …], symmetric.
    dofs : DofMap
        Node and component of each row.
    coordinates : NodeTable, optional
        Places of the nodes; it must hold every node of the d.o.f. that is not inside an element.
    held : DofMap, optional
        D.o.f. that the other program holds at zero; they have no rows. A d.o.f. in neither map has
        been left out by the other program, which comes to the same.

    Raises
    ------
    InputError
        If sizes differ, an entry is not finite, a matrix is not symmetric, or it cannot be positive
        semi-definite (negative diagonal, or an entry larger than its diagonal allows).
    """

    stiffness: csr_array
    mass: csr_array
    dofs: DofMap
    damping: csr_array | None = None
    coordinates: NodeTable | None = None
    held: DofMap = field(default_factory=lambda: DofMap(np.empty(0, dtype=np.int64), ()))

    def __post_init__(self) -> None:
        for name in ("stiffness", "mass", "damping"):
            matrix = getattr(self, name)
            if matrix is not None:
                object.__setattr__(self, name, _checked(matrix, name, self.dofs))
        idle = (self.stiffness.diagonal() == 0.0) & (self.mass.diagonal() == 0.0)
        if idle.any():
            row = int(np.flatnonzero(idle)[0])
            fix = "Leave it out of the export, or hold it."
            raise InputError(
                "has neither stiffness nor mass", field="d.o.f.", value=self.dofs.label(row), fix=fix
            )
        if self.coordinates is not None:
            self.coordinates.positions(np.unique(self.dofs.nodes[self.dofs.nodes > 0]))

    @property
    def n_dof(self) -> int:
        """Number of d.o.f."""
        return len(self.dofs)

    def total_mass(self) -> FloatArray:
        """Mass (3,) [kg] that a rigid translation along x, y, z moves: rᵀ M r.

        Mass of d.o.f. that are held or left out is not in it, and a direction without d.o.f. has none.
        """
        masses = []
        for component in COMPONENTS[:3]:
            r = (np.array(self.dofs.components) == component).astype(np.float64)
            masses.append(float(r @ (self.mass @ r)))
        return np.array(masses)

    def rigid_body_vectors(self) -> FloatArray:
        """Displacements (n_dof, 6) of unit translations along and small rotations about x, y, z.

        They are u + θ × (X − X₀); X₀ is the mean of the nodes' places. Rows inside elements are zero.

        Raises
        ------
        InputError
            If the model has no coordinates.
        """
        if self.coordinates is None:
            raise InputError(
                "needs node coordinates", field="matrices", fix="Give a CSV file: node, x, y, z."
            )
        vectors = np.zeros((self.n_dof, 6))
        rows = np.flatnonzero(self.dofs.nodes > 0)
        components = np.array(self.dofs.components)[rows]
        arms = self.coordinates.points_of(self.dofs.nodes[rows])
        x, y, z = (arms - arms.mean(axis=0) if len(arms) else arms).T
        levers = {"x": ((4, z), (5, -y)), "y": ((3, -z), (5, x)), "z": ((3, y), (4, -x))}
        for column, name in enumerate(COMPONENTS):
            own = components == name
            vectors[rows[own], column] = 1.0
            for rotation, arm in levers.get(name, ()):
                vectors[rows[own], rotation] = arm[own]
        return vectors

    def rigid_body_modes(self, tolerance: float = 1e-9) -> int:
        """Number of rigid-body motions, out of six at most, that meet no stiffness.

        Zero for a structure on its supports, six for one that floats in space. The measure is the residual
        K R against |K| |R| row by row, so that stiff and soft parts count alike.

        Parameters
        ----------
        tolerance : float
            Relative residual that counts as none; the default suits exports with 12 digits or more.
        """
        vectors = self.rigid_body_vectors()
        left, values, _ = np.linalg.svd(
            vectors / np.maximum(np.abs(vectors).max(axis=0), 1e-300), full_matrices=False
        )
        basis = left[:, values > 1e-10 * values.max(initial=0.0)]
        if not basis.shape[1]:
            return 0
        size = abs(self.stiffness) @ np.abs(basis).max(axis=1)
        residual = (self.stiffness @ basis) / np.where(size > 0.0, size, 1.0)[:, None]
        reach = np.linalg.svd(residual, compute_uv=False)
        return int(basis.shape[1] - np.count_nonzero(reach > tolerance * np.sqrt(self.n_dof)))

    def without(self, rows: npt.ArrayLike) -> MatrixModel:
        """Return the model with some d.o.f. held at zero: their rows and columns are taken out."""
        out = np.unique(np.asarray(rows, dtype=np.int64))
        keep = np.setdiff1d(np.arange(self.n_dof), out)
        return MatrixModel(
            stiffness=csr_array(self.stiffness[keep][:, keep]),
            mass=csr_array(self.mass[keep][:, keep]),
            damping=None if self.damping is None else csr_array(self.damping[keep][:, keep]),
            dofs=self.dofs.taken(keep),
            coordinates=self.coordinates,
            held=joined_dofs([self.held, self.dofs.taken(out)]),
        )


def _checked(matrix: csr_array, name: str, dofs: DofMap) -> csr_array:
    """The matrix in canonical CSR, symmetric to the last bit."""
    matrix = csr_array(matrix).astype(np.float64, copy=True)
    matrix.sum_duplicates()
    if matrix.shape != (len(dofs), len(dofs)):
        rule = f"must have {len(dofs)} rows and columns, one for each d.o.f."
        raise InputError(
            rule, field=name, value=matrix.shape, fix="Export all matrices and the d.o.f. map together."
        )
    good = np.abs(matrix.data) <= LARGEST_ENTRY
    if not good.all():
        rows = np.repeat(np.arange(len(dofs)), np.diff(matrix.indptr))
        bad = int(np.flatnonzero(~good)[0])
        field_name = f"{name} of {dofs.label(int(rows[bad]))} and {dofs.label(int(matrix.indices[bad]))}"
        raise InputError(
            "must be finite and of a sound size", field=field_name, value=float(matrix.data[bad])
        )
    skew = csr_array(matrix - matrix.T)
    largest = float(np.abs(matrix.data).max(initial=0.0))
    worst = float(np.abs(skew.data).max(initial=0.0))
    if worst > SYMMETRY_TOLERANCE * largest:
        rule = f"must be symmetric; K - Kᵀ reaches {worst / largest:.2g} of the largest entry"
        raise InputError(
            rule, field=name, fix="Export it as symmetric (no friction, follower loads or fluid)."
        )
    if worst > 0.0:
        matrix = csr_array(0.5 * (matrix + matrix.T))
    _check_semidefinite(matrix, name, dofs, largest)
    return matrix


def _check_semidefinite(matrix: csr_array, name: str, dofs: DofMap, largest: float) -> None:
    """What every positive semi-definite matrix fulfils: a_ii ≥ 0 and a_ij² ≤ a_ii a_jj."""
    diagonal = matrix.diagonal()
    if np.any(diagonal < -1e-12 * largest):
        row = int(np.argmin(diagonal))
        rule = "must not be negative on the diagonal"
        raise InputError(rule, field=f"{name} of {dofs.label(row)}", value=float(diagonal[row]))
    rows = np.repeat(np.arange(len(dofs)), np.diff(matrix.indptr))
    root = np.sqrt(np.maximum(diagonal, 0.0))
    bound = root[rows] * root[matrix.indices]
    over = np.abs(matrix.data) > bound * (1.0 + 1e-6) + 1e-12 * largest
    if over.any():
        bad = int(np.flatnonzero(over)[0])
        pair = f"{dofs.label(int(rows[bad]))} and {dofs.label(int(matrix.indices[bad]))}"
        rule = f"must be positive semi-definite; between {pair} it exceeds what their diagonal entries allow"
        fix = "Export without Lagrange multipliers (contact, hybrid elements, constraint equations)."
        raise InputError(rule, field=name, value=float(matrix.data[bad]), fix=fix)

"""What crossings of one structure share: its factors or reduced basis, made once and handed on."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.dynamics.reduction import ReducedBasis, reduced_basis
from axlespan.errors import InputError
from axlespan.interaction.bodies import PreparedStructure
from axlespan.interaction.plan import Plan
from axlespan.interaction.reduced.body import PreparedReduced
from axlespan.interaction.start import StartFactors
from axlespan.running.structure import Structure

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

#: Blocks of Ritz vectors and cut-off of the usual basis.
USUAL_BASIS = (3, 1e-4)


@dataclass(frozen=True, eq=False)
class Groundwork:
    """A structure factored or reduced for a method and a time step: serves batch after batch of crossings."""

    plan: Plan  # one of those it was laid for
    path_dofs: IntArray
    prepared: PreparedStructure
    start: StartFactors
    basis: ReducedBasis | None = None
    seconds: float = 0.0  # that the basis took

    @classmethod
    def of(cls, plans: Sequence[Plan]) -> Groundwork:
        """Factor or reduce the structure that the plans share.

        Raises
        ------
        InputError
            If a given basis is of another structure.
        """
        basis, seconds = plans[0].settings.basis, 0.0
        if basis == "reduced":
            begun = time.perf_counter()
            basis = basis_for(plans, *USUAL_BASIS)
            seconds = time.perf_counter() - begun
        made = prepare_reduced(plans, basis) if isinstance(basis, ReducedBasis) else prepare(plans)
        known = basis if isinstance(basis, ReducedBasis) else None
        starts = StartFactors(plans[0], made.integrator.factor)
        return cls(plans[0], path_dofs_of(plans), made, starts, known, seconds)

    def serves(self, plans: Sequence[Plan]) -> bool:
        """Whether it is what :meth:`of` would lay for these plans."""
        own, other = self.plan.settings, plans[0].settings
        # the shapes of a basis follow from the loads on the path, and those from the footprint
        footprint = self.basis is None or (own.footprint, own.sleepers) == (other.footprint, other.sleepers)
        return (
            self.plan.crossing.structure is plans[0].crossing.structure
            and own.time_step == other.time_step
            and own.method == other.method
            and (own.solver, own.threads) == (other.solver, other.threads)
            and (
                own.basis is other.basis
                or own.basis == other.basis == "reduced"
                or own.basis == other.basis == "full"
            )
            and own.basis_modes == other.basis_modes
            and other.basis_tolerance is None
            and footprint
            and np.array_equal(self.path_dofs, path_dofs_of(plans))
        )

    @property
    def nbytes(self) -> int:
        """Memory of the factor and of the columns under the wheels [byte]."""
        columns = getattr(self.prepared.columns, "nbytes", 0)
        return int(self.prepared.integrator.factor.nbytes) + int(columns)


def path_dofs_of(plans: Sequence[Plan]) -> IntArray:
    """Free d.o.f. (n_path,) that the lines under all wheels use, sorted."""
    return np.unique(np.concatenate([path.free.path_dofs for plan in plans for path in plan.rows.paths]))


def prepare(plans: Sequence[Plan]) -> PreparedStructure:
    """Factor the structure that the plans share."""
    settings, path_dofs = plans[0].settings, path_dofs_of(plans)
    rows = max(plan.rows.n_contact * path.free.dofs.shape[1] for plan in plans for path in plan.rows.paths)
    return PreparedStructure(
        plans[0].structure,
        settings.method,
        settings.time_step,
        path_dofs,
        loaded=min(rows, len(path_dofs)),
        solver=settings.solver,
        threads=settings.threads,
        lanes=len(plans),
    )


def prepare_reduced(plans: Sequence[Plan], basis: ReducedBasis) -> PreparedReduced:
    """The structure that the plans share in the coordinates of a basis.

    Raises
    ------
    InputError
        If the basis is of another structure.
    """
    settings = plans[0].settings
    if basis.vectors.shape[0] != plans[0].structure.size:
        raise InputError(
            f"is of a structure with {basis.vectors.shape[0]} d.o.f., not {plans[0].structure.size}",
            field="basis",
        )
    return PreparedReduced(plans[0].structure, basis, settings.method, settings.time_step)


def basis_for(plans: Sequence[Plan], blocks: int, cutoff: float) -> ReducedBasis:
    """A reduced basis for the loads of all plans."""
    return reduced_basis(
        plans[0].structure.K,
        plans[0].structure.M,
        path_dofs_of(plans),
        blocks=blocks,
        cutoff=cutoff,
        modes=plans[0].settings.basis_modes,
        extra=translations(plans[0].crossing.structure),
        solver=plans[0].settings.solver,
    )


def translations(structure: Structure) -> FloatArray:
    """Rigid translations (n, 3 at most) of the free d.o.f."""
    system = structure.system
    shapes = [system.translation(component)[system.free] for component in ("x", "y", "z")]
    return np.column_stack([shape for shape in shapes if np.any(shape)])

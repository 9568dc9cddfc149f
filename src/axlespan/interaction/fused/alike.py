"""The vehicles of lanes with equal trains, their numbers innermost in memory."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from axlespan.interaction.convoy import Convoy
from axlespan.interaction.fused.banded_body import PIECE, csr_parts

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class AlikeTrains:
    """Some lanes that follow one another, each with the same vehicles on the same wheels.

    Parameters
    ----------
    first_contact, n_contact : int
        The first of their coupled contacts in the joint fleet, and how many each has.
    arrays : tuple
        What the compiled loop wants: contact forces, gaps, state, room to work in, accelerations, static forces, d.o.f.
        of wheels, blocks, A_X⁻¹ and A⁻¹ columns of one train, where d.o.f. and contacts of each begin, d.o.f. of one.
    """

    first_contact: int
    n_contact: int
    width: int
    arrays: tuple[Any, ...]

    @classmethod
    def of(cls, convoy: Convoy, lanes: range, width: int, blocks: tuple[Any, ...]) -> AlikeTrains | None:
        """Those of some lanes, or None where their vehicles differ; ``blocks`` are those of the fleet, padded."""
        dofs, contacts = ([of[lane] for lane in lanes] for of in (convoy.vehicle_dofs, convoy.coupled))
        n_dof, n_contact = dofs[0].stop - dofs[0].start, contacts[0].stop - contacts[0].start
        fleet = convoy.fleet
        if fleet is None:
            return None
        first, kind, begin, entries = blocks
        starts = np.searchsorted(first, [own.start for own in dofs])
        ends = np.searchsorted(first, [own.stop for own in dofs])
        signs = {
            (
                (first[a : b + 1] - own.start).tobytes(),
                kind[a:b].tobytes(),
                (fleet.fleet.dofs[wheels] - own.start).tobytes(),
            )
            for a, b, own, wheels in zip(starts, ends, dofs, contacts, strict=True)
        }
        if len(signs) > 1:
            return None
        own, wheels, n_part = dofs[0], contacts[0], 3 if fleet.integrator.has_damping else 2
        static = np.zeros((n_contact, width))
        static[:, : len(lanes)] = np.array([fleet.static[of] for of in contacts]).T
        arrays = (
            np.zeros(n_contact * width),
            np.zeros(n_contact * width),
            tuple(np.zeros(n_dof * width) for _ in range(3)),
            np.zeros(n_part * n_dof * width),
            np.zeros((n_dof + PIECE) * width),
            static.reshape(-1),
            fleet.fleet.dofs[wheels] - own.start,
            (first[starts[0] : ends[0] + 1] - own.start, kind[starts[0] : ends[0]], begin, entries),
            csr_parts(fleet.stiffness[wheels][:, wheels]),
            csr_parts(fleet.columns[own][:, wheels]),
            (np.array([of.start for of in dofs]), np.array([of.start for of in contacts])),
            n_dof,
        )
        return cls(wheels.start, n_contact, width, arrays)

    def places(self, contacts: IntArray) -> IntArray:
        """Where coupled contacts of the joint fleet stand in the arrays."""
        lane, contact = np.divmod(contacts - self.first_contact, self.n_contact)
        return np.asarray(contact * self.width + lane)

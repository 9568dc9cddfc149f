"""All vehicles of the trains of a crossing as one system."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.dynamics.integrator import Matrices
from axlespan.errors import InputError
from axlespan.linalg.arrays import block_diagonal
from axlespan.model.motions import Constant
from axlespan.model.system import System
from axlespan.vehicles.train import Train
from axlespan.vehicles.vehicle import Vehicle

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Fleet:
    """The vehicles of a train as one block-diagonal system; moving forces have no d.o.f."""

    matrices: Matrices
    weight: FloatArray  # (n_contact,) static contact forces [N]
    coupled: IntArray  # (n_coupled,) contacts that have a d.o.f., among all contacts
    dofs: IntArray  # (n_coupled,) their d.o.f. in the fleet
    vehicle_of: IntArray  # (n_coupled,) vehicle of each coupled contact
    owner_of_dof: IntArray  # (n,) vehicle of each d.o.f.
    dof_names: tuple[str, ...]

    @property
    def forced(self) -> IntArray:
        """Contacts that are moving forces."""
        mask = np.ones(len(self.weight), dtype=bool)
        mask[self.coupled] = False
        return np.flatnonzero(mask)


def matrices_of(system: System) -> Matrices:
    """The free blocks of a system."""
    blocks = system.partition
    damping = blocks.C_FF if blocks.C_FF.nnz else None
    return Matrices(blocks.K_FF, blocks.M_FF, damping, system.modal_damping)


def fleet_of(train: Train, gravity: float, first: int = 0) -> Fleet:
    """All vehicles of a train as one system; ``first`` vehicles of other trains are counted before."""
    kinds: dict[int, Matrices] = {}
    blocks: list[Matrices] = []
    names: list[str] = []
    coupled: list[int] = []
    dofs: list[int] = []
    owner: list[int] = []
    dof_owner: list[int] = []
    begin, contact = 0, 0
    for i, item in enumerate(train.placements):
        vehicle = item.vehicle
        if vehicle.system is not None:
            _check_vehicle(vehicle)
            own = kinds.get(id(vehicle.system)) or matrices_of(vehicle.system)
            kinds[id(vehicle.system)] = own  # vehicles that differ in their wheels alone share one
            blocks.append(own)
            names += [f"{first + i + 1}.{vehicle.system.free_name(j)}" for j in range(own.size)]
            coupled += range(contact, contact + len(vehicle.contacts))
            dofs += (begin + vehicle.contact_dofs).tolist()
            owner += [i] * len(vehicle.contacts)
            dof_owner += [i] * own.size
            begin += own.size
        contact += len(vehicle.contacts)
    index = np.int64
    return Fleet(
        _block_diagonal(blocks),
        train.static_forces(gravity),
        np.array(coupled, dtype=index),
        np.array(dofs, dtype=index),
        np.array(owner, dtype=index),
        np.array(dof_owner, dtype=index),
        tuple(names),
    )


def joined(fleets: Sequence[Fleet]) -> Fleet:
    """Several trains as one fleet; contacts, d.o.f. and vehicles are numbered on."""
    if len(fleets) == 1:
        return fleets[0]
    contacts, dofs, vehicles = (
        np.concatenate([[0], np.cumsum(sizes)])[:-1]
        for sizes in (
            [len(fleet.weight) for fleet in fleets],
            [fleet.matrices.size for fleet in fleets],
            [int(fleet.owner_of_dof.max(initial=-1)) + 1 for fleet in fleets],
        )
    )
    return Fleet(
        _block_diagonal([fleet.matrices for fleet in fleets if fleet.matrices.size]),
        np.concatenate([fleet.weight for fleet in fleets]),
        np.concatenate([fleet.coupled + at for fleet, at in zip(fleets, contacts, strict=True)]),
        np.concatenate([fleet.dofs + at for fleet, at in zip(fleets, dofs, strict=True)]),
        np.concatenate([fleet.vehicle_of + at for fleet, at in zip(fleets, vehicles, strict=True)]),
        np.concatenate([fleet.owner_of_dof + at for fleet, at in zip(fleets, vehicles, strict=True)]),
        tuple(name for fleet in fleets for name in fleet.dof_names),
    )


def _check_vehicle(vehicle: Vehicle) -> None:
    """Loads of vehicles are constant, so that only static contact forces know them; their supports stand still."""
    assert vehicle.system is not None
    moves = any(not (isinstance(m, Constant) and m.amount == 0.0) for m in vehicle.system.motions)
    varies = any(load.history is not None for load in vehicle.system.loads)
    if varies or moves:
        what = "loads that change in time" if varies else "supports that move"
        raise InputError(
            f"has {what}, which are not supported in vehicles", field="vehicle", value=vehicle.name
        )


def _block_diagonal(blocks: Sequence[Matrices]) -> Matrices:
    if not blocks:
        empty = sp.csr_array((0, 0), dtype=float)
        return Matrices(empty, empty)
    if any(block.C_low_rank is not None for block in blocks):
        raise InputError(
            "is not available for vehicles", field="damping", value="modal", fix="Use Rayleigh damping"
        )
    stiffness = block_diagonal([block.K for block in blocks])
    mass = block_diagonal([block.M for block in blocks])
    if all(block.C is None for block in blocks):
        return Matrices(stiffness, mass)
    zero = [sp.csr_array(block.K.shape) if block.C is None else block.C for block in blocks]
    return Matrices(stiffness, mass, block_diagonal(zero))

"""Natural modes of a vehicle in words: ``body pitch``, ``bogie1 and bogie2 bounce, opposed``."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.linalg.eigen import lowest_modes
from axlespan.vehicles.vehicle import Vehicle

FloatArray = npt.NDArray[np.float64]

# A d.o.f. is named if it holds this share of the kinetic energy of the one that holds most.
_NAMED_FROM = 0.3

_WORDS = {"z": "bounce", "pitch": "pitch", "roll": "roll"}


@dataclass(frozen=True)
class VehicleMode:
    """A natural mode with the contact points held."""

    frequency: float  # [Hz]
    damping_ratio: float  # of the mode by itself [-]
    description: str


def vehicle_modes(vehicle: Vehicle) -> list[VehicleMode]:
    """Return the natural modes of a vehicle in ascending order; none for moving forces and masses."""
    if vehicle.system is None:
        return []
    blocks = vehicle.system.partition
    rest = np.setdiff1d(np.arange(blocks.K_FF.shape[0]), vehicle.contact_dofs)
    k, m, c = (sp.csr_array(matrix[rest][:, rest]) for matrix in (blocks.K_FF, blocks.M_FF, blocks.C_FF))
    count = int(np.count_nonzero(m.diagonal()))
    if not len(rest) or not count:
        return []
    modes = lowest_modes(k, m, count)
    names = [vehicle.system.free_name(int(i)) for i in rest]
    return [
        VehicleMode(
            float(omega / (2.0 * np.pi)),
            float(shape @ (c @ shape) / (2.0 * omega)),
            _description(names, shape, shape * (m @ shape)),
        )
        for omega, shape in zip(modes.angular_frequencies, modes.shapes.T, strict=True)
    ]


def _description(names: list[str], shape: FloatArray, energy: FloatArray) -> str:
    """Who moves how: the d.o.f. with most of the kinetic energy, by component."""
    strong = [int(i) for i in np.argsort(-energy, kind="stable") if energy[i] >= _NAMED_FROM * energy.max()]
    groups: dict[str, list[int]] = {}
    for i in strong:
        groups.setdefault(names[i].rpartition(".")[2], []).append(i)
    return " with ".join(
        _moved(names, shape, component, sorted(group)) for component, group in groups.items()
    )


def _moved(names: list[str], shape: FloatArray, component: str, group: list[int]) -> str:
    who = [names[i].rpartition(".")[0] for i in group]
    several = f"{', '.join(who[:-1])} and {who[-1]}" if len(who) > 1 else who[0]
    opposed = len(group) > 1 and np.ptp(np.sign(shape[group])) > 0.0
    return f"{several} {_WORDS.get(component, component)}{', opposed' if opposed else ''}"

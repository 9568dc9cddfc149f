"""Modes of a system: frequencies, damping ratios and what each mode takes part in."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.dynamics.modes import Participation, participation
from axlespan.linalg.eigen import Modes, lowest_modes
from axlespan.model.system import System

FloatArray = npt.NDArray[np.float64]

#: Modes that are computed where nobody says how many.
USUAL_NUMBER = 10
# Up to so many d.o.f. all modes are computed at once and the lowest taken.
_ALL_UP_TO = 400


@dataclass(frozen=True, eq=False)
class SystemModes:
    """The lowest modes of a system; supports that move stand still."""

    modes: Modes  # over the free d.o.f.
    damping_ratio: FloatArray  # (n_mode,) [-]; of damping that couples modes its diagonal
    directions: tuple[str, ...]  # along which the system has mass: x, y, z
    participation: Participation


def modes_of(system: System, number: int | None = None) -> SystemModes:
    """The lowest modes of a system.

    Parameters
    ----------
    system : System
    number : int, optional
        How many; 10, or all if there are fewer.

    Raises
    ------
    InputError
        If there are not so many.
    NotPositiveDefinite
        If d.o.f. have neither stiffness nor mass.
    """
    blocks, n = system.partition, len(system.free)
    count = USUAL_NUMBER if number is None and n > _ALL_UP_TO else number
    modes = lowest_modes(blocks.K_FF, blocks.M_FF, count)
    if number is None:
        modes = Modes(modes.angular_frequencies[:USUAL_NUMBER], modes.shapes[:, :USUAL_NUMBER])
    directions = tuple(name for name in ("x", "y", "z") if system.total_mass(name) > 0.0)
    rigid = np.column_stack([system.translation(name) for name in directions])
    mass = np.asarray(system.mass @ rigid)
    totals = np.array([system.total_mass(name) for name in directions])
    taking_part = participation(modes, mass[system.free], totals, _sizes(system, modes))
    return SystemModes(modes, _damping_ratios(system, modes), directions, taking_part)


def full_shapes(system: System, modes: Modes) -> FloatArray:
    """Shapes (n_full, n_mode) in all d.o.f. of the model."""
    shapes = np.zeros((system.size, len(modes)))
    shapes[system.free] = modes.shapes
    return np.asarray(system.elimination @ shapes)


def _sizes(system: System, modes: Modes) -> FloatArray:
    """Largest displacement (n_mode,) of each shape; the largest rotation where nothing else moves."""
    shapes = np.abs(full_shapes(system, modes))
    moves = np.array([component in ("x", "y", "z") for component in system.components])
    sizes = shapes[moves].max(axis=0, initial=0.0)
    return np.asarray(np.where(sizes > 1e-12 * shapes.max(axis=0), sizes, shapes.max(axis=0)))


def _damping_ratios(system: System, modes: Modes) -> FloatArray:
    force = np.asarray(system.partition.C_FF @ modes.shapes)
    if system.modal_damping is not None:
        force += system.modal_damping.apply(modes.shapes)
    omega = modes.angular_frequencies
    work = np.einsum("nm,nm->m", modes.shapes, force)
    return np.asarray(np.divide(work, 2.0 * omega, out=np.zeros_like(work), where=omega > 0.0))

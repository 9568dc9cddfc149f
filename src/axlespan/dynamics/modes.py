r"""What modes take part in: modal masses, participation factors and effective masses.

With the shapes φ, the mass matrix M and the rigid translation t along a direction,

.. math:: m_n = φ_n^T M φ_n, \qquad Γ_n = \frac{φ_n^T M t}{m_n}, \qquad m_{eff,n} = Γ_n^2 m_n

The effective masses do not depend on how the shapes are scaled; over all modes of a structure that is held
nowhere along t or whose supports carry no mass they add up to the whole mass (Clough and Penzien, Dynamics of
Structures, 1993, 26-3).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.linalg.eigen import Modes

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Participation:
    """Modal masses, participation factors and effective masses, direction by direction."""

    modal_mass: FloatArray  # m_n (n_mode,) [kg], for shapes whose largest displacement is 1
    factor: FloatArray  # Γ_n (n_mode, n_direction) [-], for the same shapes
    effective_mass: FloatArray  # (n_mode, n_direction) [kg]
    total_mass: FloatArray  # (n_direction,) [kg]

    @property
    def share(self) -> FloatArray:
        """Effective masses over the total one (n_mode, n_direction) [-]."""
        total = np.where(self.total_mass > 0.0, self.total_mass, 1.0)
        return np.asarray(self.effective_mass / total)

    @property
    def cumulative(self) -> FloatArray:
        """Shares of all modes up to each (n_mode, n_direction) [-]."""
        return np.asarray(np.cumsum(self.share, axis=0))


def participation(
    modes: Modes, excitation: FloatArray, total_mass: FloatArray, sizes: FloatArray
) -> Participation:
    """Modal masses, participation factors and effective masses.

    Parameters
    ----------
    modes : Modes
        Normalized to φᵀ M φ = 1.
    excitation : array (n, n_direction)
        M t on the free d.o.f. for each direction, prescribed ones moving along: M_FF t_F + M_FP t_P [kg].
    total_mass : array (n_direction,)
        tᵀ M t [kg].
    sizes : array (n_mode,)
        Largest displacement of each of the shapes.

    Examples
    --------
    A mass of 2 kg on a mass of 3 kg on the ground, springs of 1 N/m: both modes together are the whole mass.

    >>> from axlespan.linalg.eigen import lowest_modes
    >>> M = np.diag([3.0, 2.0])
    >>> modes = lowest_modes(np.array([[2.0, -1.0], [-1.0, 1.0]]), M)
    >>> found = participation(modes, M @ np.ones((2, 1)), np.array([5.0]), np.abs(modes.shapes).max(axis=0))
    >>> found.cumulative.round(6).ravel().tolist()
    [0.96, 1.0]
    """
    amounts = modes.shapes.T @ excitation  # Γ of the normalized shapes
    scale = np.where(sizes > 0.0, sizes, 1.0)
    return Participation(1.0 / scale**2, amounts * scale[:, None], amounts**2, np.asarray(total_mass, float))

"""Four-node flat shell: hybrid stress for membrane and bending, see `shell_hybrid`.

Membrane forces are complete and linear, 7 parameters with Allman's sides (as in HSF-Q4θ-7β of Cen et al.
2011); moments complete and quadratic with the shear forces that balance them, 17 parameters.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.elements import shell_hybrid, shell_sides
from axlespan.elements.shell_geometry import FlatGeometry
from axlespan.elements.shell_material import ShellSection

FloatArray = npt.NDArray[np.float64]

#: weight of the mean drilling rotation against the mean rotation of the plane, times G t A (Hughes and
#: Brezzi 1989); from 0.01 to 1 results hardly move.
DRILLING_STIFFNESS = 0.1
#: weight of alternating drilling rotations (+ - + -); small, for curved shells have them without strain.
ALTERNATING_STIFFNESS = 1e-3
#: fading of the forces that tie drilling rotations to bending in the plane, on curved surfaces.
FADING = 4.0


def membrane_parameters(
    geometry: FlatGeometry, section: ShellSection, turning: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Force parameters β (n_e, 7, 12) and stiffness (n_e, 12, 12), with the drilling penalties.

    Facets of a curved surface see drilling rotations that don't strain the surface. Where it turns by the
    angle δ from the element's plane to its sides, the two modes that ask φ to follow bending in the plane
    fade by 1/(1 + 4 (δ √A/t)²), which leaves five as in the element of Pian and Sumihara (1984).
    """
    beta, stiffness = shell_hybrid.membrane_parameters(geometry, section)
    if np.any(turning):
        beta_5, stiffness_5 = shell_hybrid.membrane_parameters(geometry, section, 5)
        share = 1.0 / (1.0 + FADING * (turning / section.thickness) ** 2 * geometry.area)[:, None, None]
        stiffness = share * stiffness + (1.0 - share) * stiffness_5
        beta = share * beta
        beta[:, :5] += (1.0 - share) * beta_5
    shear_area = section.membrane[:, 2, 2] * geometry.area
    alternating = np.tile([0.0, 0.0, 0.25, 0.0, 0.0, -0.25], 2)[None]
    penalties = (
        (DRILLING_STIFFNESS, shell_sides.mean_drilling(geometry)),
        (ALTERNATING_STIFFNESS, alternating),
    )
    for weight, row in penalties:
        stiffness += (weight * shear_area)[:, None, None] * row[:, :, None] * row[:, None, :]
    return beta, stiffness


def bending_parameters(geometry: FlatGeometry, section: ShellSection) -> tuple[FloatArray, FloatArray]:
    """Moment parameters β (n_e, 17, 12) and stiffness (n_e, 12, 12)."""
    return shell_hybrid.bending_parameters(geometry, section, shell_hybrid.QUADRATIC)

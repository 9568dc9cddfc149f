"""The condition of a bridge: stiffness lost in zones along it, and stiffness that follows its temperature."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from axlespan.bridges.spring_laws import require_no_laws
from axlespan.elements.beam import BeamProperties
from axlespan.errors import InputError
from axlespan.model.compile import compile_model
from axlespan.model.parts import BeamPart
from axlespan.running.structure import Structure

FloatArray = npt.NDArray[np.float64]

_STIFFNESSES = (
    "axial_stiffness",
    "bending_stiffness_y",
    "bending_stiffness_z",
    "torsional_stiffness",
    "shear_stiffness_y",
    "shear_stiffness_z",
)


@dataclass(frozen=True)
class Damage:
    """A zone along x whose beams have lost stiffness; their mass stays."""

    start: float  # [m]
    stop: float  # [m]
    stiffness: float  # share of the stiffness that is left [-]

    def __post_init__(self) -> None:
        if not self.start < self.stop:
            raise InputError("must be greater than from", field="to", value=self.stop)
        if not 0.0 < self.stiffness < float("inf"):
            raise InputError("must be positive", field="stiffness", value=self.stiffness)


def in_condition(structure: Structure, damage: Sequence[Damage] = (), stiffness: float = 1.0) -> Structure:
    """A structure of beams with other stiffness: E and G of all beams times a factor, and less in damaged zones.

    Parameters
    ----------
    structure : Structure
        With a model of beams, before track is laid on it.
    damage : sequence of Damage
        Zones along x; where they overlap, their factors multiply. An element that lies in a zone in part has the
        mean flexibility of its parts.
    stiffness : float
        Factor on the stiffness of all beams [-], as temperature brings it about.

    Raises
    ------
    InputError
        If a zone meets no beam, or the structure has no beams.
    """
    if stiffness == 1.0 and not damage:
        return structure
    model = structure.model
    if model is None or not any(isinstance(part, BeamPart) for part in model.parts):
        raise InputError("needs a structure of beams", field="damage")
    hit = np.zeros(len(damage), dtype=bool)
    parts = []
    for part in model.parts:
        if not isinstance(part, BeamPart):
            parts.append(part)
            continue
        ends = np.sort(part.coordinates(model.points)[:, :, 0], axis=1)  # (n, 2) along x
        factor = np.full(len(ends), stiffness)
        for number, zone in enumerate(damage):
            share = _shares(ends, zone)
            hit[number] |= bool(np.any(share > 0.0))
            factor = factor / (1.0 - share + share / zone.stiffness)
        parts.append(replace(part, properties=_scaled(part.properties, factor)))
    if not hit.all():
        number = int(np.argmin(hit))
        raise InputError(
            "lies beside the structure", field=f"damage.{number}.from", value=damage[number].start
        )
    require_no_laws(structure, "structure")
    changed = replace(model, parts=tuple(parts))
    # paths stay: interpolation under a wheel depends on ratios of stiffnesses alone, which share the factor
    return replace(structure, model=changed, system=compile_model(changed).system)


def _shares(ends: FloatArray, zone: Damage) -> FloatArray:
    """Share (n,) of each element, between ends (n, 2), that lies in a zone; none of what stands upright."""
    length = ends[:, 1] - ends[:, 0]
    inside = np.minimum(ends[:, 1], zone.stop) - np.maximum(ends[:, 0], zone.start)
    upright = length <= 1e-9 * max(float(np.abs(ends).max()), 1.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(upright, 0.0, np.clip(inside / np.where(upright, 1.0, length), 0.0, 1.0))


def _scaled(properties: BeamProperties, factor: FloatArray) -> BeamProperties:
    full = properties.broadcast(len(factor))
    return replace(full, **{name: getattr(full, name) * factor for name in _STIFFNESSES})

r"""Decks as grids of beams in space: girders along, cross beams across, right or skew.

Girders stand at lateral positions y; all begin at :math:`x = y \tan θ` for a skew of θ (positive: the left side
is ahead), and cross beams join equal positions along them. A running line at any y between two girders moves as
the cross beam of a hinged deck would: it shares out its load between both by the lever rule, at equal positions
along the skew.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from axlespan.elements.beam import BeamProperties
from axlespan.errors import InputError
from axlespan.model.compile import Compiled, compile_model
from axlespan.model.damping import Damping
from axlespan.model.materials import BeamSection, Material, require_positive
from axlespan.model.model import Model
from axlespan.running.line import path_on_beams
from axlespan.running.path import PolynomialPath
from axlespan.running.structure import Structure

_LARGEST_SKEW = 60.0  # [deg]
# A lateral bending stiffness for sections that give none: grids carry vertical loads only.
_LATERAL = 10.0


@dataclass(frozen=True)
class GridBeam:
    """Section of the girders or cross beams of a grid."""

    second_moment: float  # vertical bending [m^4]
    torsion_constant: float  # St. Venant's J [m^4]
    area: float  # [m^2]
    mass_per_length: float = 0.0  # [kg/m]

    def __post_init__(self) -> None:
        for field in ("second_moment", "area"):
            require_positive(getattr(self, field), field)
        for field in ("torsion_constant", "mass_per_length"):
            require_positive(getattr(self, field), field, zero=True)

    def properties(self, material: Material) -> BeamProperties:
        """Stiffness and mass."""
        return BeamSection(
            self.second_moment,
            self.area,
            lateral_second_moment=_LATERAL * self.second_moment,
            torsion_constant=self.torsion_constant,
            mass_per_length=self.mass_per_length,
        ).properties(material)


def beam_grid(
    *,
    length: float,
    girders: Sequence[float],
    girder: GridBeam | Sequence[GridBeam],
    cross_beam: GridBeam,
    end_beam: GridBeam | None = None,
    youngs_modulus: float,
    poisson_ratio: float = 0.2,
    elements: int = 20,
    cross_beams: int | None = None,
    skew: float = 0.0,
    lines: Mapping[str, float] | None = None,
    track_centers: Sequence[float] | None = None,
    bearing_stiffness: float | None = None,
    bearing_damping: float | None = None,
    damping: Damping | None = None,
    name: str = "beam grid",
) -> Structure:
    """A simply supported deck of girders and cross beams in space.

    Each end of each girder stands on a bearing (z; x and y held at one, so that nothing drifts); they are called
    ``girder1.begin``, ``girder1.end``, …

    Parameters
    ----------
    length : float
        Span of each girder, bearing to bearing [m].
    girders : sequence of float
        Lateral positions y of the girders [m], from right to left.
    girder : GridBeam or one for each girder
    cross_beam, end_beam : GridBeam
        Cross beams inside the span and over the bearings (as inside when left out).
    youngs_modulus, poisson_ratio : float
        E [Pa] and ν [-].
    elements : int
        Of each girder.
    cross_beams : int, optional
        Number of equal spaces between cross beams; one at each node when left out. It must divide ``elements``.
    skew : float
        Angle of the bearing lines against the perpendicular of the axis [rad].
    lines : mapping of name to y, optional
        Running lines [m]; those of the tracks when left out. There are always ``girder1``, … over the girders,
        on which section forces can be asked for.
    track_centers : sequence of float, optional
        Lateral positions [m] of tracks, 0 when left out. The first one has the lines ``main`` in its middle and
        ``left`` and ``right`` under its rails, further ones ``main2``, ``left2``, ``right2``, …
    bearing_stiffness, bearing_damping : float, optional
        Of each bearing [N/m], [N s/m]; rigid when left out.
    damping : Rayleigh or Modal, optional
    name : str
        Of the structure.

    Raises
    ------
    InputError
        If a value is out of range or a line lies beside the girders.
    """
    require_positive(length, "length")
    y = _girders(girders)
    n, every = _counts(elements, cross_beams)
    slope = math.tan(_skew(skew))
    sections = [girder] * len(y) if isinstance(girder, GridBeam) else list(girder)
    if len(sections) != len(y):
        raise InputError(
            f"must be one or one for each of the {len(y)} girders", field="girder", value=len(sections)
        )
    material = Material(youngs_modulus, poisson_ratio)
    along = np.linspace(0.0, length, n + 1)
    points = [np.column_stack([along + at * slope, np.full(n + 1, at), np.zeros(n + 1)]) for at in y]
    model = Model(plane=False).with_nodes(np.concatenate(points))
    nodes = np.arange(len(y) * (n + 1)).reshape(len(y), n + 1)
    for number, (own, section) in enumerate(zip(nodes, sections, strict=True)):
        pairs = np.column_stack([own[:-1], own[1:]])
        model = model.with_beams(pairs, section.properties(material), name=f"girder{number + 1}")
    for title, where, section in (
        ("cross beams", np.arange(every, n, every), cross_beam),
        ("end beams", np.array([0, n]), end_beam or cross_beam),
    ):
        pairs = np.column_stack([nodes[:-1, where].ravel(), nodes[1:, where].ravel()])
        model = model.with_beams(pairs, section.properties(material), name=title)
    model = _on_bearings(model, nodes, bearing_stiffness, bearing_damping).with_damping(damping)
    compiled = compile_model(model)
    on_girders = {f"girder{number + 1}": float(at) for number, at in enumerate(y)}
    wanted = {**(dict(lines) if lines is not None else _track_lines(track_centers)), **on_girders}
    paths = {name: _line(model, compiled, nodes, y, slope, name, at) for name, at in wanted.items()}
    return Structure(compiled.system, paths, name, model, {"length": length, "skew": skew})


def _girders(girders: Sequence[float]) -> np.ndarray:
    y = np.asarray(girders, dtype=float)
    if len(y) < 2 or not np.all(np.diff(y) > 0.0):
        raise InputError(
            "must be at least two positions, from right to left", field="girders", value=list(girders)
        )
    return y


def _counts(elements: int, cross_beams: int | None) -> tuple[int, int]:
    """Elements of a girder, and how many of them lie between cross beams."""
    for name, value in (("elements", elements), ("cross_beams", cross_beams)):
        if value is not None and (isinstance(value, bool) or value != int(value) or not 1 <= value <= 10_000):
            raise InputError("must be a whole number from 1 to 10 000", field=name, value=value)
    spaces = elements if cross_beams is None else cross_beams
    if elements % spaces:
        raise InputError(
            f"must divide the {elements} elements of a girder", field="cross_beams", value=cross_beams
        )
    return int(elements), int(elements) // int(spaces)


def _skew(skew: float) -> float:
    if not abs(skew) <= math.radians(_LARGEST_SKEW):
        raise InputError(
            f"must be at most {_LARGEST_SKEW:g} deg to either side",
            field="skew",
            value=skew,
            fix="It is an angle in rad from the perpendicular of the axis",
        )
    return float(skew)


def _track_lines(centers: Sequence[float] | None) -> dict[str, float]:
    result: dict[str, float] = {}
    for number, center in enumerate((0.0,) if centers is None else centers):
        mark = "" if number == 0 else str(number + 1)
        result |= {f"main{mark}": center, f"left{mark}": center + 0.75, f"right{mark}": center - 0.75}
    return result


def _on_bearings(model: Model, nodes: np.ndarray, stiffness: float | None, damping: float | None) -> Model:
    if damping is not None and stiffness is None:
        raise InputError("is missing; bearing_damping stands beside it", field="bearing_stiffness")
    spring = None if stiffness is None else {"z": stiffness}
    dashpot = None if damping is None else {"z": damping}
    for number, own in enumerate(nodes):
        for end, node in (("begin", own[0]), ("end", own[-1])):
            held = ["x", "y"] if (number, end) == (0, "begin") else ["y"] if number == 0 else []
            fixed = held if spring else [*held, "z"]
            name = f"girder{number + 1}.{end}"
            model = model.with_support(int(node), fixed, stiffness=spring, damping=dashpot, name=name)
    return model


def _line(
    model: Model, compiled: Compiled, nodes: np.ndarray, y: np.ndarray, slope: float, name: str, at: float
) -> PolynomialPath:
    """A line at y between two girders, by the lever rule."""
    if not y[0] - 1e-9 <= at <= y[-1] + 1e-9:
        raise InputError(
            f"must lie between the outer girders, {y[0]:g} and {y[-1]:g} m", field=f"lines.{name}", value=at
        )
    i = int(np.clip(np.searchsorted(y, at, side="right") - 1, 0, len(y) - 2))
    share = float(np.clip((at - y[i]) / (y[i + 1] - y[i]), 0.0, 1.0))
    start = at * slope
    sides = [
        path_on_beams(model, compiled.table, nodes[j].tolist(), start=start).transformed(
            compiled.system.elimination
        )
        for j in (i, i + 1)
    ]
    if share in (0.0, 1.0):
        return sides[int(share)]
    return PolynomialPath(
        sides[0].breaks,
        np.concatenate([sides[0].dofs, sides[1].dofs], axis=1),
        np.concatenate([(1.0 - share) * sides[0].coefficients, share * sides[1].coefficients], axis=1),
    )

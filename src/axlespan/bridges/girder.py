"""A beam over several spans before it is a model: lengths, properties span by span, nodes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from axlespan.bridges.stations import Station, Variation
from axlespan.elements.beam import BeamProperties
from axlespan.errors import InputError
from axlespan.model.materials import BeamSection, Material, require_positive

T = TypeVar("T")
FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Girder:
    """Spans with their properties."""

    ends: FloatArray  # (n_span + 1,) [m]
    counts: tuple[int, ...]  # elements of each span
    properties: tuple[BeamProperties, ...]  # of each span
    moduli: tuple[float, ...]  # [Pa]
    has_area: bool
    variation: Variation | None = None

    @property
    def n_span(self) -> int:
        """Number of spans."""
        return len(self.counts)

    @property
    def length(self) -> float:
        """Length of all spans [m]."""
        return float(self.ends[-1])

    def grid(self, positions: Sequence[float] = ()) -> FloatArray:
        """Positions of nodes (n,): the ends of elements, and further positions [m].

        Raises
        ------
        InputError
            If a position is not on the beam.
        """
        pieces = [
            np.linspace(a, b, count + 1)
            for a, b, count in zip(self.ends[:-1], self.ends[1:], self.counts, strict=True)
        ]
        return with_positions(np.unique(np.concatenate(pieces)), list(positions))

    def span_of(self, x: FloatArray) -> IntArray:
        """Span (n,) of each element between nodes at x (n + 1,)."""
        middle = 0.5 * (x[1:] + x[:-1])
        return np.clip(np.searchsorted(self.ends, middle, side="right") - 1, 0, self.n_span - 1)

    def span_properties(self, span: int, x: FloatArray) -> BeamProperties:
        """Properties of the elements between the nodes at x (n + 1,) of one span."""
        own = self.properties[span]
        if self.variation is None:
            return own
        return self.variation.applied(own, self.moduli[span], x)

    def element_properties(self, x: FloatArray) -> BeamProperties:
        """Properties of all elements (n,) between nodes at x (n + 1,), as arrays."""
        span = self.span_of(x)
        arrays = {
            f.name: np.array([getattr(own, f.name) for own in self.properties])[span]
            for f in fields(BeamProperties)
        }
        result = replace(self.properties[0], **arrays)
        if self.variation is None:
            return result
        return self.variation.applied(result, np.array(self.moduli)[span], x)


def girder_of(
    *,
    spans: Sequence[float],
    youngs_modulus: float | Sequence[float],
    second_moment: float | Sequence[float],
    mass_per_length: float | Sequence[float],
    elements: int | Sequence[int],
    area: float | Sequence[float | None] | None,
    shear_area: float | Sequence[float | None] | None,
    poisson_ratio: float | Sequence[float],
    stations: Sequence[Station] | None = None,
) -> Girder:
    """Check the numbers of a beam over spans; values are common or given span by span.

    Raises
    ------
    InputError
        If a value is out of range or there are not as many as spans.
    """
    lengths = [
        require_positive(span, "length" if len(spans) == 1 else f"spans.{i}") for i, span in enumerate(spans)
    ]
    if not lengths:
        raise InputError("must name at least one span", field="spans", value=list(spans))
    n = len(lengths)
    counts = [_count(c) for c in _per_span(elements, n, "elements")]
    moduli, moments, masses = (
        [require_positive(v, field, zero=field == "mass_per_length") for v in _per_span(values, n, field)]
        for values, field in (
            (youngs_modulus, "youngs_modulus"),
            (second_moment, "second_moment"),
            (mass_per_length, "mass_per_length"),
        )
    )
    areas, shear_areas = (
        _per_span(values, n, field) for values, field in ((area, "area"), (shear_area, "shear_area"))
    )
    if any(value is None for value in areas) and any(value is not None for value in areas):
        raise InputError("must be given for all spans or for none", field="area", value=areas)
    ratios = _per_span(poisson_ratio, n, "poisson_ratio")
    properties = [
        BeamSection(
            second_moment=moments[i],
            area=areas[i],
            shear_area=shear_areas[i],
            mass_per_length=masses[i],
            rotary_inertia=areas[i] is not None and shear_areas[i] is not None,
        ).properties(Material(moduli[i], ratios[i]))
        for i in range(n)
    ]
    ends = np.concatenate([[0.0], np.cumsum(lengths)])
    variation = None if stations is None else Variation.of(stations, float(ends[-1]))
    return Girder(ends, tuple(counts), tuple(properties), tuple(moduli), areas[0] is not None, variation)


def _per_span(values: T | Sequence[T] | np.ndarray, n: int, field: str) -> list[T]:
    if isinstance(values, Sequence | np.ndarray):
        if len(values) != n:
            raise InputError(
                f"must be one value or one for each of the {n} spans", field=field, value=list(values)
            )
        return list(values)
    return [values] * n


def _count(elements: int) -> int:
    if isinstance(elements, bool) or not np.isfinite(elements) or int(elements) != elements or elements < 1:
        raise InputError("must be a whole number of at least 1", field="elements", value=elements)
    if elements > 1_000_000:
        raise InputError("must be at most 1 000 000", field="elements", value=elements)
    return int(elements)


def with_positions(grid: FloatArray, positions: list[float]) -> FloatArray:
    """The grid with nodes added where supports stand between nodes."""
    length = grid[-1]
    for position in positions:
        if not 0.0 <= position <= length:
            raise InputError(f"must be between 0 and {length:g} m", field="support position", value=position)
        if np.min(np.abs(grid - position)) > 1e-9 * length:
            grid = np.sort(np.append(grid, position))
    return grid

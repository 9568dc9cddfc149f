"""Sections that vary along a beam, given at stations."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from axlespan.elements.beam import BeamProperties
from axlespan.errors import InputError
from axlespan.model.materials import require_positive

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Station:
    """Second moment and mass of a beam at one place; between stations they vary linearly.

    What is left out does not vary.
    """

    position: float  # [m]
    second_moment: float | None = None  # [m^4]
    mass_per_length: float | None = None  # [kg/m]


@dataclass(frozen=True, eq=False)
class Variation:
    """EI and mass along a beam, relative to what its span is given, or absolute."""

    position: FloatArray  # (n,) [m]
    second_moment: FloatArray | None  # (n,) [m^4]
    mass_per_length: FloatArray | None  # (n,) [kg/m]

    @classmethod
    def of(cls, stations: Sequence[Station], length: float) -> Variation:
        """Check stations of a beam of a length [m].

        Raises
        ------
        InputError
            If they do not increase, lie off the beam, or give a value at some stations only.
        """
        places = np.array([station.position for station in stations], dtype=float)
        if len(places) < 2:
            raise InputError("must be at least two", field="stations", value=len(places))
        if np.any(np.diff(places) <= 0.0):
            raise InputError("must increase", field="stations", value=places.tolist())
        if not (places[0] >= -1e-9 * length and places[-1] <= length * (1.0 + 1e-9)):
            raise InputError(f"must lie between 0 and {length:g} m", field="stations", value=places.tolist())
        columns: list[FloatArray | None] = []
        for name in ("second_moment", "mass_per_length"):
            values = [getattr(station, name) for station in stations]
            given = [value for value in values if value is not None]
            if given and len(given) < len(values):
                raise InputError("must be given at all stations or at none", field="stations", value=name)
            for number, value in enumerate(given):
                require_positive(value, f"stations.{number}.{name}", zero=name == "mass_per_length")
            columns.append(np.array(given) if given else None)
        return cls(places, *columns)

    def applied(
        self, properties: BeamProperties, modulus: float | FloatArray, ends: FloatArray
    ) -> BeamProperties:
        """Properties of elements between ends (n_element + 1,): the mean over each element.

        The mean of a linear course is its value in the middle; the second moment is that whose flexibility 1/EI
        is the mean over the element, so that tips of haunched cantilevers deflect as they should. Beyond the
        first and the last station the value there holds.
        """
        result = properties
        moments, masses = self.second_moment, self.mass_per_length
        if moments is not None:
            moment = 1.0 / _mean(lambda x: 1.0 / np.interp(x, self.position, moments), ends)
            result = replace(result, bending_stiffness_y=modulus * moment)
        if masses is not None:
            mass = _mean(lambda x: np.interp(x, self.position, masses), ends)
            result = replace(result, mass_per_length=mass)
        return result


# Gauss points on [0, 1].
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(4)
_POINTS, _WEIGHTS = 0.5 * (1.0 + _POINTS), 0.5 * _WEIGHTS


def _mean(function: Callable[[FloatArray], FloatArray], ends: FloatArray) -> FloatArray:
    """Mean (n_element,) of a function over elements."""
    x = ends[:-1, None] + np.diff(ends)[:, None] * _POINTS
    return np.asarray(function(x) @ _WEIGHTS)

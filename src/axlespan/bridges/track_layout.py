r"""Where a track's supports stand, and how stiff each is.

Supports (sleepers, fastenings) stand at :math:`s = b + (i + ½) a` from the beginning b of the bridge, so that
none stands on the end of a deck whose length is a multiple of the spacing a.

At its far ends the modeled track meets rigid ground. There its compliance, that of the rails' bending and of all
springs alike, grows smoothly from nothing over the run-in T,

.. math:: 1/k_i = f(d_i) / k, \qquad 1/EI(x) = f(d) / EI, \qquad f(d) = ξ^3 (10 - 15 ξ + 6 ξ^2), \quad ξ = d/T

so that the trough under a wheel keeps its length and its depth grows as f: with zero slope and curvature at both
ends. A wheel that comes from the rigid ground is let down gently.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import ceil

import numpy as np
import numpy.typing as npt

from axlespan.bridges.track import Track, Zone
from axlespan.errors import InputError
from axlespan.model.dofs import nearest
from axlespan.model.materials import require_positive

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]

#: Length over which the track's compliance grows at its far ends [m].
RUN_IN = 15.0
#: Plain track between run-in and bridge, in characteristic lengths of the track.
PLAIN = 10.0
#: Plain track beyond that, on which a train comes to rest after the run-in [m].
SETTLING = 25.0

# Smallest share of the compliance, at the ends of the track.
_STIFFEST = 1e-3
_MOST_SUPPORTS = 50_000


@dataclass(frozen=True, eq=False)
class Layout:
    """Supports of a track along a line."""

    position: FloatArray  # (n,) [m]
    on_deck: BoolArray  # (n,)
    factor: Mapping[str, FloatArray]  # layer -> (n,) on its stiffness and damping
    start: float  # of the rails [m]
    stop: float
    run_in: float  # [m]

    @property
    def before(self) -> BoolArray:
        """Supports (n,) on the ground before the deck; all where there is none."""
        first = int(np.argmax(self.on_deck)) if np.any(self.on_deck) else len(self.position)
        return np.asarray(np.arange(len(self.position)) < first)

    def compliance(self, position: FloatArray) -> FloatArray:
        """Share f (n,) of the full compliance at positions (n,) [m]."""
        if self.run_in == 0.0:
            return np.ones_like(position)
        distance = np.minimum(position - self.start, self.stop - position)
        xi = np.clip(distance / self.run_in, 0.0, 1.0)
        return np.asarray(np.maximum(xi**3 * (10.0 - 15.0 * xi + 6.0 * xi**2), _STIFFEST))


def least_approach(track: Track, run_in: float = RUN_IN) -> float:
    """The shortest approach that leaves a bridge undisturbed by the end of the modeled track [m].

    The run-in, then ten characteristic lengths 1/β: the trough of a wheel on the run-in has faded there to
    e^-10 of its depth.

    Parameters
    ----------
    track : Track
    run_in : float
        Length at the far end over which the track grows soft [m].
    """
    return run_in + PLAIN * track.characteristic_length


def usual_approach(track: Track, run_in: float = RUN_IN) -> float:
    """The approach that is taken when none is given: the shortest one and 25 m for a train to settle [m].

    25 m is 0.3 s at 300 km/h: the oscillation of a bogie on its primary springs (5 to 8 Hz, a fifth of
    critical) has faded by then to a tenth of what little the run-in excites.

    Parameters
    ----------
    track : Track
    run_in : float
        Length at the far end over which the track grows soft [m].
    """
    return ceil(least_approach(track, run_in) + SETTLING)


def layout_over(
    track: Track,
    begin: float,
    end: float,
    approach: float,
    exit: float,
    run_in: float,
    zones: Sequence[Zone],
) -> Layout:
    """Supports over a bridge from begin to end [m], and before and behind it.

    The approach is made longer, up to a whole number of spacings; so is the exit.
    """
    for name, length in (("approach", approach), ("exit", exit)):
        require_positive(length, name)
        if length < run_in:
            raise InputError(
                f"must be longer than the run-in, {run_in:g} m",
                field=name,
                value=length,
                fix=f"Use {usual_approach(track, run_in):g} m",
            )
    a = track.spacing
    if a > end - begin:
        raise InputError(
            f"must be shorter than the bridge, {end - begin:g} m", field="sleeper_spacing", value=a
        )
    before, behind = ceil(approach / a - 1e-9), ceil((end + exit - begin) / a - 1e-9)
    _check_count(before + behind, a)
    position = np.asarray(begin + a * (np.arange(-before, behind) + 0.5), dtype=np.float64)
    on_deck = (position >= begin) & (position < end)
    return _finished(track, position, on_deck, begin - before * a, begin + behind * a, run_in, zones)


def layout_on_ground(track: Track, length: float, run_in: float, zones: Sequence[Zone]) -> Layout:
    """Supports on the ground alone, from 0 to a length [m]."""
    require_positive(length, "length")
    if length < 2.0 * run_in + track.spacing:
        raise InputError(
            f"must be longer than its two run-ins, {2.0 * run_in:g} m", field="length", value=length
        )
    count = round(length / track.spacing)
    _check_count(count, track.spacing)
    if abs(count * track.spacing - length) > 1e-6 * length:
        near = count * track.spacing
        raise InputError(
            f"must be a whole number of spacings, {track.spacing:g} m",
            field="length",
            value=length,
            fix=f"Use {near:g} m",
        )
    position = np.asarray(track.spacing * (np.arange(count) + 0.5), dtype=np.float64)
    return _finished(track, position, np.zeros(count, dtype=bool), 0.0, length, run_in, zones)


def _check_count(count: int, spacing: float) -> None:
    if count > _MOST_SUPPORTS:
        raise InputError(
            f"makes {count} supports; at most {_MOST_SUPPORTS} are possible",
            field="sleeper_spacing",
            value=spacing,
        )


def _finished(
    track: Track,
    position: FloatArray,
    on_deck: BoolArray,
    start: float,
    stop: float,
    run_in: float,
    zones: Sequence[Zone],
) -> Layout:
    require_positive(run_in, "run_in", zero=True)
    bare = Layout(position, on_deck, {}, start, stop, run_in)
    ends = 1.0 / bare.compliance(position)
    factor = {name: ends.copy() for name in track.layer_names()}
    for number, zone in enumerate(zones):
        if zone.layer not in factor:
            error = nearest(zone.layer, list(factor), "layer of this track")
            raise InputError(error.rule, field=f"zones.{number}.layer", value=zone.layer, fix=error.fix)
        if zone.stop < start or zone.start > stop:
            raise InputError(
                f"lies off the track, which goes from {start:g} to {stop:g} m",
                field=f"zones.{number}",
                value=f"{zone.start:g} to {zone.stop:g} m",
            )
        inside = (position >= zone.start) & (position <= zone.stop)
        share = (position[inside] - zone.start) / (zone.stop - zone.start)
        low, high = zone.factors
        factor[zone.layer][inside] *= low + share * (high - low)
    return replace(bare, factor=factor)

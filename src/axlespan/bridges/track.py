r"""Track in layers: what lies between the rails and the ground or the deck.

All values are those of the whole track at one support: **both rails together**, a whole sleeper. A pad of
130 MN/m here is two pads of 65 MN/m. Values of one rail seat are doubled by whoever writes them down.

From top to bottom: the rails (one beam of twice the bending stiffness and mass in a plane model), then layers,
each a spring and a dashpot with what lies under them: sleepers, ballast masses, a slab, or the base.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from axlespan.bridges.rails import Rail
from axlespan.bridges.track_presets import TrackPreset
from axlespan.errors import InputError
from axlespan.model.materials import require_positive

# A rail seat spacing beyond this is a typing error, not a track [m].
_WIDEST = 3.0


@dataclass(frozen=True)
class Layer:
    """Springs and dashpots at each support, and what lies under them."""

    name: str  # of the springs: pads, ballast, subgrade, fastenings, mortar
    stiffness: float  # of one support [N/m]
    damping: float = 0.0  # [N s/m]
    body: str | None = None  # what lies under them; None for the base
    mass: float = 0.0  # of that body, of one support [kg]
    bending_stiffness: float = 0.0  # of a slab [N m^2]
    shear_stiffness: float = 0.0  # between neighboring bodies [N/m]
    shear_damping: float = 0.0  # [N s/m]

    def __post_init__(self) -> None:
        require_positive(self.stiffness, f"{self.name}.stiffness")
        for field in ("damping", "mass", "bending_stiffness", "shear_stiffness", "shear_damping"):
            require_positive(getattr(self, field), f"{self.name}.{field}", zero=True)


@dataclass(frozen=True)
class Zone:
    """A stretch of track with another stiffness: factors on a layer, linear from its begin to its end.

    Dashpots go with the springs. A factor of zero makes the sleepers hang. Zones multiply where they overlap.
    """

    start: float  # [m]
    stop: float  # [m]
    factor: tuple[float, float] | float
    layer: str = "ballast"

    def __post_init__(self) -> None:
        if not self.start < self.stop:
            raise InputError("must end behind its start", field="zone.stop", value=self.stop)
        for value in self.factors:
            require_positive(value, "zone.factor", zero=True)

    @property
    def factors(self) -> tuple[float, float]:
        """Factors at both ends."""
        if isinstance(self.factor, tuple):
            return self.factor
        return (float(self.factor), float(self.factor))


@dataclass(frozen=True)
class Track:
    """A track, ready to be laid on the ground or on a bridge."""

    rail: Rail
    spacing: float  # of the supports [m]
    layers: tuple[Layer, ...]  # on the ground, from top to bottom; the last one stands on it
    deck_layers: tuple[Layer, ...]  # on a bridge; the last one stands on the deck
    rails: int = 2
    panel_length: float | None = None  # of slabs [m]; None: continuous
    name: str = "track"
    preset: TrackPreset | None = None

    def __post_init__(self) -> None:
        require_positive(self.spacing, "sleeper_spacing")
        if self.spacing > _WIDEST:
            raise InputError(
                f"must be at most {_WIDEST:g} m",
                field="sleeper_spacing",
                value=self.spacing,
                fix="0.6 m is usual",
            )
        for layers in (self.layers, self.deck_layers):
            if not layers or layers[-1].body is not None or any(layer.body is None for layer in layers[:-1]):
                raise InputError("must end on the base, and only there", field="track.layers")

    @property
    def bending_stiffness(self) -> float:
        """EI of all rails [N m^2]."""
        return self.rails * self.rail.bending_stiffness

    @property
    def mass_per_length(self) -> float:
        """Of all rails [kg/m]."""
        return self.rails * self.rail.mass_per_length

    def foundation_modulus(self, *, deck: bool = False) -> float:
        """Static stiffness under the rails per length, all layers in series [N/m^2].

        A slab's bending is left out: it spreads the load further.
        """
        layers = self.deck_layers if deck else self.layers
        return 1.0 / (self.spacing * sum(1.0 / layer.stiffness for layer in layers))

    @property
    def characteristic_length(self) -> float:
        """1/β = (4 EI / k)^(1/4): over it a wheel's trough fades by e [m] (Winkler); the longer of both bases."""
        stiffness = 4.0 * self.bending_stiffness
        softest = min(self.foundation_modulus(), self.foundation_modulus(deck=True))
        slab = max(layer.bending_stiffness for layer in self.layers)
        length = (stiffness / softest) ** 0.25
        if slab == 0.0:
            return float(length)
        below = 1.0 / (self.spacing * sum(1.0 / layer.stiffness for layer in self.layers[1:]))
        return float(max(length, (4.0 * (slab + self.bending_stiffness) / below) ** 0.25))

    @property
    def pinned_pinned_frequency(self) -> float:
        """π/2 √(EI/m) / a²: the rail swings between supports with half a wave [Hz] (Euler-Bernoulli)."""
        return float(
            0.5 * math.pi * math.sqrt(self.bending_stiffness / self.mass_per_length) / self.spacing**2
        )

    def layer_names(self) -> tuple[str, ...]:
        """Names of all layers of springs."""
        return tuple(dict.fromkeys(layer.name for layer in (*self.layers, *self.deck_layers)))

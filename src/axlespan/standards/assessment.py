"""What a run is to be assessed for: the line, the bridge, national values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from axlespan.errors import InputError
from axlespan.standards.bridge_values import BRIDGE_TYPES
from axlespan.standards.limits import LIMITS

#: Checks by their names in case files, in the order of their verdicts.
CHECKS = (
    "dynamic_analysis",
    "critical_speed",
    "damping",
    "deck_acceleration",
    "deflection",
    "lm71_deflection",
    "dynamic_effect",
    "dynamic_moment",
    "end_rotation",
    "end_offset",
    "twist",
    "body_acceleration",
    "wheel_unloading",
    "contact_force",
    "loss_of_contact",
    "derailment",
    "continuous_comfort",
    "mean_comfort",
    "weighted_rms",
    "sperling",
)

DECKS = ("ballasted", "unballasted")
COMFORT_LEVELS = ("very-good", "good", "acceptable")
MAINTENANCE = ("careful", "standard")


@dataclass(frozen=True)
class Assessment:
    """What the rules need to know beside a run.

    Parameters
    ----------
    line_speed : float, optional
        Maximum line speed at the site [m/s].
    deck : {"ballasted", "unballasted"}
        How the track lies on the deck.
    bridge_type : str, optional
        "steel", "composite", "prestressed-concrete", "reinforced-concrete" or "filler-beam".
    spans : sequence of float, optional
        Spans along the deck's line [m]; found from rigid and elastic supports of beams when left out.
    continuous : bool, optional
        Whether the beam runs on over its supports; more than one span means yes when left out.
    simple : bool
        Whether it behaves like a simple beam or plate in the sense of EN 1991-2 figure 6.9.
    determinant_length : float, optional
        L_Φ [m]; by the spans when left out.
    first_frequency, torsional_frequency : float, optional
        n0 and n_T [Hz]; n0 is that of the model when left out.
    maintenance : {"careful", "standard"}
        Of the track: Φ2 and φ''/2, or Φ3 and φ''.
    overhang : float, optional
        From the bearing to the end of the deck [m], for the vertical offset there.
    coach_length : float, optional
        Regular distance of the train's axle groups [m]; that of equal vehicles when left out.
    alpha : float
        Classification factor α of load model 71.
    comfort : {"very-good", "good", "acceptable"}
        Level of comfort that is asked for.
    limits : mapping of name to value
        Limits that replace those of the standards [SI]; names are those of :data:`LIMITS`.
    national : str
        Where these limits come from, such as "NA to BS EN 1990".
    checks : sequence of str
        What is assessed; everything by default.
    """

    line_speed: float | None = None
    deck: str = "ballasted"
    bridge_type: str | None = None
    spans: tuple[float, ...] | None = None
    continuous: bool | None = None
    simple: bool = True
    determinant_length: float | None = None
    first_frequency: float | None = None
    torsional_frequency: float | None = None
    maintenance: str = "careful"
    overhang: float | None = None
    coach_length: float | None = None
    alpha: float = 1.0
    comfort: str = "very-good"
    limits: Mapping[str, float] = field(default_factory=lambda: MappingProxyType({}))
    national: str = ""
    checks: tuple[str, ...] = CHECKS

    def __post_init__(self) -> None:
        for name, words in (("deck", DECKS), ("comfort", COMFORT_LEVELS), ("maintenance", MAINTENANCE)):
            _require_word(getattr(self, name), words, name)
        if self.bridge_type is not None:
            _require_word(self.bridge_type, BRIDGE_TYPES, "bridge_type")
        for number, check in enumerate(self.checks):
            _require_word(check, CHECKS, f"checks.{number}")
        frequencies = ("first_frequency", "torsional_frequency")
        for name in ("line_speed", "determinant_length", "coach_length", "alpha", *frequencies):
            _require_positive(getattr(self, name), name)
        for number, span in enumerate(self.spans or ()):
            _require_positive(span, f"spans.{number}")
        if self.overhang is not None and not 0.0 <= self.overhang < float("inf"):
            raise InputError("must not be negative", field="overhang", value=self.overhang)
        for name, value in self.limits.items():
            _require_word(name, tuple(LIMITS), f"limits.{name}")
            _require_positive(value, f"limits.{name}")


def _require_word(word: str, words: tuple[str, ...], field: str) -> None:
    if word not in words:
        raise InputError(f"must be one of {', '.join(words)}", field=field, value=word)


def _require_positive(value: float | None, field: str) -> None:
    if value is not None and not 0.0 < value < float("inf"):
        raise InputError("must be positive", field=field, value=value)

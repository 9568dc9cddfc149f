"""Damping of a structure."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Discriminator, Field

from axlespan.errors import InputError
from axlespan.study.check_lists import Several
from axlespan.study.checks import Measured, Part
from axlespan.study.kinds import Kinds, tag
from axlespan.study.quantities import DampingRatio, Rate
from axlespan.units import FREQUENCY, TIME


class RayleighCoefficients(Part):
    """Rayleigh damping C = alpha M + beta K by its coefficients."""

    kind: Literal["rayleigh"]
    alpha: Rate
    """Coefficient of the mass matrix."""
    beta: Annotated[float, Measured(TIME, at_least=0.0), Field(examples=["0.2 ms"])]
    """Coefficient of the stiffness matrix."""

    def coefficients(self) -> tuple[float, float]:
        """Return alpha [1/s] and beta [s]."""
        return self.alpha, self.beta


class RayleighRatio(Part):
    """Rayleigh damping with the same ratio of critical damping at two frequencies."""

    kind: Literal["rayleigh"]
    ratio: DampingRatio
    """Ratio of critical damping at both frequencies."""
    frequencies: Annotated[
        tuple[float, ...],
        Several(Measured(FREQUENCY, above=0.0), exactly=2, increasing=True, example="[4.8 Hz, 43 Hz]"),
    ]
    """The two frequencies, the lower one first."""

    def coefficients(self) -> tuple[float, float]:
        """Return alpha [1/s] and beta [s]: ratio = alpha / (2 w) + beta w / 2 at both w."""
        low, high = (math.tau * frequency for frequency in self.frequencies)
        beta = 2.0 * self.ratio / (low + high)
        return beta * low * high, beta


class ModalDamping(Part):
    """One ratio of critical damping for all modes."""

    kind: Literal["modal"]
    ratio: DampingRatio
    """Ratio of critical damping."""


_KINDS = Kinds("damping", ("rayleigh", "modal"), "{kind: modal, ratio: 1 %}")


def _one_form(raw: Any) -> Any:
    """Refuse coefficients and ratio together: each form says all."""
    checked = _KINDS.checked(raw)
    if isinstance(checked, Mapping) and checked.get("kind") == "rayleigh":
        coefficients, ratios = {"alpha", "beta"} & checked.keys(), {"ratio", "frequencies"} & checked.keys()
        if coefficients and ratios:
            raise InputError(
                "has coefficients and a ratio", fix="Keep alpha and beta, or ratio and frequencies"
            )
    return checked


def _form(raw: Any) -> str:
    if isinstance(raw, Part):
        return {RayleighCoefficients: "<coefficients>", RayleighRatio: "<ratio>"}.get(type(raw), "<modal>")
    if raw["kind"] == "modal":
        return "<modal>"
    return "<coefficients>" if {"alpha", "beta"} & raw.keys() else "<ratio>"


StructuralDamping = Annotated[
    Annotated[RayleighCoefficients, tag("coefficients")]
    | Annotated[RayleighRatio, tag("ratio")]
    | Annotated[ModalDamping, tag("modal")],
    Discriminator(_form),
    BeforeValidator(_one_form),
]

"""The condition of a bridge: damage and temperature."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import Field, model_validator

from axlespan.errors import InputError
from axlespan.study.checks import Measured, Part
from axlespan.study.quantities import Length
from axlespan.units import NUMBER, RATIO


class DamagedZone(Part):
    """A zone along the bridge that has lost stiffness; its mass stays."""

    from_: Annotated[Length, Field(alias="from", examples=["10 m"])]
    """Where it begins."""
    to: Annotated[Length, Field(examples=["12 m"])]
    """Where it ends."""
    stiffness: Annotated[float, Measured(RATIO, above=0.0, at_most=2.0), Field(examples=["0.8"])]
    """Share of the stiffness that is left."""

    @model_validator(mode="after")
    def _forward(self) -> Self:
        if self.to <= self.from_:
            raise InputError("must be greater than from", field="to", fix="Exchange the two")
        return self


class Temperature(Part):
    """Stiffness that follows the temperature: E (1 + coefficient (value - reference))."""

    value: Annotated[float, Measured(NUMBER, at_least=-100.0, at_most=200.0), Field(examples=["25"])]
    """Temperature in degrees Celsius."""
    reference: Annotated[float, Measured(NUMBER, at_least=-100.0, at_most=200.0)] = 10.0
    """Temperature at which the stiffness is that of the structure."""
    coefficient: Annotated[float, Measured(NUMBER, at_least=-0.05, at_most=0.05), Field(examples=["-0.003"])]
    """Change of stiffness per degree, as a share."""

    @property
    def factor(self) -> float:
        """Factor on the stiffness."""
        return 1.0 + self.coefficient * (self.value - self.reference)

    @model_validator(mode="after")
    def _stiff(self) -> Self:
        if self.factor <= 0.0:
            raise InputError("leaves no stiffness at this temperature", field="coefficient")
        return self

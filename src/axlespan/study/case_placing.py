"""Where the vehicles of one entry of a train stand."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import Field, model_validator

from axlespan.errors import InputError
from axlespan.study.case_contact import KINDS as CONTACT_KINDS
from axlespan.study.case_contact import Contact
from axlespan.study.checks import Part
from axlespan.study.quantities import Distance, Few, Flag, Name, Spacing
from axlespan.units import LENGTH, show


class Placed(Part):
    """Vehicles of one kind, one behind the other."""

    count: Few = 1
    """Number of such vehicles."""
    spacing: Annotated[Spacing | None, Field(examples=["25 m"])] = None
    """Distance from the first wheel of one vehicle to the first wheel of the next."""
    gap: Distance | None = None
    """Distance of the first wheel behind the last wheel of the entry before."""
    offset: Distance | None = None
    """Distance of the first wheel behind the first wheel of the train."""
    contact: Annotated[Contact | None, Field(json_schema_extra=CONTACT_KINDS.words_in_schema)] = None
    """Law of contact of its wheels; that of the analysis when left out."""
    line: Annotated[Name | None, Field(examples=["left"])] = None
    """Running line of the structure that its wheels run on; the main one when left out."""
    reversed: Flag = False
    """Whether each vehicle runs the other way round, its last wheel ahead."""

    @property
    def needs_spacing(self) -> bool:
        """Whether several such vehicles need a spacing."""
        return True

    @model_validator(mode="after")
    def _spaced(self) -> Self:
        if self.gap is not None and self.offset is not None:
            raise InputError("says again where offset puts it", field="gap", fix="Keep one of the two")
        if self.count > 1 and self.spacing is None and self.needs_spacing:
            raise InputError(
                f"is missing for {self.count} vehicles",
                field="spacing",
                fix="Add spacing: 25 m, first wheel to first",
            )
        return self

    def require_room(self, wheelbase: float) -> None:
        """Require that the next vehicle's first wheel stands behind this one's last.

        Raises
        ------
        InputError
            With the field ``spacing``.
        """
        if self.count > 1 and self.spacing is not None and self.spacing <= wheelbase:
            raise InputError(
                f"must be more than {show(wheelbase, LENGTH)}, which is from the first wheel to the last",
                field="spacing",
            )

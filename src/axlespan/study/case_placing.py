"""Where the vehicles of one entry of a train stand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Self

from pydantic import Field, model_validator

from axlespan.errors import InputError
from axlespan.study.case_contact import KINDS as CONTACT_KINDS
from axlespan.study.case_contact import Contact
from axlespan.study.case_wheels import Flats, Patch, Waves
from axlespan.study.checks import Part
from axlespan.study.quantities import Distance, Few, Flag, Name, Spacing
from axlespan.units import LENGTH, show


class Placed(Part):
    """Vehicles of one kind, one behind the other."""

    count: Few = 1
    """Number of such vehicles; of a name that stands for a train, too: ``ice3`` has eight."""
    spacing: Annotated[Spacing | None, Field(examples=["25 m"])] = None
    """Distance from the first wheel of one vehicle to the first wheel of the next."""
    gap: Distance | None = None
    """Distance of the first wheel behind the last wheel of the entry before."""
    offset: Distance | None = None
    """Distance of the first wheel behind the first wheel of the train."""
    contact: Annotated[Contact | None, Field(json_schema_extra=CONTACT_KINDS.words_in_schema)] = None
    """Law of contact of its wheels; that of the analysis when left out."""
    contact_patch: Patch | None = None
    """Length over which its tyres feel the mean of the surface; they feel it at a point when left out."""
    wheel_flat: Annotated[Flats | None, Field(examples=["{length: 50 mm, wheels: [1.1]}"])] = None
    """A flat on its wheels, or several, each on wheels of its own."""
    out_of_round: Annotated[Waves | None, Field(examples=["{amplitude: 0.2 mm, order: 3}"])] = None
    """Waves around its wheels, or several orders of them."""
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


@dataclass(frozen=True)
class Unit:
    """What repeats in an entry: a vehicle, or a train of the library."""

    wheelbase: float  # from the first wheel to the last [m]
    count: int = 1
    pitch: float | None = None  # that the library gives, first wheel to first [m]
    front: float | None = None  # from the front buffer to the first wheel [m], where it is known
    rear: float | None = None  # from the last wheel to the rear buffer [m]


def first_wheels(train: Sequence[Placed], units: Sequence[Unit]) -> tuple[tuple[float, ...], ...]:
    """Return how far the first wheel of each unit is behind the first wheel of the train [m].

    Parameters
    ----------
    train : sequence of Placed
        The entries.
    units : sequence of Unit
        What repeats in each of them.

    Returns
    -------
    tuple of tuple of float
        For each entry, for each of its units.

    Raises
    ------
    InputError
        If an entry needs a spacing that nothing gives; the field counts from the train: ``"1.gap"``.
    """
    placed: list[tuple[float, ...]] = []
    for number, (entry, unit) in enumerate(zip(train, units, strict=True)):
        step = entry.spacing if entry.spacing is not None else unit.pitch
        if step is None and unit.count > 1:
            raise InputError(
                f"is missing for {unit.count} vehicles, and the library does not know it",
                field=f"{number}.spacing",
                fix="Add spacing: 25 m, first wheel to first",
            )
        head = 0.0
        if entry.offset is not None:
            head = entry.offset
        elif number:
            head = placed[-1][-1] + _room(number, train[number - 1], entry, units[number - 1], unit)
        placed.append(tuple(head + i * (step or 0.0) for i in range(unit.count)))
    return tuple(placed)


def _room(number: int, ahead: Placed, entry: Placed, first: Unit, second: Unit) -> float:
    """From the first wheel of the unit ahead to that of an entry [m]."""
    if entry.gap is not None:
        return first.wheelbase + entry.gap
    if ahead.spacing is not None:
        return ahead.spacing
    if first.rear is not None and second.front is not None:
        return first.wheelbase + first.rear + second.front
    if first.pitch is not None:
        return first.pitch
    raise InputError(
        f"does not say where it stands: the library does not know the length of train.{number - 1}",
        field=str(number),
        fix="Add gap: 3 m, its distance behind the last wheel ahead",
    )

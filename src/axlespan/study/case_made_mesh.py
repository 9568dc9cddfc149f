"""Meshes of equal cells, made from a few numbers of the case."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Self

from pydantic import Field, model_validator

from axlespan.errors import InputError
from axlespan.study.case_nodes import Point
from axlespan.study.check_lists import Several
from axlespan.study.checks import Checked, Measured, OneOf, Part, Whole
from axlespan.study.faults import InputErrors
from axlespan.study.quantities import Elements
from axlespan.units import LENGTH

Sides = Measured(LENGTH, above=0.0, believable=(1e-3, 1e4))


@dataclass(frozen=True)
class Divisions(Checked):
    """Numbers of cells along the axes."""

    exactly: int

    def read(self, raw: Any) -> tuple[int, ...]:
        """Return the numbers."""
        example = f"[{', '.join(['10'] * self.exactly)}]"
        if not isinstance(raw, (list, tuple)) or len(raw) != self.exactly:
            rule = f"must be a list of {self.exactly} whole numbers"
            raise InputError(rule, value=raw, fix=f"Write {example}")
        values, faults = [], []
        for number, one in enumerate(raw):
            try:
                values.append(Whole(at_most=100_000).read(one))
            except InputError as error:
                faults.append(InputError(error.rule, field=str(number), value=one, fix=error.fix))
        if faults:
            raise InputErrors(faults)
        return tuple(values)

    def json_schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        size = {"minItems": self.exactly, "maxItems": self.exactly}
        return {"type": "array", "items": Whole(at_most=100_000).json_schema(), **size}


class Box(Part):
    """Equal cells in a box; sets: volume, its faces x_min, x_max, ... and edges x_min/z_min, ..."""

    lengths: Annotated[tuple[float, ...], Several(Sides, exactly=3, example="[25 m, 2 m, 2.5 m]")]
    """Lengths along x, y and z."""
    divisions: Annotated[tuple[int, ...], Divisions(3), Field(examples=["[100, 10, 10]"])]
    """Numbers of cells along x, y and z."""
    origin: Point = (0.0, 0.0, 0.0)
    """The corner with the lowest coordinates."""
    elements: Annotated[str, OneOf(("hex8", "hex20", "wedge6", "tet4", "tet10"))] = "hex8"
    """Elements that the cells are made of."""


class Rectangle(Part):
    """Equal cells in a rectangle; sets: surface, its edges x_min, x_max, ... and corners x_min/y_min, ..."""

    lengths: Annotated[tuple[float, ...], Several(Sides, exactly=2, example="[25 m, 10 m]")]
    """Lengths along both of its axes."""
    divisions: Annotated[tuple[int, ...], Divisions(2), Field(examples=["[50, 20]"])]
    """Numbers of cells along both of its axes."""
    origin: Point = (0.0, 0.0, 0.0)
    """The corner with the lowest coordinates."""
    plane: Annotated[str, OneOf(("xy", "xz"))] = "xy"
    """Its axes."""
    elements: Annotated[str, OneOf(("quad4", "quad8", "tri3", "tri6"))] = "quad4"
    """Elements that the cells are made of."""


class Straight(Part):
    """Equal line elements; sets: line, start, end."""

    from_: Annotated[Point, Field(alias="from", examples=["[0 m, 0 m, 0 m]"])]
    """First point."""
    to: Annotated[Point, Field(examples=["[25 m, 0 m, 0 m]"])]
    """Last point."""
    divisions: Annotated[Elements, Field(examples=["50"])]
    """Number of elements."""


class MadeMesh(Part):
    """A mesh of equal cells: one of box, rectangle and line."""

    box: Box | None = None
    """Solids."""
    rectangle: Rectangle | None = None
    """Shells or planes."""
    line: Straight | None = None
    """Beams."""

    @model_validator(mode="after")
    def _one(self) -> Self:
        if len(self.given()) != 1:
            raise InputError(
                "must be one of box, rectangle and line",
                fix="Write {box: {lengths: [25 m, 2 m, 2.5 m], divisions: [50, 4, 5]}}",
            )
        return self

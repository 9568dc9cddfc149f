"""Nonlinear elements of one's own, written in Python."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from pydantic import Field

from axlespan.study.checks import Measured, Part
from axlespan.study.kinds import ExistingFile
from axlespan.study.quantities import Name, Text
from axlespan.units import NUMBER


class OwnElement(Part):
    """A nonlinear element of one's own: a class with force, tangent and advanced, in a Python file that is run to read it."""

    file: Annotated[Path, ExistingFile(), Field(examples=["cable.py"])]
    """Python file with the class. It is run when the case is read: use files that you trust."""
    element: Annotated[Name, Field(examples=["Cable"])]
    """Name of the class in it."""
    dofs: Annotated[tuple[Text, ...], Field(examples=["[n3.z, n6.z]"])]
    """D.o.f. on which it acts, by their names: n3.z on the third node of a beam, body.z and wheel1.z in a vehicle."""
    name: Name | None = None
    """Name in messages; that of the class when left out."""
    arguments: dict[Name, Annotated[float, Measured(NUMBER)]] = {}  # noqa: RUF012
    """Numbers that the class is made with, by their names."""


OwnElements = Annotated[
    tuple[OwnElement, ...], Field(examples=["[{file: cable.py, element: Cable, dofs: [n3.z, n6.z]}]"])
]

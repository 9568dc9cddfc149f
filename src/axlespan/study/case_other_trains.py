"""Further trains of a case: each with its vehicles, its movement and, if it differs, its irregularity."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from axlespan.study.case_crossing import Movement
from axlespan.study.case_irregularity import KINDS, Irregularity
from axlespan.study.case_train import Entry


class OtherTrain(Movement):
    """A train that is under way at the same time, on the same line or another."""

    train: Annotated[tuple[Entry, ...], Field(examples=["[{vehicle: ice3, count: 8}]"])]
    """Its vehicles, from its head; they are numbered on from those of the trains before."""
    irregularity: Annotated[Irregularity | None, Field(json_schema_extra=KINDS.words_in_schema)] = None
    """Irregularity of the surface; that of the crossing when left out."""

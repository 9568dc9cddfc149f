"""The crossing: how trains move, and on what surface."""

from __future__ import annotations

from typing import Annotated, Any, Self

from pydantic import ConfigDict, Field, model_validator

from axlespan.errors import InputError
from axlespan.study.case_irregularity import KINDS, Irregularity, NoIrregularity
from axlespan.study.check_lists import Table
from axlespan.study.checks import Measured, OneOf, Part
from axlespan.study.quantities import TRAIN_SPEED, Delay, Length, Name, Speed, TrainAcceleration
from axlespan.units import SPEED, TIME, show


def _either_speed(schema: dict[str, Any]) -> None:
    schema["oneOf"] = [{"required": ["speed"]}, {"required": ["speed_history"]}]


class Movement(Part):
    """How a train moves: at one speed, with an acceleration, or by a history of its speed."""

    model_config = ConfigDict(json_schema_extra=_either_speed)

    speed: Annotated[Speed | None, Field(examples=["80 km/h"])] = None
    """Speed, constant unless there is an acceleration."""
    speed_history: (
        Annotated[tuple[tuple[float, float], ...], Table(Measured(TIME, at_least=0.0), TRAIN_SPEED)] | None
    ) = None
    """Pairs of time and speed, linear between them and constant after the last."""
    acceleration: Annotated[TrainAcceleration | None, Field(examples=["0.5 m/s^2"])] = None
    """Constant acceleration from t = 0 on; negative brakes, to a stop unless to_speed is given."""
    to_speed: Annotated[Speed | None, Field(examples=["120 km/h"])] = None
    """Speed at which the acceleration ends."""
    start: Length | None = None
    """Position of the first wheel at t = 0, negative before the structure; 0 or, backward, the end of the line."""
    direction: Annotated[str, OneOf(("forward", "backward"))] = "forward"
    """Along increasing positions, or against them."""
    line: Annotated[Name | None, Field(examples=["track2"])] = None
    """Running line of the wheels that name none."""
    lines: Annotated[dict[str, Name] | None, Field(examples=["{left: left2, right: right2}"])] = None
    """Running lines of the structure, by the lines that the wheels name."""
    delay: Delay = 0.0
    """The train is at its start this much later than t = 0; before, it runs at its first speed."""

    @property
    def stands(self) -> bool:
        """Whether it never moves."""
        if self.speed_history is not None:
            return not any(v for _, v in self.speed_history)
        return self.speed == 0.0 and (self.acceleration or 0.0) <= 0.0

    @model_validator(mode="after")
    def _moves(self) -> Self:
        if self.speed is None and self.speed_history is None:
            raise InputError("is missing", field="speed", fix="Add speed: 80 km/h, or a speed_history")
        if self.speed is not None and self.speed_history is not None:
            raise InputError("says again what speed says", field="speed_history", fix="Keep one of the two")
        if self.speed_history is not None and self.speed_history[0][0] != 0.0:
            raise InputError("must begin at 0 s", field="speed_history.0.0", fix="Add the speed at 0 s")
        if self.line is not None and self.lines is not None:
            raise InputError("says again what line says", field="lines", fix="Keep one of the two")
        self._accelerates()
        if self.stands and "start" not in self.model_fields_set:
            field = "speed" if self.speed_history is None else "speed_history"
            raise InputError(
                "must be positive for a train that crosses",
                field=field,
                fix="A train that stands needs start: 12.5 m",
            )
        return self

    def _accelerates(self) -> None:
        """Check acceleration and to_speed."""
        if self.acceleration is None:
            if self.to_speed is not None:
                fix = "Add acceleration: 0.5 m/s^2"
                raise InputError("needs an acceleration", field="to_speed", fix=fix)
            return
        if self.speed is None:
            raise InputError(
                "goes with speed", field="acceleration", fix="Leave it out: speed_history says it"
            )
        if self.acceleration == 0.0:
            raise InputError(
                "must not be zero", field="acceleration", fix="Leave it out for a constant speed"
            )
        if self.to_speed is not None and (self.to_speed - self.speed) * self.acceleration <= 0.0:
            way = "more" if self.acceleration > 0.0 else "less"
            raise InputError(
                f"must be {way} than the speed, {show(self.speed, SPEED)}",
                field="to_speed",
                fix="A train that brakes has a negative acceleration" if way == "more" else None,
            )


class Crossing(Movement):
    """How the first train moves, and on what surface."""

    irregularity: Annotated[Irregularity, Field(json_schema_extra=KINDS.words_in_schema)] = NoIrregularity(
        kind="none"
    )
    """Irregularity of the surface; none when left out."""

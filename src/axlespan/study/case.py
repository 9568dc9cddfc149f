"""The case file: what is crossed by what, how, and what is wanted of it; in SI units, and frozen."""

from __future__ import annotations

from typing import Annotated, Any, Self

from pydantic import Field, model_validator

from axlespan.errors import InputError
from axlespan.study.case_analysis import Analysis, Output, SensorOnLine
from axlespan.study.case_assessment import Assessment
from axlespan.study.case_crossing import Crossing
from axlespan.study.case_other_trains import OtherTrain
from axlespan.study.case_structure import ContinuousBeam, Frame, SimpleSpan, SimpleSpans, Structure
from axlespan.study.case_train import Entry, check_order
from axlespan.study.checks import Part
from axlespan.study.faults import InputErrors
from axlespan.study.quantities import Line
from axlespan.units import LENGTH, TIME, show


class Case(Part):
    """A case: a train crosses a structure.

    Read one from a file with :func:`axlespan.study.load_case`, or make one by ``Case.model_validate`` of a
    mapping with the keys of the file.
    """

    title: Line = ""
    """What this case is."""
    structure: Annotated[Structure, Field(examples=["{kind: simple-span, length: 25 m, ...}"])]
    """What is crossed."""
    train: Annotated[tuple[Entry, ...], Field(examples=["[{vehicle: ice3, count: 8}]"])]
    """What crosses it: entries of equal vehicles, from the head of the train."""
    crossing: Annotated[Crossing, Field(examples=["{speed: 80 km/h}"])]
    """How it moves, on what surface."""
    other_trains: Annotated[
        tuple[OtherTrain, ...], Field(examples=["[{train: [{vehicle: ice3}], speed: 80 km/h}]"])
    ] = ()
    """Further trains that are under way at the same time."""
    analysis: Annotated[Analysis, Field(examples=["{time_step: 1 ms, steps: 14000}"])]
    """Time integration."""
    output: Output = Output()
    """What is recorded."""
    assessment: Annotated[Assessment | None, Field(examples=["{line_speed: 300 km/h}"])] = None
    """Rules of the code that the run is assessed by; none when left out."""

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        faults = [*_sensors_off(self), *_records_late(self), *_fields_late(self), *_spread_twice(self)]
        others = ((f"other_trains.{n}.train", other.train) for n, other in enumerate(self.other_trains))
        for path, train in (("train", self.train), *others):
            faults += _empty_train(train, path)
            try:
                check_order(train)
            except InputErrors as errors:
                faults += [InputError(e.rule, field=f"{path}.{e.field}", fix=e.fix) for e in errors.errors]
        if faults:
            raise InputErrors(faults)
        return self


def _empty_train(train: tuple[Entry, ...], path: str) -> list[InputError]:
    if train:
        return []
    return [InputError("has no vehicle", field=path, fix="Write train: [{vehicle: ice3, count: 8}]")]


def _sensors_off(case: Case) -> list[InputError]:
    """Find sensors that are not on a beam."""
    beam = case.structure
    if not isinstance(beam, (SimpleSpan, ContinuousBeam, SimpleSpans, Frame)):
        return []
    faults = []
    for name, at in case.output.sensors.items():
        if isinstance(at, SensorOnLine):
            continue  # lines are known when the structure is built
        if isinstance(at, str):
            rule = "must be a position along the beam; it has no named nodes"
            faults.append(
                InputError(rule, field=f"output.sensors.{name}", fix="Write a length, such as 12.5 m")
            )
        elif not -1e-9 * beam.length <= at <= (1.0 + 1e-9) * beam.length:
            rule = f"must lie on the beam, from 0 to {show(beam.length, LENGTH, 6)}"
            faults.append(InputError(rule, field=f"output.sensors.{name}"))
    return faults


def _spread_twice(case: Case) -> list[InputError]:
    """Find loads that sleepers shall share where there is a track."""
    if case.analysis.load_distribution is None or getattr(case.structure, "track", None) is None:
        return []
    rule = "must be left out: the structure has a track, whose rails spread the loads"
    return [InputError(rule, field="analysis.load_distribution")]


def _records_late(case: Case) -> list[InputError]:
    """Find steps between records of which the run has not as many."""
    steps = case.analysis.step_count
    if case.output.every <= steps:
        return []
    rule = f"must be at most {steps}, the number of steps: nothing but the start would be recorded"
    return [InputError(rule, field="output.every", fix=f"Write {max(1, steps // 1000)}")]


def _fields_late(case: Case) -> list[InputError]:
    """Find fields that are wanted after the end."""
    end = case.analysis.step_count * case.analysis.time_step
    wanted = case.output.fields
    if not isinstance(wanted, tuple):
        return []
    return [
        InputError(
            f"must be within the time that is simulated, {show(end, TIME)}", field=f"output.fields.{number}"
        )
        for number, time in enumerate(wanted)
        if time > end * (1.0 + 1e-9)
    ]


def schema() -> dict[str, Any]:
    """Return the JSON Schema (draft 2020-12) of the case file; descriptions name the units."""
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "axlespan case",
        **{key: value for key, value in Case.model_json_schema().items() if key != "title"},
    }

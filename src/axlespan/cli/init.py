"""``axlespan init``: a case file of one's own, from a few questions or from options."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import typer

from axlespan.cli.first_case import Wishes, text_of, usual_frequency
from axlespan.cli.messages import DONE, refuse, say
from axlespan.errors import InputError, Place
from axlespan.irregularity import spectrum_names
from axlespan.model.dofs import nearest
from axlespan.standards.bridge_values import BRIDGE_TYPES, structural_damping
from axlespan.units import (
    FREQUENCY,
    LENGTH,
    MASS_PER_LENGTH,
    RATIO,
    SECOND_MOMENT,
    SPEED,
    Dimension,
    parse,
    show,
)
from axlespan.vehicles import library, load_trains

T = TypeVar("T")

TRACKS = ("none", "ballasted", "slab")
_MOST_SPANS = 200


@dataclass(frozen=True)
class Options:
    """What the command line gave; None is asked for, or taken as usual."""

    spans: str | None = None
    bridge_type: str | None = None
    mass_per_length: str | None = None
    frequency: str | None = None
    second_moment: str | None = None
    damping: str | None = None
    track: str | None = None
    train: str | None = None
    speed: str | None = None
    irregularity: str | None = None
    line_speed: str | None = None


def write_case(file: Path, options: Options, *, force: bool, ask: bool | None = None) -> int:
    """Write a case file; the exit code."""
    asks = sys.stdin is not None and sys.stdin.isatty() if ask is None else ask
    try:
        if os.path.lexists(file) and not force:
            raise InputError("exists already", place=Place(str(file)), fix="Use --force to replace it")
        wishes = _wishes(options, asks)
        _written(file, text_of(wishes))
    except InputError as error:
        return refuse(error)
    say(f"Written to {file}. Look at it in your editor; what it is:")
    say(f"  axlespan check {file}")
    say(f"  axlespan run {file} -o {file.stem}")
    say(f"  axlespan report {file.stem}")
    return DONE


def _written(file: Path, text: str) -> None:
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
    except OSError as error:
        raise InputError(f"cannot be written: {error.strerror or error}", place=Place(str(file))) from None


def _wishes(options: Options, asks: bool) -> Wishes:
    """Everything that the file needs: given, asked for, or usual."""
    spans = _value("spans", options.spans, "Span, or spans from left to right", "25 m", _spans, asks)
    longest = max(spans)
    kind = _value(
        "bridge-type",
        options.bridge_type,
        f"Type of the bridge ({', '.join(BRIDGE_TYPES)})",
        "prestressed-concrete",
        _word("bridge type", BRIDGE_TYPES),
        asks,
    )
    mass = _value(
        "mass-per-length", options.mass_per_length, "Mass per length", "15 t/m", _of(MASS_PER_LENGTH), asks
    )
    frequency, second_moment = _stiffness(options, longest, asks)
    usual_damping = show(structural_damping(kind, longest), RATIO)
    damping = _value(
        "damping", options.damping, "Damping ratio (usual: EN 1991-2)", usual_damping, _of(RATIO), asks
    )
    track = _value(
        "track",
        options.track,
        f"Track ({', '.join(TRACKS)})",
        "none",
        _word("track", TRACKS),
        asks,
    )
    train = _value("train", options.train, "Train (axlespan library lists them)", "ice3", _train_name, asks)
    speed = _value("speed", options.speed, "Speed", "250 km/h", _of(SPEED), asks)
    irregularity = _value(
        "irregularity",
        options.irregularity,
        f"Irregularity (none, {'iso8608-b' if _is_road(train) else 'german-low'}, ...)",
        "none",
        _word("irregularity", ("none", *spectrum_names())),
        asks,
    )
    line_speed = _value(
        "line-speed",
        options.line_speed,
        "Line speed for the verdicts of the railway code, or none",
        "none" if _is_road(train) else show(speed, SPEED),
        lambda text: None if text.strip() == "none" else _of(SPEED)(text),
        asks,
    )
    length, has_masses = _train_facts(train)
    return Wishes(
        spans,
        mass,
        frequency,
        second_moment,
        kind,
        damping,
        track,
        train,
        length,
        speed,
        line_speed,
        irregularity,
        has_masses,
        _is_road(train),
    )


def _stiffness(options: Options, longest: float, asks: bool) -> tuple[float | None, float | None]:
    """First frequency of the longest span, or the second moment of area."""
    if options.frequency is not None and options.second_moment is not None:
        raise InputError("says again what frequency says", field="--second-moment", fix="Give one of the two")
    if options.second_moment is not None:
        value = _value("second-moment", options.second_moment, "", "", _of(SECOND_MOMENT), False)
        return None, value
    usual = show(usual_frequency(longest), FREQUENCY, 3)
    question = f"First natural frequency of the span of {show(longest, LENGTH)} (usual: EN 1991-2)"
    return _value("frequency", options.frequency, question, usual, _of(FREQUENCY), asks), None


def _value(
    name: str, given: str | None, question: str, usual: str, read: Callable[[str], T], asks: bool
) -> T:
    """Read what was given, ask until an answer can be read, or take what is usual."""
    if given is not None or not asks:
        try:
            return read(given if given is not None else usual)
        except InputError as error:
            raise InputError(error.rule, field=f"--{name}", value=given, fix=error.fix) from None
    while True:
        answer = typer.prompt(question, default=usual)
        try:
            return read(answer)
        except InputError as error:
            say(f"  {error}")


def _of(dimension: Dimension) -> Callable[[str], float]:
    def read(text: str) -> float:
        value = parse(text, dimension)
        if not value > 0.0:
            raise InputError("must be positive", value=text)
        return value

    return read


def _spans(text: str) -> tuple[float, ...]:
    parts = [part for part in text.replace(";", ",").split(",") if part.strip()]
    if not parts:
        raise InputError("must be a length, or several with commas between", value=text, fix="Write 25 m")
    spans: list[float] = []
    for part in parts:
        times, sign, length = re.sub(r"^\s*(\d+)\s*[x×*]\s*(?=\d)", r"\1×", part).partition("×")
        if sign and not 1 <= int(times) <= _MOST_SPANS:
            raise InputError(f"must have 1 to {_MOST_SPANS} spans", value=text)
        spans += [_of(LENGTH)((length if sign else part).strip())] * (int(times) if sign else 1)
    return tuple(spans)


def _word(what: str, words: tuple[str, ...]) -> Callable[[str], str]:
    def read(text: str) -> str:
        if text.strip() not in words:
            raise nearest(text.strip(), list(words), what)
        return text.strip()

    return read


def _train_name(text: str) -> str:
    return _word("name in the library", (*library.names(), *load_trains.names()))(text)


def _is_road(name: str) -> bool:
    """Whether it is a road vehicle, which the rules of railways do not judge."""
    return name in library.names() and library.entry(name).group == "road"


def _train_facts(name: str) -> tuple[float, bool]:
    """Distance from first to last wheel [m], and whether the train is more than forces."""
    if name in load_trains.names():
        return max(point.behind for point in load_trains.vehicle(name).contacts), False
    return library.train(name).wheelbase, True

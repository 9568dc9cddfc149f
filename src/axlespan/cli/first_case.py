"""The commented case file that ``axlespan init`` writes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from axlespan.standards.bridge_values import frequency_limits

_CONCRETE, _STEEL = "34 GPa", "210 GPa"


@dataclass(frozen=True)
class Wishes:
    """What is known of a case before it is written; SI units."""

    spans: Sequence[float]  # [m]
    mass_per_length: float  # [kg/m]
    frequency: float | None  # first natural frequency of the longest span [Hz]; None: second_moment is known
    second_moment: float | None  # [m^4]
    bridge_type: str
    damping: float  # ratio [-]
    track: str  # none, ballasted, slab
    train: str  # a word of the library
    train_length: float  # from first to last wheel [m]
    speed: float  # [m/s]
    line_speed: float | None  # [m/s]; None: no verdicts
    irregularity: str  # none, or a spectrum
    has_masses: bool  # whether the train is more than forces
    is_road: bool = False  # whether it runs on a road: no rails, no rules of railways


def usual_frequency(span: float) -> float:
    """A first frequency [Hz] in the middle of the bounds of EN 1991-2 figure 6.10 for a span [m]."""
    limits = frequency_limits(min(max(span, 4.0), 100.0))
    assert limits is not None  # within 4 to 100 m
    lower, upper = limits
    return math.sqrt(lower * upper)


def text_of(wishes: Wishes) -> str:
    """Return the file."""
    return "\n".join(
        [
            *_heading(wishes),
            *_structure(wishes),
            *_train(wishes),
            *_crossing(wishes),
            *_analysis(wishes),
            *_output(wishes),
            *_assessment(wishes),
            "",
        ]
    )


def _heading(wishes: Wishes) -> list[str]:
    spans = " + ".join(f"{span:g}" for span in wishes.spans)
    return [
        "# A case for axlespan. Check it with: axlespan check FILE; run it with: axlespan run FILE -o FOLDER",
        "# Numbers take units: 25 m, 2.87 GPa, 80 km/h. All keys: axlespan schema, or the page on the case file.",
        f"title: {wishes.train} over {spans} m at {_kmh(wishes.speed)}",
    ]


def _modulus(bridge_type: str) -> str:
    return _STEEL if bridge_type == "steel" else _CONCRETE


def _structure(wishes: Wishes) -> list[str]:
    longest = max(wishes.spans)
    modulus = _modulus(wishes.bridge_type)
    frequency = wishes.frequency
    if wishes.second_moment is not None:
        second_moment, origin = wishes.second_moment, ""
        stiffness = float(modulus.split()[0]) * 1e9 * second_moment
        frequency = math.pi / 2.0 * math.sqrt(stiffness / wishes.mass_per_length) / longest**2
    else:
        assert frequency is not None
        stiffness = wishes.mass_per_length * (2.0 * longest**2 * frequency / math.pi) ** 2
        second_moment = stiffness / (float(modulus.split()[0]) * 1e9)
        origin = f"  # gives {longest:g} m of it, simply supported, {frequency:.3g} Hz"
    single = len(wishes.spans) == 1
    where = (
        [f"  length: {longest:g} m"]
        if single
        else ["  spans:", *(f"    - {{length: {span:g} m}}" for span in wishes.spans)]
    )
    on_it = "pavement" if wishes.is_road else "ballast, rails"
    elements = max(20, math.ceil(longest)) if single else max(12, math.ceil(longest / 2.0))
    lines = [
        "",
        "structure:",
        f"  kind: {'simple-span' if single else 'continuous-beam'}",
        *where,
        f"  youngs_modulus: {modulus}",
        f"  second_moment: {second_moment:.4g} m^4{origin}",
        f"  mass_per_length: {wishes.mass_per_length / 1e3:g} t/m  # with {on_it} and all that stays",
        f"  elements: {elements}{'' if single else '  # in each span'}",
        f"  damping: {{kind: rayleigh, ratio: {100.0 * wishes.damping:g} %, frequencies: "
        f"[{frequency:.3g} Hz, {4.0 * frequency:.3g} Hz]}}",
    ]
    if wishes.track == "none" and wishes.is_road:
        return lines
    if wishes.track == "none":
        return [
            *lines,
            "  # track: {kind: ballasted}  # rails, pads, sleepers and ballast, on the ground too",
        ]
    return [*lines, f"  track: {{kind: {wishes.track}}}  # presets with their sources: axlespan library"]


def _train(wishes: Wishes) -> list[str]:
    return [
        "",
        "train:",
        f"  - {{vehicle: {wishes.train}}}  # others: axlespan library; a file of your own: {{vehicle: my.yaml}}",
    ]


def _crossing(wishes: Wishes) -> list[str]:
    lines = ["", "crossing:", f"  speed: {_kmh(wishes.speed)}"]
    if wishes.track != "none":
        lines.append("  start: -15 m  # before the bridge, where rails that do not move at first do no harm")
    if wishes.irregularity == "none":
        usual = "iso8608-b" if wishes.is_road else "german-low"
        return [*lines, f"  # irregularity: {{kind: spectrum, name: {usual}, seed: 1}}"]
    return [*lines, f"  irregularity: {{kind: spectrum, name: {wishes.irregularity}, seed: 1}}"]


def _analysis(wishes: Wishes) -> list[str]:
    way = sum(wishes.spans) + wishes.train_length + (60.0 if wishes.track != "none" else 0.0)
    duration = math.ceil(10.0 * (way / wishes.speed + 1.0)) / 10.0
    step = "1 ms" if wishes.speed > 10.0 else "2 ms"
    return [
        "",
        "analysis:",
        f"  time_step: {step}",
        f"  duration: {duration:g} s  # the last wheel leaves the bridge, and a second more",
        "  # vehicles: axle-loads  # the same train as forces: what does interaction change?"
        if wishes.has_masses
        else "  # The train is a row of forces; a train of vehicles, such as ice3, interacts with the bridge.",
    ]


def _output(wishes: Wishes) -> list[str]:
    ends = [0.0]
    for span in wishes.spans:
        ends.append(ends[-1] + span)
    middles = [0.5 * (left + right) for left, right in pairwise(ends)]
    if len(middles) == 1:
        return ["", "output:", "  sensors:", f"    midspan: {middles[0]:g} m"]
    named = [f"    span {i + 1}: {middle:g} m" for i, middle in enumerate(middles)]
    return ["", "output:", "  sensors:", *named]


def _assessment(wishes: Wishes) -> list[str]:
    if wishes.line_speed is None and wishes.is_road:
        return []
    if wishes.line_speed is None:
        return [
            "",
            "# Verdicts of EN 1990 and EN 1991-2:",
            "# assessment: {line_speed: 200 km/h, deck: ballasted, bridge_type: prestressed-concrete}",
        ]
    return [
        "",
        "assessment:  # verdicts of EN 1990 A2.4.4 and EN 1991-2 6.4; limits of your own: limits: {...}",
        f"  line_speed: {_kmh(wishes.line_speed)}",
        f"  deck: {'unballasted' if wishes.track == 'slab' else 'ballasted'}",
        f"  bridge_type: {wishes.bridge_type}",
    ]


def _kmh(speed: float) -> str:
    return f"{3.6 * speed:.6g} km/h"

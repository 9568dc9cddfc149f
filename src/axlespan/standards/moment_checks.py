"""The envelope of bending moments against that of load model 71."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError
from axlespan.linalg.factor import NotPositiveDefinite
from axlespan.model.motions import Constant
from axlespan.standards import dynamic_factors, lm71
from axlespan.standards.bridge_checks import added_share, not_possible, static_factor, wheels_behind
from axlespan.standards.given import Given
from axlespan.standards.influence import moment_lines
from axlespan.standards.limits import limit_of
from axlespan.standards.lm71 import InfluenceLine
from axlespan.standards.verdict import Verdict, judged, not_assessed

FloatArray = npt.NDArray[np.float64]

# Sections count where LM71 has at least this share of its largest moment of that sign, and signs that have at
# least this share of the largest moment of all: elsewhere both are next to nothing.
_COUNTS = 0.2

_SIGNS = ((1.0, "sagging"), (-1.0, "hogging"))


def dynamic_moment(given: Given) -> list[Verdict]:
    """Largest moments of the run with φ''/2 over those of Φ × LM71, section by section."""
    check, clause = "dynamic_moment", "EN 1991-2 6.4.6.5"
    quantity = "envelope of moments, with φ''/2, over Φ × LM71"
    reason = not_possible(given) or _unknown(given)
    static: _Static | None = None
    if not reason:
        static = given.at_rest.get("moments", lambda: _static(given))
        reason = static.reason
    if reason or static is None:
        return [not_assessed(check, clause, quantity, reason, source=lm71.SOURCE)]
    assert given.result.envelopes is not None
    table, position = given.result.envelopes.of("moment"), given.result.envelopes.position
    factor, name = static_factor(given)
    second, _ = added_share(given)
    model = {sign: factor * static.model[sign] for sign, _ in _SIGNS}
    best: tuple[float, int, str, float, float] | None = None
    for sign, word in _SIGNS:
        run = table.largest if sign > 0.0 else -table.smallest
        when = table.time_of_largest if sign > 0.0 else table.time_of_smallest
        for i, train in static.train[sign].items():
            ratio = (max(float(run[i]), 0.0) + second * train) / float(model[sign][i])
            if best is None or ratio > best[0]:
                best = (ratio, i, word, float(when[i]), float(run[i]))
    assert best is not None
    ratio, i, word, time, moment = best
    limit = limit_of("dynamic_effect", given.assessment)
    own = float(model[1.0 if word == "sagging" else -1.0][i])
    note = (
        f"{word} {moment / 1e3:.0f} kNm of the run, {name} × LM71 {own / 1e3:.0f} kNm, {name} = {factor:.3f}"
    )
    return [
        judged(
            check,
            clause,
            quantity,
            ratio,
            limit.value,
            "",
            where=f"{position[i]:.4g} m",
            when=time,
            source=f"{limit.source}; {dynamic_factors.SOURCE}",
            note=note + ("; the train governs, not LM71" if ratio > 1.0 else ""),
        )
    ]


@dataclass(frozen=True, eq=False)
class _Static:
    """Moments at rest [N m] by their sign, in the sections of the envelope."""

    model: Mapping[float, FloatArray]  # (n,) of LM71, without dynamic factor
    train: Mapping[float, Mapping[int, float]]  # of the train, in the sections that count
    reason: str = ""  # why they are not known


def _static(given: Given) -> _Static:
    assert given.crossing is not None and given.result.envelopes is not None
    try:
        lines = moment_lines(given.crossing.structure, given.result.envelopes.position)
    except (InputError, NotPositiveDefinite) as error:
        return _Static({}, {}, f"influence lines cannot be computed: {error}")
    model = {sign: _of_model(given, lines, sign) for sign, _ in _SIGNS}
    most = max(float(values.max()) for values in model.values())
    loads, behind = given.static_forces, wheels_behind(given)
    train = {
        sign: {
            int(i): lm71.train_effect(lines[i], loads, behind, sign=sign)
            for i in np.flatnonzero(model[sign] >= _COUNTS * most)
        }
        for sign, _ in _SIGNS
    }
    return _Static(model, train)


def _unknown(given: Given) -> str:
    """Why the moments of traffic are not known; empty if they are."""
    if given.result.envelopes is None or "moment" not in given.result.envelopes.tables:
        return "the envelope of moments was not recorded: write envelopes: [moment] under output"
    assert given.crossing is not None
    system = given.crossing.structure.system
    still = all(isinstance(motion, Constant) and motion.amount == 0.0 for motion in system.motions)
    return "" if still and not system.loads else "the moments are those of loads and moved supports too"


def _of_model(given: Given, lines: list[InfluenceLine], sign: float) -> FloatArray:
    """Moments (n,) of LM71, on continuous beams of SW/0 too, in a direction."""
    alpha = given.assessment.alpha
    found = [lm71.lm71_effect(line, sign=sign, alpha=alpha) for line in lines]
    if given.facts.continuous:
        found = [
            max(one, lm71.sw0_effect(line, sign=sign, alpha=alpha))
            for one, line in zip(found, lines, strict=True)
        ]
    return np.array(found)

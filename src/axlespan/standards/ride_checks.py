"""Checks of the passengers' ride: car-body acceleration, and the comfort of EN 12299, ISO 2631-1 and Sperling."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import numpy.typing as npt

from axlespan.standards import comfort
from axlespan.standards.given import Given
from axlespan.standards.limits import limit_of
from axlespan.standards.verdict import Verdict, judged, not_assessed

FloatArray = npt.NDArray[np.float64]

_NO_BODY = "no vehicle of the run has a car body that moves"


def body_accelerations(given: Given) -> Iterator[tuple[str, FloatArray]]:
    """Vertical accelerations (n_time,) [m/s^2] of car bodies, at the center and over both bogies where known."""
    table = given.result.vehicle_acceleration
    for body, column, pitch in given.bodies():
        yield f"{body}, center", table[:, column]
        lever = given.lever(body)
        if pitch is not None and lever is not None:
            yield f"{body}, over the front bogie", table[:, column] - lever * table[:, pitch]
            yield f"{body}, over the rear bogie", table[:, column] + lever * table[:, pitch]


def body_acceleration(given: Given) -> list[Verdict]:
    """Largest vertical acceleration b_v in the coaches."""
    check, clause = "body_acceleration", "EN 1990 A2.4.4.3"
    quantity = "vertical acceleration b_v of the car body"
    best: tuple[float, str, int] | None = None
    for where, history in body_accelerations(given):
        row = int(np.argmax(np.abs(history)))
        if best is None or abs(history[row]) > best[0]:
            best = (float(abs(history[row])), where, row)
    if best is None:
        return [not_assessed(check, clause, quantity, _NO_BODY)]
    limit = limit_of(check, given.assessment)
    note = f"comfort {given.assessment.comfort}; all frequencies"
    return [
        judged(
            check,
            clause,
            quantity,
            best[0],
            limit.value,
            "m/s^2",
            where=best[1],
            when=float(given.result.time[best[2]]),
            source=limit.source,
            note=note,
        )
    ]


def continuous_comfort(given: Given) -> list[Verdict]:
    """Largest Wb-weighted rms of 5 s in any coach."""
    return _index(
        given,
        "continuous_comfort",
        "EN 12299, C_Cz",
        "continuous comfort C_Cz, Wb-weighted rms of 5 s",
        comfort.BLOCK,
        "m/s^2",
        comfort.continuous_comfort,
        comfort.CONTINUOUS_CLASSES,
        comfort.EN12299,
    )


def mean_comfort(given: Given) -> list[Verdict]:
    """Vertical part of the mean comfort N_MV."""
    return _index(
        given,
        "mean_comfort",
        "EN 12299, N_MV",
        "mean comfort, vertical part of N_MV",
        comfort.BLOCK * comfort.BLOCKS,
        "",
        comfort.mean_comfort,
        comfort.MEAN_CLASSES,
        comfort.EN12299,
    )


def weighted_rms(given: Given) -> list[Verdict]:
    """Wk-weighted rms over the run."""
    return _index(
        given,
        "weighted_rms",
        "ISO 2631-1, a_w",
        "Wk-weighted rms acceleration of the car body",
        comfort.BLOCK,
        "m/s^2",
        comfort.weighted_rms,
        comfort.ISO_CLASSES,
        comfort.ISO2631,
    )


def sperling(given: Given) -> list[Verdict]:
    """Sperling's ride index of the worst 5 s."""
    return _index(
        given,
        "sperling",
        "Sperling",
        "ride index W, worst 5 s",
        comfort.BLOCK,
        "",
        comfort.sperling,
        comfort.SPERLING_CLASSES,
        comfort.SPERLING,
    )


def _index(
    given: Given,
    check: str,
    clause: str,
    quantity: str,
    seconds: float,
    unit: str,
    rule: Callable[[FloatArray, float], float | None],
    classes: tuple[tuple[float, str], ...],
    source: str,
) -> list[Verdict]:
    """The worst of all coaches by one rule; reported, unless the assessment has a limit."""
    histories = list(body_accelerations(given))
    if not histories:
        return [not_assessed(check, clause, quantity, _NO_BODY, source=source)]
    reason = given.too_short(seconds)
    if reason:
        return [not_assessed(check, clause, quantity, reason, source=source)]
    if given.interval > 1.0 / 100.0:
        reason = f"records are {given.interval:.3g} s apart; the weighting asks for 0.01 s"
        return [not_assessed(check, clause, quantity, reason, source=source)]
    values = [(rule(history, given.interval) or 0.0, where) for where, history in histories]
    value, where = max(values)
    limit = limit_of(check, given.assessment)
    note = comfort.in_class(value, classes)
    own = limit.source if limit.value is not None else source
    return [judged(check, clause, quantity, value, limit.value, unit, where=where, source=own, note=note)]

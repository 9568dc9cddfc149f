"""What a study says: envelopes over speed, critical speeds, resonances, distributions, verdicts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

import axlespan
from axlespan.errors import AxlespanError, InputError
from axlespan.study.sweep.peaks import COMPLETED, OF_SENSORS
from axlespan.study.sweep.resonance import Resonances, resonances_of
from axlespan.study.sweep.statistics import QUANTILES, Distribution

if TYPE_CHECKING:
    from axlespan.study.sweep.store import Store
    from axlespan.study.sweep.study import Study

FloatArray = npt.NDArray[np.float64]

# Quantities of which the smallest value counts.
_LOWEST: Final = ("contact_force_min_N", "displacement_min_m")
_OF_LINE: Final = (
    "line_acceleration_max_m_per_s2",
    "line_displacement_min_m",
    "line_displacement_max_m",
    "contact_force_max_N",
    "contact_force_min_N",
    "unloading_max",
    "body_acceleration_max_m_per_s2",
)
# Structures up to which resonances are looked for.
_STRUCTURES: Final = 10


@dataclass(frozen=True, eq=False)
class Envelope:
    """The worst of a quantity at each speed, over all else that varies."""

    speed: FloatArray  # (n,) [m/s], ascending
    value: FloatArray  # (n,) [unit of the quantity]
    id: npt.NDArray[np.int64]  # (n,) the scenario it comes from
    lowest: bool = False  # whether the smallest value is the worst, as of a contact force

    @property
    def worst(self) -> int:
        """Where it is worst: the speed there is the critical one."""
        return int(self.value.argmin() if self.lowest else np.abs(self.value).argmax())


@dataclass(frozen=True, eq=False)
class Answers:
    """What the rows of a store say."""

    title: str
    scenarios: int
    columns: Mapping[str, npt.NDArray[Any]]
    random: bool = False
    resonances: Mapping[str, Resonances] = field(default_factory=dict)  # by train

    @classmethod
    def of_store(cls, store: Store, study: Study | None = None) -> Answers:
        """The answers that a store gives now."""
        header = store.header
        sensors = [name for name in header.columns if name.startswith("sensor.")]
        verdicts = [name for name in header.columns if name.startswith(("verdict", "utilization"))]
        own = ["id", "outcome", "reason", "train_name", "speed_m_per_s", "seconds", "steps", "passed"]
        columns = store.arrays(list(dict.fromkeys([*own, *_OF_LINE, *sensors, *verdicts, *header.paths])))
        answers = cls(header.title, header.scenarios, columns, bool(study and study.spec.sampling))
        if study is None or not len(columns["id"]):
            return answers
        try:
            found = resonances_of(study, answers.trains, _STRUCTURES)
        except AxlespanError:  # the answers are worth having without them
            found = {}
        return cls(answers.title, answers.scenarios, columns, answers.random, found)

    # --- rows ----------------------------------------------------------------------------------

    @property
    def completed(self) -> npt.NDArray[np.bool_]:
        """Rows that hold results (n_row,)."""
        return np.asarray(self.columns["outcome"] == COMPLETED)

    @property
    def failed(self) -> int:
        """Rows that hold a reason in place of results."""
        return int((~self.completed).sum()) if len(self.columns["id"]) else 0

    @property
    def trains(self) -> list[str]:
        """Names of the trains, in the order of the scenarios."""
        return (
            list(dict.fromkeys(self.columns["train_name"][self.completed].tolist()))
            if len(self.columns["id"])
            else []
        )

    @property
    def quantities(self) -> list[str]:
        """Quantities that have values."""
        names = [name for name in self.columns if name in _OF_LINE or name.rpartition(".")[2] in OF_SENSORS]
        return [name for name in names if np.isfinite(self._numbers(name)[self.completed]).any()]

    @property
    def varying(self) -> list[str]:
        """Quantities that differ between scenarios; contact forces if they are not all those at rest."""
        names = [name for name in self.quantities if np.ptp(self.distribution(name).values) > 0.0]
        dynamic = "unloading_max" in names
        return [name for name in names if dynamic or not name.startswith("contact_force")]

    def _numbers(self, name: str) -> FloatArray:
        if name not in self.columns:
            known = ", ".join(list(self.columns)[:20])
            raise InputError("is no column of the table", field="quantity", value=name, fix=f"Known: {known}")
        return np.asarray(self.columns[name], dtype=np.float64)

    # --- over speed ----------------------------------------------------------------------------

    def envelope(self, quantity: str, train: str | None = None) -> Envelope:
        """The worst of a quantity at each speed, of one train or of all.

        Raises
        ------
        InputError
            If there is no such quantity or train.
        """
        values, speeds = self._numbers(quantity), self._numbers("speed_m_per_s")
        use = self.completed & np.isfinite(values)
        if train is not None:
            if train not in self.trains:
                raise InputError(
                    "is not among the trains",
                    field="train",
                    value=train,
                    fix=f"Known: {', '.join(self.trains)}",
                )
            use = use & (self.columns["train_name"] == train)
        lowest = quantity.endswith(_LOWEST)
        sign = 1.0 if lowest else -1.0
        rows = np.flatnonzero(use)
        rows = rows[np.lexsort((sign * values[rows], speeds[rows]))]
        first = np.flatnonzero(np.diff(speeds[rows], prepend=-np.inf) > 0.0)
        rows = rows[first]
        return Envelope(
            speeds[rows], values[rows], np.asarray(self.columns["id"])[rows].astype(np.int64), lowest
        )

    def critical(self, quantity: str) -> dict[str, tuple[float, float]]:
        """Critical speed [m/s] of each train, and what the quantity reaches there."""
        found = {}
        for train in self.trains:
            envelope = self.envelope(quantity, train)
            if len(envelope.speed):
                found[train] = (float(envelope.speed[envelope.worst]), float(envelope.value[envelope.worst]))
        return found

    # --- random studies ------------------------------------------------------------------------

    def distribution(self, quantity: str) -> Distribution:
        """All values of a quantity, as a sample.

        Raises
        ------
        InputError
            If there is no such quantity, or it has no values.
        """
        found = Distribution.of(self._numbers(quantity)[self.completed])
        if not len(found.values):
            raise InputError("has no values in this study", field="quantity", value=quantity)
        return found

    # --- verdicts ------------------------------------------------------------------------------

    @property
    def verdicts(self) -> dict[str, int]:
        """How many scenarios have which verdict."""
        if "verdict" not in self.columns:
            return {}
        words, counts = np.unique(
            [word for word in self.columns["verdict"].tolist() if isinstance(word, str) and word],
            return_counts=True,
        )
        return dict(zip(words.tolist(), counts.tolist(), strict=True))

    @property
    def verdict(self) -> str | None:
        """Verdict of the study: fail if one scenario fails; None where nothing was assessed."""
        found = self.verdicts
        return next((word for word in ("fail", "not assessed", "pass") if word in found), None)

    def checks(self) -> dict[str, dict[str, Any]]:
        """Of each check: how many scenarios have which outcome, the largest utilization, and where that is."""
        found: dict[str, dict[str, Any]] = {}
        for name in self.columns:
            check = name.removeprefix("verdict.")
            if check == name:
                continue
            words = [word for word in self.columns[name].tolist() if isinstance(word, str)]
            outcomes = {word: words.count(word) for word in dict.fromkeys(words)}
            if not set(outcomes) & {"pass", "fail"}:
                continue
            shares = self._numbers(f"utilization.{check}")
            found[check] = {"outcomes": outcomes}
            if np.isfinite(shares).any():
                row = int(np.nanargmax(shares))
                found[check] |= {
                    "utilization": float(shares[row]),
                    "id": int(self.columns["id"][row]),
                    "train": str(self.columns["train_name"][row]),
                    "speed_m_per_s": float(self.columns["speed_m_per_s"][row]),
                }
        return found

    # --- in words ------------------------------------------------------------------------------

    def summary(self) -> dict[str, Any]:
        """All of it, for summary.json; names carry their units."""
        reasons = [str(r) for r in self.columns["reason"][~self.completed].tolist()] if self.failed else []
        content: dict[str, Any] = {
            "format": "axlespan study summary",
            "format_version": 1,
            "version": axlespan.__version__,
            "title": self.title,
            "scenarios": self.scenarios,
            "completed": int(self.completed.sum()),
            "failed": self.failed,
            "first_reasons": list(dict.fromkeys(reasons))[:10],
            "not_passed": int((self.columns["passed"][self.completed] == False).sum()),  # noqa: E712
            "verdict": self.verdict,
            "verdicts": self.verdicts,
            "checks": self.checks(),
            "processor_seconds_in_march": float(np.nansum(self._numbers("seconds"))),
            "quantities": {name: self._of_quantity(name) for name in self.quantities},
            "resonances": {train: found.summary() for train, found in self.resonances.items()},
        }
        return content

    def _of_quantity(self, name: str) -> dict[str, Any]:
        envelope = self.envelope(name)
        content: dict[str, Any] = {
            "worst": envelope.value[envelope.worst],
            "worst_id": envelope.id[envelope.worst],
            "worst_speed_m_per_s": envelope.speed[envelope.worst],
        }
        by_train = self.critical(name)
        if len(by_train) <= 100:
            content["trains"] = {
                train: {"critical_speed_m_per_s": speed, "worst": value}
                for train, (speed, value) in by_train.items()
            }
        if self.random:
            content["distribution"] = _distribution(self.distribution(name))
        return content

    def lines(self) -> list[str]:
        """A table for people: worst values and critical speeds of each train."""
        done = int(self.completed.sum())
        lines = [f"{self.title}: {done} of {self.scenarios} scenarios completed, {self.failed} failed"]
        if self.failed:
            reasons = dict.fromkeys(map(str, self.columns["reason"][~self.completed].tolist()))
            lines += [f"  failed      {reason}" for reason in list(reasons)[:3]]
        late = int((self.columns["passed"][self.completed] == False).sum())  # noqa: E712
        if late:
            lines.append(
                f"  warning     in {late} the train has not left the structure at the end; passage: {{after: 1 s}} mends that"
            )
        shown = [name for name in (self.varying or self.quantities) if name in _OF_LINE]
        trains = self.trains
        if shown and done:
            width = min(max(map(len, [*trains, "all trains"])), 30)
            for name in shown:
                lines.append(f"  {_in_words(name)}")
                criticals = self.critical(name)
                lowest = name.endswith(_LOWEST)
                order = {train: value if lowest else -abs(value) for train, (_, value) in criticals.items()}
                ranked = [(train, criticals[train]) for train in sorted(order, key=order.__getitem__)]
                lines += [
                    f"    {train[:width]:{width}}  {_scaled(name, value)} at {3.6 * speed:.4g} km/h"
                    for train, (speed, value) in ranked[:5]
                ]
                if len(ranked) > 5:
                    lines.append(f"    ... and {len(ranked) - 5} more trains")
                if self.random:
                    spread = self.distribution(name)
                    share, side = (0.05, "above") if lowest else (0.95, "below")
                    low, high = spread.interval(share)
                    lines.append(
                        f"    mean {_scaled(name, spread.mean)} ± {_scaled(name, spread.standard_error)} (standard error), "
                        f"95 % {side} {_scaled(name, spread.quantile(share))} "
                        f"(95 % confidence: {_scaled(name, low)} to {_scaled(name, high)})"
                    )
        if self.verdict is not None:
            counts = ", ".join(f"{count} {word}" for word, count in self.verdicts.items())
            lines.append(f"  verdict     {self.verdict} ({counts})")
            for check, about in self.checks().items():
                failed = about["outcomes"].get("fail", 0)
                text = f"{failed} fail" if failed else "pass"
                if "utilization" in about:
                    where = f"{about['train']}, {3.6 * about['speed_m_per_s']:.4g} km/h"
                    text += f", at most {about['utilization']:.3g} of the limit ({where})"
                lines.append(f"    {check.replace('_', ' '):18} {text}")
        return lines


def _distribution(found: Distribution) -> dict[str, Any]:
    return {
        "samples": len(found.values),
        "mean": found.mean,
        "standard_error": found.standard_error,
        "std": found.std,
        "quantiles": {
            f"{share:g}": {"value": found.quantile(share), "confidence_95": found.interval(share)}
            for share in QUANTILES
        },
    }


_WORDS: Final[Mapping[str, tuple[str, str, float]]] = {
    "line_acceleration_max_m_per_s2": ("largest acceleration along the line", "m/s²", 1.0),
    "line_displacement_min_m": ("largest displacement downward", "mm", 1e3),
    "line_displacement_max_m": ("largest displacement upward", "mm", 1e3),
    "contact_force_max_N": ("largest contact force", "kN", 1e-3),
    "contact_force_min_N": ("smallest contact force", "kN", 1e-3),
    "unloading_max": ("largest unloading of a wheel", "%", 100.0),
    "body_acceleration_max_m_per_s2": ("largest vertical acceleration of a body", "m/s²", 1.0),
}


def label_of(quantity: str) -> tuple[str, str, float]:
    """Name of a quantity in words, its unit there, and the factor from the column to it."""
    if quantity in _WORDS:
        return _WORDS[quantity]
    name = quantity.removeprefix("sensor.")
    for end, unit, factor in (("_m_per_s2", "m/s²", 1.0), ("_m_per_s", "m/s", 1.0), ("_m", "mm", 1e3)):
        if name.endswith(end):
            return name.removesuffix(end).replace("_", " ").replace(".", ": ", 1), unit, factor
    return name, "", 1.0


def _in_words(quantity: str) -> str:
    return label_of(quantity)[0]


def _scaled(quantity: str, value: float) -> str:
    _, unit, factor = label_of(quantity)
    return f"{value * factor:.4g} {unit}"


__all__ = ["Answers", "Envelope", "label_of"]

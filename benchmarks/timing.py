"""Timing of alternatives in turns, so that a machine whose speed drifts is fair to all of them.

Times are of the processor, with one thread the same as those of the clock where nothing else runs.
"""

from __future__ import annotations

import importlib.metadata
import json
import os
import platform
import statistics
import time
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path

import numpy as np
import scipy

import axlespan

#: The fact that ratios compare, where an alternative has it; the whole time else.
COST = "us/step"


@dataclass
class Row:
    """One measured alternative."""

    benchmark: str
    name: str
    seconds: list[float]  # of each run
    ratio: float  # of the cost to that of the first alternative: median of the ratios run by run
    facts: Mapping[str, float | str] = field(default_factory=dict)

    @property
    def median(self) -> float:
        return statistics.median(self.seconds)


def in_turns(
    benchmark: str, alternatives: Mapping[str, Callable[[], Mapping[str, float | str] | None]], runs: int = 3
) -> list[Row]:
    """Time alternatives A B C A B C …; the first one is what the ratios refer to."""
    seconds: dict[str, list[float]] = {name: [] for name in alternatives}
    costs: dict[str, list[float]] = {name: [] for name in alternatives}
    facts: dict[str, list[Mapping[str, float | str]]] = {name: [] for name in alternatives}
    for _ in range(runs):
        for name, work in alternatives.items():
            begun = time.process_time()
            facts[name].append(work() or {})
            seconds[name].append(time.process_time() - begun)
            costs[name].append(float(facts[name][-1].get(COST, seconds[name][-1])))
    first = costs[next(iter(alternatives))]
    return [
        Row(
            benchmark,
            name,
            seconds[name],
            statistics.median(cost / one for cost, one in zip(costs[name], first, strict=True)),
            _medians(facts[name]),
        )
        for name in alternatives
    ]


def _medians(facts: list[Mapping[str, float | str]]) -> Mapping[str, float | str]:
    """Medians of the numbers of several runs, and the words of the last."""
    return {
        name: statistics.median(float(fact[name]) for fact in facts) if isinstance(last, float) else last
        for name, last in facts[-1].items()
    }


def per_step(
    simulate: Callable[[int], object], steps: int, crossings: int = 1, first: int = 1
) -> dict[str, float | str]:
    """Cost of a step of a crossing all in [µs], and of all before [s]: a run of the first steps, and a long one."""
    begun = time.process_time()
    simulate(first)
    setup = time.process_time() - begun
    begun = time.process_time()
    simulate(steps)
    whole = time.process_time() - begun
    return {COST: 1e6 * (whole - setup) / ((steps - first) * crossings), "before s": setup}


def machine() -> dict[str, str | int]:
    """What the figures were measured on."""
    model = next(
        (line.split(":")[1].strip() for line in _cpu_lines() if line.startswith("model name")),
        platform.processor(),
    )
    return {
        "processor": model,
        "cores": os.cpu_count() or 0,
        "python": platform.python_version(),
        "numpy": np.__version__,
        "scipy": scipy.__version__,
        "axlespan": axlespan.__version__,
        **{name: _version(name) for name in ("numba", "mkl")},
        "threads": os.environ.get("OMP_NUM_THREADS", "not set"),
    }


def _version(name: str) -> str:
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return "not installed"


def _cpu_lines() -> list[str]:
    path = Path("/proc/cpuinfo")
    return path.read_text().splitlines() if path.exists() else []


def heading() -> None:
    """Print the line above the rows."""
    print(f"{'benchmark':34} {'what':30} {'run s':>10} {'ratio':>9}  facts", flush=True)


def show(rows: list[Row]) -> None:
    """Print rows of the table."""
    for row in rows:
        facts = ", ".join(
            f"{k} {v:.4g}" if isinstance(v, float) else f"{k} {v}" for k, v in row.facts.items()
        )
        print(f"{row.benchmark:34} {row.name:30} {row.median:10.3f} {row.ratio:9.3f}  {facts}", flush=True)


def write(rows: list[Row], path: Path) -> None:
    """Write all rows as JSON, with the machine."""
    path.parent.mkdir(parents=True, exist_ok=True)
    document = {"machine": machine(), "rows": [{**asdict(row), "median": row.median} for row in rows]}
    path.write_text(json.dumps(document, indent=2) + "\n")

"""Timing of alternatives in turns, so that a machine whose speed drifts is fair to all of them."""

from __future__ import annotations

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


@dataclass
class Row:
    """One measured alternative."""

    benchmark: str
    name: str
    seconds: list[float]  # of each run
    ratio: float  # to the first alternative of the benchmark: median of the ratios run by run
    facts: Mapping[str, float | str] = field(default_factory=dict)

    @property
    def median(self) -> float:
        return statistics.median(self.seconds)


def in_turns(
    benchmark: str, alternatives: Mapping[str, Callable[[], Mapping[str, float | str] | None]], runs: int = 3
) -> list[Row]:
    """Time alternatives A B C A B C …; the first one is what the ratios refer to."""
    seconds: dict[str, list[float]] = {name: [] for name in alternatives}
    facts: dict[str, Mapping[str, float | str]] = {}
    for _ in range(runs):
        for name, work in alternatives.items():
            begun = time.perf_counter()
            facts[name] = work() or {}
            seconds[name].append(time.perf_counter() - begun)
    first = seconds[next(iter(alternatives))]
    return [
        Row(
            benchmark,
            name,
            times,
            statistics.median(t / r for t, r in zip(times, first, strict=True)),
            facts[name],
        )
        for name, times in seconds.items()
    ]


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
        "threads": os.environ.get("OMP_NUM_THREADS", "not set"),
    }


def _cpu_lines() -> list[str]:
    path = Path("/proc/cpuinfo")
    return path.read_text().splitlines() if path.exists() else []


def report(rows: list[Row], path: Path) -> None:
    """Print a table, and write the same as JSON."""
    print(f"{'benchmark':34} {'what':30} {'median s':>10} {'ratio':>9}  facts")
    for row in rows:
        facts = ", ".join(
            f"{k} {v:.4g}" if isinstance(v, float) else f"{k} {v}" for k, v in row.facts.items()
        )
        print(f"{row.benchmark:34} {row.name:30} {row.median:10.3f} {row.ratio:9.3f}  {facts}")
    path.parent.mkdir(parents=True, exist_ok=True)
    document = {"machine": machine(), "rows": [{**asdict(row), "median": row.median} for row in rows]}
    path.write_text(json.dumps(document, indent=2) + "\n")
    print(f"Written to {path}")

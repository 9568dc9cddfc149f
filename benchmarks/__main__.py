"""``make bench``: all benchmarks, or those whose name is given."""

from __future__ import annotations

import argparse
from pathlib import Path

from benchmarks import beams, solid
from benchmarks.timing import report

BENCHMARKS = {"beams": beams.run, "solid": solid.run}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "names", nargs="*", metavar="NAME", help=f"of {', '.join(BENCHMARKS)}; all by default"
    )
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--output", type=Path, default=Path("out/bench.json"))
    arguments = parser.parse_args()
    rows = [row for name in arguments.names or BENCHMARKS for row in BENCHMARKS[name](arguments.runs)]
    report(rows, arguments.output)


if __name__ == "__main__":
    main()

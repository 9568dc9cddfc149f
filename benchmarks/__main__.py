"""``make bench``: all benchmarks, or those whose name is given."""

from __future__ import annotations

import argparse
from pathlib import Path

from benchmarks import beams, growth, nonlinear, solid, sweeps, track
from benchmarks.timing import Row, heading, show, write

BENCHMARKS = {
    "beams": beams.run,
    "track": track.run,
    "growth": growth.run,
    "solid": solid.run,
    "sweeps": sweeps.run,
    "nonlinear": nonlinear.run,
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "names", nargs="*", metavar="NAME", help=f"of {', '.join(BENCHMARKS)}; all by default"
    )
    parser.add_argument("--runs", type=int, default=None, help="3, or 1 with --quick")
    parser.add_argument("--quick", action="store_true", help="short runs: about two minutes for all")
    parser.add_argument("--output", type=Path, default=Path("out/bench.json"))
    arguments = parser.parse_args()
    runs = arguments.runs or (1 if arguments.quick else 3)
    rows: list[Row] = []
    heading()
    for name in arguments.names or BENCHMARKS:
        done = BENCHMARKS[name](runs, arguments.quick)
        show(done)
        rows += done
        write(rows, arguments.output)  # what is done is kept if a later one fails
    print(f"Written to {arguments.output}")


if __name__ == "__main__":
    main()

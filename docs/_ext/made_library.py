"""The library: vehicles, trains and spectra, as ``axlespan library`` lists them."""

from __future__ import annotations

from pathlib import Path

from typer.testing import CliRunner

from axlespan.cli.app import app


def page(_path: Path) -> str:
    """Return what the command prints."""
    runner = CliRunner(env={"COLUMNS": "120", "TERM": "dumb", "NO_COLOR": "1"})
    told = runner.invoke(app, ["library"])
    if told.exit_code:
        raise RuntimeError(f"axlespan library failed: {told.output}")
    body = "\n".join(line.rstrip() for line in told.output.strip().splitlines())
    return "\n".join(["# Library", "", "As `axlespan library` prints it.", "", "```text", body, "```", ""])

"""All commands, as they print their own help."""

from __future__ import annotations

from pathlib import Path

from typer.main import get_command
from typer.testing import CliRunner

from axlespan.cli.app import app


def page(_path: Path) -> str:
    """Return the help of each command."""
    lines = ["# Commands", "", "As `axlespan COMMAND --help` prints them.", ""]
    runner = CliRunner(env={"COLUMNS": "110", "TERM": "dumb", "NO_COLOR": "1"})
    names = sorted(getattr(get_command(app), "commands", {}))
    for name in names:
        told = runner.invoke(app, [name, "--help"])
        if told.exit_code:
            raise RuntimeError(f"axlespan {name} --help failed: {told.output}")
        body = "\n".join(line.rstrip() for line in told.output.strip().splitlines())
        lines += [f"## axlespan {name}", "", "```text", body, "```", ""]
    return "\n".join(lines)

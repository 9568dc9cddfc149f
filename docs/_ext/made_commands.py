"""All commands, as they print their own help."""

from __future__ import annotations

from pathlib import Path

from typer.main import get_command
from typer.testing import CliRunner

from axlespan.cli.app import app

INTRODUCTION = """As `axlespan COMMAND --help` prints them. `axlespan --install-completion` lets your shell (bash,
zsh, fish, PowerShell) complete commands and options; `axlespan --show-completion` prints what it would install.

Exit codes: 0 done; 2 the input is wrong, nothing was written; 3 the analysis failed, what was computed until then is
kept.
"""


def page(_path: Path) -> str:
    """Return the help of each command."""
    lines = ["# Commands", "", INTRODUCTION, ""]
    runner = CliRunner(env={"COLUMNS": "110", "TERM": "dumb", "NO_COLOR": "1"})
    names = sorted(getattr(get_command(app), "commands", {}))
    for name in names:
        told = runner.invoke(app, [name, "--help"])
        if told.exit_code:
            raise RuntimeError(f"axlespan {name} --help failed: {told.output}")
        body = "\n".join(line.rstrip() for line in told.output.strip().splitlines())
        lines += [f"## axlespan {name}", "", "```text", body, "```", ""]
    return "\n".join(lines)

"""``axlespan schema``: the JSON Schema of the case file."""

from __future__ import annotations

import json

from axlespan.cli.messages import DONE, say
from axlespan.study.case import schema


def print_schema() -> int:
    """Print it; the exit code."""
    say(json.dumps(schema(), indent=2))
    return DONE

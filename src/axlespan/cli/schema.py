"""``axlespan schema``: the JSON Schema of the case file, or of the study file."""

from __future__ import annotations

import json

from axlespan.cli.messages import DONE, say
from axlespan.study.case import schema
from axlespan.study.sweep.schema import study_schema


def print_schema(study: bool = False) -> int:
    """Print it; the exit code."""
    say(json.dumps(study_schema() if study else schema(), indent=2))
    return DONE

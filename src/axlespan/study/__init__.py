"""Case files: read, validated and located; what a run and a sweep start from."""

from axlespan.study.case import Case, schema
from axlespan.study.faults import InputErrors
from axlespan.study.loader import LoadedCase, load_case, read_case
from axlespan.study.source import Source

__all__ = ["Case", "InputErrors", "LoadedCase", "Source", "load_case", "read_case", "schema"]

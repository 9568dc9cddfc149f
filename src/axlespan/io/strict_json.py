"""Values as strict JSON: no NaN, no Infinity, nothing that another reader stumbles over."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Set
from dataclasses import asdict, is_dataclass
from typing import Any

import numpy as np


def json_ready(value: Any) -> Any:
    """The value in what JSON knows: numbers, text, lists, mappings, true, false, null.

    Numbers that are not finite become null, tuples and arrays lists, and what is unknown its text: a
    summary at the end of a long run must not fail for one odd value.

    Examples
    --------
    >>> json_ready({"peak": float("nan"), "steps": (1, 2)})
    {'peak': None, 'steps': [1, 2]}
    """
    if value is None or isinstance(value, (bool, str)):
        return value
    if isinstance(value, np.generic):
        return json_ready(value.item())
    if isinstance(value, int):
        return value
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, np.ndarray):
        return json_ready(value.tolist())
    if is_dataclass(value) and not isinstance(value, type):
        return json_ready(asdict(value))
    if isinstance(value, Mapping):
        return {str(key): json_ready(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [json_ready(item) for item in value]
    if isinstance(value, Set):
        return sorted((json_ready(item) for item in value), key=str)
    return str(value)


def to_json(value: Any, indent: int | None = None) -> str:
    """Text of :func:`json_ready`."""
    return json.dumps(json_ready(value), allow_nan=False, ensure_ascii=False, indent=indent)

"""What of a bridge and a train is the same at every speed, such as static effects: worked out once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, TypeVar

T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class AtRest:
    """Keeps what checks found of a bridge and a train at rest, for the next runs of the same.

    Hold one for each bridge and train (with its direction), and hand it to :func:`axlespan.standards.assess`.

    Examples
    --------
    >>> known = AtRest()
    >>> known.get("weight", lambda: 80.0), known.get("weight", lambda: 90.0)
    (80.0, 80.0)
    """

    _found: dict[str, Any] = field(default_factory=dict)

    def get(self, what: str, find: Callable[[], T]) -> T:
        """What was found under a name, or what is found now."""
        if what not in self._found:
            self._found[what] = find()
        found: T = self._found[what]
        return found

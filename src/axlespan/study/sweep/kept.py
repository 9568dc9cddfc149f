"""The few values that were used last."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable
from dataclasses import dataclass, field
from typing import Generic, TypeVar

T = TypeVar("T")


@dataclass(eq=False)
class Kept(Generic[T]):
    """At most so many values by their keys; the one that was not used for longest goes first.

    Examples
    --------
    >>> kept = Kept[int](2)
    >>> [kept.get(word, lambda: len(word)) for word in ("a", "bb", "a", "ccc")]
    [1, 2, 1, 3]
    >>> list(kept.values)
    ['a', 'ccc']
    """

    most: int
    values: OrderedDict[Hashable, T] = field(default_factory=OrderedDict)

    def get(self, key: Hashable, make: Callable[[], T]) -> T:
        """The value of a key, made where there is none."""
        if key not in self.values:
            self.put(key, make())
        self.values.move_to_end(key)
        return self.values[key]

    def put(self, key: Hashable, value: T) -> None:
        """Keep a value, in place of one that the key had before."""
        self.values[key] = value
        self.values.move_to_end(key)
        while len(self.values) > self.most:
            self.values.popitem(last=False)

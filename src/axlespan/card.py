"""How objects show themselves: a few facts as text in a terminal, as a table in a notebook."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape


@dataclass(frozen=True)
class Card:
    """What one wants to know of an object, and what one may want to do with it."""

    title: str
    facts: Sequence[tuple[str, str]]
    after: str = ""  # code of the usual next step

    def text(self) -> str:
        """As lines of text."""
        width = max((len(name) for name, _ in self.facts), default=0)
        lines = [self.title, *(f"  {name:<{width}}  {value}" for name, value in self.facts)]
        return "\n".join([*lines, f"  next: {self.after}"] if self.after else lines)

    def html(self) -> str:
        """As a table."""
        rows = "".join(
            f"<tr><th style='text-align:left'>{escape(name)}</th>"
            f"<td style='text-align:left'>{escape(value)}</td></tr>"
            for name, value in self.facts
        )
        after = f"<div>next: <code>{escape(self.after)}</code></div>" if self.after else ""
        return f"<div><b>{escape(self.title)}</b><table>{rows}</table>{after}</div>"


class Shown:
    """Shows itself by its card."""

    def card(self) -> Card:
        """Return the facts that are shown."""
        raise NotImplementedError

    def __repr__(self) -> str:
        return self.card().text()

    def _repr_html_(self) -> str:
        return self.card().html()


def some(names: Sequence[str], most: int = 6) -> str:
    """Return names with commas between, cut after a few."""
    shown = ", ".join(names[:most])
    return f"{shown}, … ({len(names)})" if len(names) > most else shown or "none"

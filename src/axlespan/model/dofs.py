"""Degrees of freedom: which exist, how they are numbered, what they are called."""

from __future__ import annotations

from dataclasses import dataclass
from difflib import get_close_matches

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError

IntArray = npt.NDArray[np.int64]

#: Displacements and right-handed rotations of a node, in this order everywhere.
COMPONENTS = ("x", "y", "z", "rx", "ry", "rz")


def component_indices(components: tuple[str, ...]) -> IntArray:
    """Positions of components in :data:`COMPONENTS`.

    Raises
    ------
    InputError
        If a name is none of the six.
    """
    for name in components:
        if name not in COMPONENTS:
            raise InputError(f"must be one of {', '.join(COMPONENTS)}", field="component", value=name)
    return np.array([COMPONENTS.index(name) for name in components], dtype=np.int64)


def nearest(name: str, known: list[str], what: str) -> InputError:
    """An error for an unknown name that suggests the nearest known one."""
    close = get_close_matches(str(name), known, n=1, cutoff=0.5)
    fix = (
        f"Did you mean '{close[0]}'?"
        if close
        else f"Known: {', '.join(known[:12])}{' …' if len(known) > 12 else ''}"
    )
    return InputError(f"is not a known {what}", field=what, value=name, fix=fix)


@dataclass(frozen=True, eq=False)
class DofTable:
    """Numbers of the active d.o.f.: ``number[node, component]``, -1 where there is none."""

    number: IntArray  # (n_node, 6)

    @classmethod
    def of_active(cls, active: npt.NDArray[np.bool_], order: IntArray | None = None) -> DofTable:
        """Number the active d.o.f. (n_node, 6) node by node, in an order (n_node,) of the nodes if given."""
        number = np.full(active.shape, -1, dtype=np.int64)
        sequence = np.arange(len(active)) if order is None else order
        in_order = np.full(active.shape, -1, dtype=np.int64)
        chosen = active[sequence]
        in_order[chosen] = np.arange(np.count_nonzero(active))
        number[sequence] = in_order
        return cls(number)

    @property
    def size(self) -> int:
        """Number of active d.o.f."""
        return int(self.number.max(initial=-1)) + 1

    def names(self, node_names: list[str]) -> tuple[str, ...]:
        """Names ``node.component`` of all d.o.f. in the order of their numbers."""
        nodes, components = np.nonzero(self.number >= 0)
        order = np.argsort(self.number[nodes, components])
        nodes, components = nodes[order], components[order]
        return tuple(
            f"{node_names[i]}.{COMPONENTS[c]}"
            for i, c in zip(nodes.tolist(), components.tolist(), strict=True)
        )

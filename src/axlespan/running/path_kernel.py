"""Weights of a path at many positions, and the loads of wheels along it, compiled by numba: to be imported late."""

from __future__ import annotations

from typing import Any

from axlespan.compiled import as_compiled


@as_compiled
def segment_of(breaks: Any, s: float) -> Any:
    """Return the segment of a position on the path; a break belongs to the segment that begins there."""
    last = breaks.shape[0] - 2
    guess = int((s - breaks[0]) / (breaks[last + 1] - breaks[0]) * (last + 1))
    e = min(max(guess, 0), last)
    for _ in range(2):  # where segments are of about one length
        if s < breaks[e]:
            e -= 1
        elif e < last and s >= breaks[e + 1]:
            e += 1
        else:
            return e
    low, high = 0, last
    while low < high:
        middle = (low + high + 1) // 2
        if s >= breaks[middle]:
            low = middle
        else:
            high = middle - 1
    return low


@as_compiled
def fill_rows(
    breaks: Any, table: Any, dofs: Any, positions: Any, contacts: Any, slots: Any, out: Any, weights: Any
) -> None:
    """Fill in the rows of some contacts that stand on the path; all others are left as they are.

    Parameters
    ----------
    breaks, table, dofs : ndarray
        Of the path: positions (n_segment + 1,), coefficients (n_segment, n_power, n_local), d.o.f. (n_segment, n_local).
    positions : ndarray, shape (n_step, n_contact)
    contacts, slots : ndarray of int, shape (n_wheel,)
        Columns of the positions, and of the rows.
    out, weights : ndarray, shape (n_step, n_slot, at least n_local)
    """
    n_power, n_local = table.shape[1], table.shape[2]
    start, stop = breaks[0], breaks[-1]
    for k in range(positions.shape[0]):
        for i in range(contacts.shape[0]):
            s = positions[k, contacts[i]]
            if not (s >= start and s <= stop):
                continue
            e, slot = segment_of(breaks, s), slots[i]
            xi = (s - breaks[e]) / (breaks[e + 1] - breaks[e])
            for a in range(n_local):
                out[k, slot, a] = dofs[e, a]
                weights[k, slot, a] = table[e, n_power - 1, a]
            for power in range(n_power - 2, -1, -1):
                for a in range(n_local):
                    weights[k, slot, a] = weights[k, slot, a] * xi + table[e, power, a]


@as_compiled
def add_loads(
    breaks: Any, table: Any, dofs: Any, weighty: Any, positions: Any, shift: float, forces: Any, wheels: Any, total: Any
) -> None:  # fmt: skip
    """Add the loads (n_step, n) of some wheels on the path, at their positions plus a shift [m].

    ``weighty`` (n_segment,) says which segments have any weight; the others are as the path as in :func:`fill_rows`.
    """
    n_power, n_local = table.shape[1], table.shape[2]
    start, stop = breaks[0], breaks[-1]
    for k in range(positions.shape[0]):
        for i in range(wheels.shape[0]):
            s = positions[k, wheels[i]] + shift
            if not (s >= start and s <= stop):
                continue
            e = segment_of(breaks, s)
            if not weighty[e]:
                continue
            force = forces[k, wheels[i]]
            xi = (s - breaks[e]) / (breaks[e + 1] - breaks[e])
            for a in range(n_local):
                weight = table[e, n_power - 1, a]
                for power in range(n_power - 2, -1, -1):
                    weight = weight * xi + table[e, power, a]
                total[k, dofs[e, a]] += weight * force

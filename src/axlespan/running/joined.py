"""Paths one after the other: approach, spans of different kinds, approach."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np

from axlespan.errors import InputError
from axlespan.running.path import PolynomialPath

# Ends that differ by less than this share of the whole line meet.
_MEET = 1e-9


def joined(paths: Sequence[PolynomialPath]) -> PolynomialPath:
    """One path from several in the same d.o.f., each beginning where the one before ends.

    Parameters
    ----------
    paths : sequence of PolynomialPath
        In the running direction; give each the position of its first point as ``start``.

    Raises
    ------
    InputError
        If a path does not begin where the one before ends.
    """
    if not paths:
        raise InputError("must be at least one path", field="running line", value=0)
    length = paths[-1].stop - paths[0].start
    for i, (before, after) in enumerate(itertools.pairwise(paths)):
        if not abs(after.start - before.stop) <= _MEET * abs(length):
            raise InputError(
                f"must begin where the one before ends, at {before.stop:g} m",
                field=f"path {i + 2} of the running line",
                value=after.start,
                fix="Give it that position as start",
            )
    n_local = max(path.dofs.shape[1] for path in paths)
    n_power = max(path.coefficients.shape[2] for path in paths)
    dofs, coefficients = [], []
    for path in paths:
        more = n_local - path.dofs.shape[1]
        dofs.append(np.concatenate([path.dofs, np.repeat(path.dofs[:, :1], more, axis=1)], axis=1))
        gap = ((0, 0), (0, more), (0, n_power - path.coefficients.shape[2]))
        coefficients.append(np.pad(path.coefficients, gap))
    breaks = np.concatenate([paths[0].breaks[:1], *(path.breaks[1:] for path in paths)])
    return PolynomialPath(breaks, np.concatenate(dofs), np.concatenate(coefficients))

"""The shapes of single defects over 0 <= u <= 1, with their derivatives and antiderivatives."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from axlespan.irregularity.checks import Array

# shape(u, order): order 0 is the shape, 1 and 2 its derivatives by u, -1 the antiderivative that is 0 at u =
# 0.
Shape: TypeAlias = Callable[[Array, int], Array]


def half_sine(u: Array, order: int) -> Array:
    """sin(πu): kinks at both ends."""
    if order == -1:
        return (1.0 - np.cos(np.pi * u)) / np.pi
    return np.pi**order * np.sin(np.pi * u + 0.5 * np.pi * order)


def haversine(u: Array, order: int) -> Array:
    """(1 - cos 2πu) / 2: no kinks."""
    k = 2.0 * np.pi
    if order == -1:
        return 0.5 * (u - np.sin(k * u) / k)
    return 0.5 * (order == 0) - 0.5 * k**order * np.cos(k * u + 0.5 * np.pi * order)


def linear_rise(u: Array, order: int) -> Array:
    """u: kinks at both ends."""
    return (0.5 * u * u, u, np.ones_like(u), np.zeros_like(u))[order + 1]


def cosine_rise(u: Array, order: int) -> Array:
    """(1 - cos πu) / 2: no kinks."""
    return haversine(0.5 * u, order) * 0.5**order


def cusp(u: Array, order: int) -> Array:
    """(1 - |2u - 1|)²: two parabolas that meet in a kink."""
    w = 1.0 - np.abs(2.0 * u - 1.0)
    if order == -1:
        half = w**3 / 6.0
        return np.where(u < 0.5, half, 1.0 / 3.0 - half)
    if order == 0:
        return w * w
    return 4.0 * w * np.where(u < 0.5, 1.0, -1.0) if order == 1 else np.full_like(u, 8.0)


def two_lobes(u: Array, order: int, crest: float) -> Array:
    """W on its head: two lobes of height 1, between them a saddle of height 1 - crest.

    With s = sin²(πu) the shape is g s (1 + 3c - 4c s); g makes the lobes 1 high, c follows from the saddle.
    crest = 0 is a single flat top, crest = 1 brings the saddle down to 0.
    """
    c = (5.0 + 3.0 * crest + 8.0 * np.sqrt(crest)) / (25.0 - 9.0 * crest)
    g = 16.0 * c / (1.0 + 3.0 * c) ** 2
    # s = sin²(πu) and 4 s (1 - s) = sin²(2πu) are a haversine and one of twice its frequency.
    second = haversine(2.0 * u, order) * 2.0**order
    return np.asarray(g * ((1.0 - c) * haversine(u, order) + c * second))


def placed(x: Array, start: float, length: float, height: float, shape: Shape, order: int) -> Array:
    """Return a derivative of height times the shape over start <= x <= start + length, zero outside.

    The antiderivative (order -1) stays at its last value behind the end.
    """
    u = (x - start) / length
    inside = shape(np.clip(u, 0.0, 1.0), order) * (height / length**order)
    return inside if order == -1 else np.where((u >= 0.0) & (u <= 1.0), inside, 0.0)

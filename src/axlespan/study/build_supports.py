"""Supports, their motions and damping: from the case to the model."""

from __future__ import annotations

from typing import Any

from axlespan.bridges import SupportAt
from axlespan.model import motions
from axlespan.model.damping import Damping, Modal, Rayleigh
from axlespan.study import case_damping, case_support


def damping_of(case: case_damping.StructuralDamping | None) -> Damping | None:
    """Damping of a structure."""
    if case is None:
        return None
    if isinstance(case, case_damping.ModalDamping):
        return Modal(case.ratio)
    alpha, beta = case.coefficients()
    return Rayleigh(alpha, beta)


def motions_of(case: case_support.Motions | None) -> dict[str, motions.Motion] | None:
    """Motions of a support by direction."""
    if case is None:
        return None
    return {direction: _motion(value) for direction, value in case.given().items()}


def _motion(case: Any) -> motions.Motion:
    if case.kind == "constant":
        return motions.Constant(case.value)
    if case.kind == "harmonic":
        return motions.HarmonicMotion(case.amplitude, case.frequency, case.phase)
    return motions.TableMotion([t for t, _ in case.points], [u for _, u in case.points], smooth=case.smooth)


def supports_of_beams(cases: tuple[case_support.Support, ...] | None) -> list[SupportAt] | None:
    """Supports along a beam, called ``support1``, ``support2``, …; the two of a span ``left`` and ``right``."""
    if cases is None:
        return None
    names = [f"support{number + 1}" for number in range(len(cases))]
    if len(cases) == 2:
        names = ["left", "right"]
    result = []
    for name, case in zip(names, cases, strict=True):
        assert not isinstance(case.at, str)  # the schema asks for positions on beams
        result.append(
            SupportAt(
                position=case.at,
                fixed=case.fixed,
                stiffness=case.stiffness.given() if case.stiffness else None,
                damping=case.damping.given() if case.damping else None,
                motion=motions_of(case.motion),
                name=name,
            )
        )
    return result

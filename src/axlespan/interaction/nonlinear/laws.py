"""Which law of contact each wheel of a crossing follows, and what goes with laws other than N12's."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from axlespan.contact.laws import Law, law_of
from axlespan.contact.laws_of_wheels import WheelLaws
from axlespan.errors import InputError
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.settings import Settings
from axlespan.model.system import SpringRows


def laws_of(crossing: Crossing, settings: Settings) -> WheelLaws:
    """The laws of the wheels with d.o.f.: a wheel's own, else that of the analysis.

    Raises
    ------
    InputError
        If a moving force has a law: it is given, whatever the contact.
    """
    laws: list[Law] = []
    forces: list[float] = []
    radii: list[float | None] = []
    for run in crossing.runs:
        static = run.train.static_forces(crossing.gravity)
        for (name, _, point, _), force in zip(run.train.contacts, static.tolist(), strict=True):
            if point.dof is None:
                if point.law is not None and point.law.kind != "rigid":
                    raise InputError(
                        "has no law of contact: a moving force acts whatever the contact",
                        field="contact",
                        value=f"{point.law.kind} at contact {name}",
                        fix="Use a vehicle with masses, such as sprung-mass",
                    )
                continue
            law = settings.contact if point.law is None else law_of(point.law)
            if law.kind != "rigid" and not force > 0.0:
                raise InputError(
                    f"needs wheels that press on the line: the static force of contact {name} is {force:g} N",
                    field="contact",
                    value=law.kind,
                    fix="Check gravity and loads, or use contact: rigid",
                )
            laws.append(law)
            forces.append(force)
            radii.append(point.radius)
    return WheelLaws.of(laws, np.array(forces), radii)


def require_direct(settings: Settings, laws: WheelLaws, springs: Sequence[SpringRows]) -> None:
    """Laws other than the rigid one go with the direct method; those that let go, with the full basis.

    Raises
    ------
    InputError
        If another coupling or a reduced basis is asked for.
    """
    kinds = [kind for kind in laws.kinds if kind != "rigid"]
    what = f"contact: {kinds[0]}" if kinds and not springs else "nonlinear springs"
    if settings.coupling != "direct":
        raise InputError(
            f"does not know {what}", field="method", value=settings.coupling, fix="Use method: direct"
        )
    if settings.basis != "full" and (springs or laws.unilateral.any()):
        raise InputError(f"does not know {what}", field="basis", value="reduced", fix="Use basis: full")

"""From the values of a scenario to its crossing; what scenarios share is built once and kept.

What is kept never changes a number: a structure that was built before is the same as one that is built again.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final

from axlespan.errors import InputError
from axlespan.interaction.crossing import Crossing, Irregularity
from axlespan.interaction.plan import Plan
from axlespan.study.build import BuiltCase, Known, build
from axlespan.study.build_checks import require_stable
from axlespan.study.build_structures import structure_of
from axlespan.study.built import BuiltStructure
from axlespan.study.case import Case
from axlespan.study.loader import LoadedCase
from axlespan.study.pointing import pointing
from axlespan.study.sweep.kept import Kept
from axlespan.study.sweep.passage import in_round_numbers, passage
from axlespan.study.sweep.recipe import Recipe, digest
from axlespan.study.sweep.spec import LASTING
from axlespan.study.sweep.validation import case_of
from axlespan.vehicles import Train

# Structures, trains, irregularities and validated parts of cases that a worker keeps.
_STRUCTURES: Final = 8
_TRAINS: Final = 64
_PLANS: Final = 16  # of one structure; each holds the irregularity that it was made with
_SURFACES: Final = 8
_PARTS: Final = 256

# Parts of a case that are validated by themselves.
_NAMES: Final = ("structure", "train", "crossing", "other_trains", "analysis", "output", "assessment")

# Steps of a scenario at which its energy is balanced: a few of each are many of a study.
_ENERGY_SAMPLES: Final = 2


@dataclass(frozen=True, eq=False)
class _Site:
    """A structure, and plans of trains across it by the keys of the trains."""

    made: BuiltStructure
    plans: Kept[Plan] = field(default_factory=lambda: Kept(_PLANS))

    def like(self, trains: str) -> Plan | None:
        """A plan that has most in common with that of some trains; None if there is none yet."""
        found = self.plans.values.get(trains)
        return found if found is not None else next(reversed(self.plans.values.values()), None)


class Builder:
    """Builds scenarios of one recipe."""

    def __init__(self, recipe: Recipe) -> None:
        self.recipe = recipe
        self._parts: Kept[Any] = Kept(_PARTS)
        self._sites: Kept[_Site] = Kept(_STRUCTURES)
        self._trains: Kept[tuple[Sequence[Train], tuple[str, ...]]] = Kept(_TRAINS)  # and warnings about them
        self._surfaces: Kept[Sequence[Irregularity | None]] = Kept(_SURFACES)
        self._latest: Plan | None = None

    def build(self, data: Mapping[str, Any]) -> BuiltCase:
        """Build a scenario from the data of its case.

        Raises
        ------
        InputError
            If they make no case, located in the base.
        """
        keys = {name: self._key(name, data, self.recipe.data) for name in _NAMES if name in data}
        case = self._validated(data, keys)
        loaded = LoadedCase(case, self.recipe.source, Path(self.recipe.folder))
        site = self._sites.get(keys["structure"], lambda: _Site(self._structure(loaded)))
        trains = (
            f"{keys['train']} {keys.get('other_trains')} {case.analysis.gravity} {case.analysis.vehicles}"
        )
        surfaces = self._surfaces_key(data, keys)
        made, of_trains = self._trains.values.get(trains, (None, ()))
        like = site.like(trains) or self._latest
        known = Known(site.made, made, of_trains, self._surfaces.values.get(surfaces), like)
        lasting = None if self.recipe.passage is None else self._steps(case)
        built = build(loaded, known, lasting=lasting)
        crossing, others = built.crossing, built.crossing.others
        self._trains.put(trains, ((crossing.train, *(other.train for other in others)), built.of_trains))
        self._surfaces.put(surfaces, (crossing.irregularity, *(other.irregularity for other in others)))
        settings = replace(built.plan.settings, energy_samples=_ENERGY_SAMPLES)
        built = replace(built, plan=replace(built.plan, settings=settings))
        site.plans.put(trains, built.plan)
        self._latest = built.plan
        return built

    def _validated(self, data: Mapping[str, Any], keys: Mapping[str, str]) -> Case:
        """The case; its parts that were validated before are taken as they are."""
        known = {name: self._parts.values[key] for name, key in keys.items() if key in self._parts.values}
        case = case_of(self.recipe, {**data, **known})
        for name, key in keys.items():
            self._parts.put(key, getattr(case, name))
        return case

    def _structure(self, loaded: LoadedCase) -> BuiltStructure:
        with pointing(loaded, "structure"):
            made = structure_of(loaded.case.structure)
            require_stable(made.structure, loaded.case.structure)
        return made

    def _steps(self, case: Case) -> Callable[[Crossing], int]:
        after, dt = self.recipe.passage or 0.0, case.analysis.time_step

        def steps(crossing: Crossing) -> int:
            number = max(1, math.ceil((passage(crossing) + after) / dt * (1.0 - 1e-12)))
            if number > LASTING:
                rule = (
                    f"is so low that {number:.3g} time steps pass before the last wheel leaves the structure"
                )
                fix = f"Use a higher speed or a longer time_step: at most {LASTING:.0e} steps are possible"
                raise InputError(rule, field="crossing.speed", fix=fix)
            return in_round_numbers(number)

        return steps

    def _surfaces_key(self, data: Mapping[str, Any], keys: Mapping[str, str]) -> str:
        """Key of the irregularities; they often stay while the speed varies."""
        base = self.recipe.data.get("crossing")
        own = self._key("irregularity", data["crossing"], base if isinstance(base, Mapping) else {})
        return f"{own} {keys.get('other_trains')}"

    @staticmethod
    def _key(name: str, data: Mapping[str, Any], base: Mapping[str, Any]) -> str:
        """What tells a part of a case from others; that of the base is known without reading it."""
        own = data.get(name)
        return name if own is base.get(name) else f"{name} {digest(own)}"

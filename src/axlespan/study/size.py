"""How large a run is: what it keeps, and the memory that it takes."""

from __future__ import annotations

import math
from dataclasses import dataclass

from axlespan.errors import InputError
from axlespan.interaction.plan import Plan
from axlespan.study.source import Source

# Memory of the program itself with all that it imports, measured at 215 MB without and 330 MB with figures.
_PROGRAM = 0.35e9

# A result file is made in memory: beside the histories (8 byte a value) their compressed copy, which for
# histories that no step repeats is up to as large again (measured: 65 %).
_COPIES = 2.0

# Dense matrices (n_contact, n_contact) that the start of a run holds at a time (measured: 6).
_START_MATRICES = 6.0


@dataclass(frozen=True)
class Size:
    """Sizes of a run [byte]."""

    kept_times: int
    values: int  # at each kept time
    fields: int  # values of all fields
    work: float  # of the computation itself [byte]

    @property
    def result(self) -> float:
        """Histories and fields, before they are compressed [byte]."""
        return 8.0 * (float(self.kept_times) * self.values + self.fields)

    @property
    def memory(self) -> float:
        """All that a run takes at most [byte]."""
        return _PROGRAM + _COPIES * self.result + self.work


def size_of(plan: Plan) -> Size:
    """The size of a compiled crossing's run."""
    settings, system = plan.settings, plan.crossing.structure.system
    n_contact, n_vehicle = plan.rows.n_contact, plan.fleet.matrices.size
    values = 2 * n_contact + 3 * n_vehicle + 3 * len(settings.sensors) + 4 * len(settings.section_forces)
    values += 2 * len(settings.line_points)
    field = 2 * len(system.dof_names) + 3 * n_contact
    coupled = len(plan.fleet.coupled)
    start = _START_MATRICES * float(n_contact) ** 2 + 2.0 * coupled * (plan.structure.size + n_vehicle)
    return Size(
        kept_times=settings.steps // settings.every + 1,
        values=values + (len(system.prescribed) if settings.reactions else 0),
        fields=len(settings.fields) * field,
        work=8.0 * start,
    )


def require_memory(plan: Plan, source: Source, available: float) -> Size:
    """Refuse a run that takes more memory than there is, before it starts.

    Parameters
    ----------
    plan : Plan
    source : Source
        Of its case, for the place of the error.
    available : float
        Memory of the machine [byte].

    Raises
    ------
    InputError
        With the value that is to blame, and one that would do.
    """
    size = size_of(plan)
    if size.memory <= available:
        return size
    has = f"takes about {size_text(size.memory)} of memory, and this machine has {size_text(available)}"
    histories = 8.0 * _COPIES * size.kept_times * size.values
    fields = 8.0 * _COPIES * size.fields
    if max(histories, fields) < size.work:
        raise source.blame(
            "train",
            f"has {plan.rows.n_contact} wheels: the run {has}",
            "Use fewer vehicles, or axle-loads for those that matter less",
        )
    if fields > histories:
        raise source.blame(
            "output.fields", f"{len(plan.settings.fields)} fields: the run {has}", "Ask for fewer"
        )
    path = "analysis.steps" if source.knows("analysis.steps") else "analysis.duration"
    room = max(0.5 * available - _PROGRAM - size.work - fields, 0.05 * available)
    every = _round_up(plan.settings.every * histories / room)
    raise InputError(
        f"{size.kept_times} kept times of {size.values} values: the run {has}",
        field=path,
        value=source.word(path),
        place=source.place(path),
        fix=f"Keep fewer of them with every: {every} under output, or make fewer steps",
    )


def size_text(size: float) -> str:
    """A number of bytes in words.

    Examples
    --------
    >>> size_text(2.5e6), size_text(4.06e12)
    ('2.5 MB', '4.06 TB')
    """
    for unit, factor in (("TB", 1e12), ("GB", 1e9), ("MB", 1e6)):
        if size >= factor:
            return f"{size / factor:.3g} {unit}"
    return f"{size / 1e3:.3g} kB"


def _round_up(number: float) -> int:
    """The next of 1, 2, 5, 10, 20, ..."""
    power = 10.0 ** math.floor(math.log10(max(number, 1.0)))
    return int(next(step * power for step in (1.0, 2.0, 5.0, 10.0) if step * power >= number * (1.0 - 1e-9)))

"""Step cutting: a step whose interface does not converge is made in 2, 4, 8, ... parts, and Δt restored after it.

The parts are steps of the same crossing with the time step Δt / 2^m: rows, irregularity and loads at their own times,
factors and path columns of their own. These are made when they are first needed, and serve until the run ends.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.errors import AnalysisError
from axlespan.interaction.contact_system import Stretch
from axlespan.interaction.convoy import Convoy
from axlespan.interaction.nonlinear.contact import NonlinearCoupling, StepNotConverged, left_over
from axlespan.interaction.nonlinear.substeps import Substeps
from axlespan.interaction.records.recorder import Recorder

FloatArray = npt.NDArray[np.float64]

# Steps that a note names.
_NAMED = 4


class StepCutting:
    """Makes the steps of a nonlinear crossing, in parts where one does not converge as a whole.

    Parameters
    ----------
    coupling : NonlinearCoupling
        Makes steps of the whole Δt.
    recorder : Recorder
        Is told what lies inside steps that were cut.
    cuts : int
        How often Δt may be halved.
    """

    def __init__(self, coupling: NonlinearCoupling, recorder: Recorder, cuts: int) -> None:
        self.coupling, self.recorder, self.cuts = coupling, recorder, cuts
        self.parts: dict[int, int] = {}  # of the steps that were cut
        self._made: dict[int, Substeps] = {}  # by their number in a step
        self._note: int | None = None
        self._worst = ""

    def __call__(self, convoy: Convoy, stretch: Stretch, k: int, external: FloatArray | None) -> FloatArray:
        """One step of a single lane.

        Raises
        ------
        AnalysisError
            If not even the smallest part of a step converges, a vehicle is lost or a wheel chatters.
        """
        standing = self.coupling.field.standing
        try:
            return self.coupling(convoy, stretch, k, external)
        except StepNotConverged as error:
            self.coupling.field.back_to(standing)
            return self._cut(convoy, stretch.first + k, error)

    def _cut(self, convoy: Convoy, step: int, error: StepNotConverged) -> FloatArray:
        """Make a step in as few parts as it takes."""
        field, worst, lost = self.coupling.field, error.where, error.iterations
        standing = field.standing
        for cut in range(1, self.cuts + 1):
            parts = 2**cut
            if parts not in self._made:
                self._made[parts] = Substeps(self.coupling, convoy, parts)
            made = self._made[parts]
            made.enter(step, convoy)
            try:
                forces = made.make(step, self.recorder)
            except StepNotConverged as again:
                field.back_to(standing)  # the memory of springs is shared
                lost, error = lost + made.iterations + again.iterations, again
                continue
            self.coupling.iterations.append(lost + made.iterations)
            self.parts[step] = parts
            self._worst = worst
            self._tell()
            made.leave(step, convoy, self.recorder)
            return forces
        raise self._given_up(step, error) from error

    def _given_up(self, step: int, error: StepNotConverged) -> AnalysisError:
        dt, parts = self.coupling.time_step, 2**self.cuts
        last = left_over(error.iterations, error.residual, error.where)
        return AnalysisError(
            f"step {step}, t = {step * dt:.6g} s: the interface of wheels and springs did not converge as a whole, nor in "
            f"{parts} parts of {dt / parts:.3g} s (the last one tried: {last}). Use a smaller time step, or a law without "
            "jumps of its tangent"
        )

    def _tell(self) -> None:
        """Keep the note up to date."""
        notes = self.recorder.notes
        if self._note is None:
            self._note = len(notes)
            notes.append("")
        count, largest = len(self.parts), max(self.parts.values())
        named = ", ".join(str(step) for step in list(self.parts)[:_NAMED])
        which = (
            f"step {named}" if count == 1 else f"{count} steps ({named}{', ...' if count > _NAMED else ''})"
        )
        shortest = self.coupling.time_step / largest
        notes[self._note] = (
            f"{which} did not converge as a whole and went in parts of {shortest:.3g} s at least, "
            f"{'because of' if count == 1 else 'the last one because of'} {self._worst}"
        )

    def facts(self) -> dict[str, object]:
        """What the summary says of cuts."""
        facts: dict[str, object] = {"cut_steps": len(self.parts)}
        if self.parts:
            per_step = np.ones(max(self.parts), dtype=np.int64)
            per_step[np.array(list(self.parts)) - 1] = list(self.parts.values())
            facts["smallest_time_step"] = self.coupling.time_step / int(per_step.max())
            facts["parts_of_steps"] = per_step
        return facts

"""A run whose contact or track is nonlinear: preload, start, and the coupling that makes its steps."""

from __future__ import annotations

from axlespan.interaction.drive import Couple
from axlespan.interaction.nonlinear.balance import Balance
from axlespan.interaction.nonlinear.contact import NonlinearCoupling
from axlespan.interaction.nonlinear.flights import Flights
from axlespan.interaction.nonlinear.spring_field import SpringField
from axlespan.interaction.nonlinear.springs import Springs
from axlespan.interaction.nonlinear.start import nonlinear_start
from axlespan.interaction.nonlinear.step_cutting import StepCutting
from axlespan.interaction.plan import Plan
from axlespan.interaction.records.recorder import Recorder
from axlespan.interaction.start import Start, StartFactors


def preloaded_springs(plan: Plan, factors: StartFactors) -> Springs:
    """The structure's nonlinear springs under its own weight.

    Displacements of a run count from that state.
    """
    system = plan.crossing.structure.system
    springs = Springs.of(system)
    if not springs.n:
        return springs
    return springs.preloaded(system.weight(plan.crossing.gravity)[system.free], factors.stiffness)


def begin_nonlinear(plan: Plan, factors: StartFactors) -> tuple[Start, NonlinearCoupling]:
    """The state at time zero, and the coupling that goes on from there."""
    balance = Balance(plan, plan.laws, factors)
    springs = preloaded_springs(plan, factors)
    begun = nonlinear_start(plan, plan.laws, balance, factors, springs)
    forces = begun.start.forces[plan.fleet.coupled]
    in_air = plan.laws.may_part & ~(forces > 0.0)
    flights = Flights(plan, in_air, plan.settings.lost_after)
    field = SpringField(springs, begun.deviation, Springs.of_fleet(plan))
    coupling = NonlinearCoupling(plan.laws, balance, begun.approach, begun.touching, field, flights)
    return begun.start, coupling


def watch(coupling: NonlinearCoupling, recorder: Recorder) -> None:
    """Let a recorder know which wheels touch, what springs add to reactions, and what flew."""
    recorder.compatibility.touching = lambda: coupling.touching
    recorder.reactions.inner = coupling.field.on_supports
    system = recorder.plan.crossing.structure.system
    up = system.translation("z")
    coupling.field.weigh(up[system.free], up[system.prescribed])
    recorder.balance.left_over = coupling.field.left_over
    recorder.more_checks = coupling.flights.checks
    recorder.more_facts = coupling.facts
    recorder.energy.inner_of_fleet = coupling.field.fleet_force
    names = [
        name
        for name, is_in_air in zip(coupling.flights.names, coupling.flights.in_air, strict=True)
        if is_in_air
    ]
    if names:
        recorder.notes.append(
            f"in the air at the start, since static equilibrium leaves them unloaded: {', '.join(names)}"
        )


def with_cutting(coupling: NonlinearCoupling, recorder: Recorder) -> Couple:
    """The coupling, with steps cut where they do not converge: as often as the settings say, on the full basis."""
    settings = recorder.plan.settings
    if not settings.cuts or settings.basis != "full":
        return coupling
    cutting = StepCutting(coupling, recorder, settings.cuts)
    recorder.more_facts = lambda: coupling.facts() | cutting.facts()
    return cutting

"""Nodes of a deck under sleepers: moved, cut, or left where they are."""

from dataclasses import replace

import numpy as np
import pytest

from axlespan.bridges import ballasted_track, simple_span, simple_spans, with_track
from axlespan.bridges.refine import cut_at
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.simulate import simulate
from axlespan.linalg.factor import factorize
from axlespan.model.compile import compile_model
from axlespan.vehicles.simple import axle_loads
from axlespan.vehicles.train import Train

DECK = dict(youngs_modulus=34e9, second_moment=2.0, mass_per_length=15e3)


def xs(structure):
    """Positions of the deck's nodes, in order."""
    nodes = [part.nodes.ravel() for part in structure.model.parts if part.name in ("beam", "span1", "span2")]
    return np.sort(structure.model.points[np.unique(np.concatenate(nodes)), 0])


def static(structure, at):
    """Deflections (n,) of the deck under 100 kN on the rails at positions."""
    system, path = structure.system, structure.line()
    load = -1e5 * path.rows(at, system.size).toarray().sum(axis=0)
    u = np.zeros(system.size)
    u[system.free] = factorize(system.partition.K_FF).solve(load[system.free])
    return structure.line("deck").rows([4.5, 9.0, 12.3], system.size) @ u


@pytest.mark.parametrize("elements", [7, 10, 20, 37])
def test_statics_do_not_depend_on_the_mesh_of_the_deck(elements):
    """Beams are exact at their nodes, so sleepers on nodes see one deck whatever its mesh was; 60 beams fit anyhow."""
    fitting = with_track(simple_span(length=18.0, elements=60, **DECK), ballasted_track())
    other = with_track(simple_span(length=18.0, elements=elements, **DECK), ballasted_track())
    np.testing.assert_allclose(static(other, [6.0, 9.1]), static(fitting, [6.0, 9.1]), rtol=1e-7)


@pytest.mark.parametrize("shorter", [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 2e-6, 0.0])
def test_a_deck_is_not_cut_into_slivers(shorter):
    """Spans some more or less than their 20 elements beside the sleepers: no short beam, the deflections of all alike."""
    length = 20.0 * (0.9 - shorter)
    track = with_track(simple_span(length=length, elements=20, **DECK), ballasted_track())
    assert np.diff(xs(track)).min() > 0.09
    fine = with_track(simple_span(length=length, elements=60, **DECK), ballasted_track())
    np.testing.assert_allclose(static(track, [6.0, 9.1]), static(fine, [6.0, 9.1]), rtol=1e-5)


@pytest.mark.parametrize("beside", [0.015, 0.05, 0.1, 0.2])
def test_the_shear_at_an_end_is_its_reaction(beside):
    """The last sleeper stands beside the bearing, and carries much of a wheel over it; Σ F = 0 of the part between."""
    length = 17.7 + beside
    track = with_track(
        simple_span(length=length, elements=20, **DECK), ballasted_track(), approach=30.0, exit=30.0
    )
    result = simulate(
        Crossing(track, Train.of(axle_loads(loads=[1e5])), speed=0.0, start=length - 0.4),
        time_step=1e-3,
        steps=2,
        sensors={"end": length},
        section_forces=["end"],
    )
    reaction = result.at("support_reaction", "right.z")[-1]
    assert reaction > 5e4
    assert result.at("section_shear", "end")[-1] == pytest.approx(-reaction, rel=1e-6)


def test_slivers_at_supports_are_not_cut_either():
    """A sleeper 0.3 mm beside a pier stands on the beam, not on a node of its own."""
    track = with_track(
        simple_spans(spans=[9.2997, 9.0], elements=10, **DECK), ballasted_track(), approach=45.0, exit=45.0
    )
    sizes = np.diff(np.unique(xs(track).round(9)))
    assert sizes.min() > 0.1


def test_only_nodes_that_join_two_equal_beams_move():
    """A node with a support, a name, a mass or another section beside it stays; the beams are cut."""
    bridge = simple_span(length=12.0, elements=4, **DECK)  # nodes at 0, 3, 6, 9, 12
    model = bridge.model
    (deck,) = (part for part in model.parts if part.name == "beam")
    wanted = np.array([2.5, 6.5, 9.5])
    node = int(np.argmin(np.abs(model.points[:, 0] - 6.0)))
    plain = cut_at(bridge, wanted)
    np.testing.assert_allclose(xs(plain), [0.0, 2.5, 6.5, 9.5, 12.0], atol=1e-12)
    assert plain.line().start == 0.0
    assert plain.line().stop == pytest.approx(12.0)
    named = cut_at(
        replace(bridge, model=replace(model, node_names={**model.node_names, "mid": node})), wanted
    )
    np.testing.assert_allclose(xs(named), [0.0, 2.5, 6.0, 6.5, 9.5, 12.0], atol=1e-12)
    heavy = model.with_mass(node, 1e3, name="stone")
    assert 6.0 in xs(cut_at(replace(bridge, model=heavy, system=compile_model(heavy).system), wanted))
    stiffness = np.array([1.0, 1.0, 1.0, 2.0]) * 34e9 * 2.0
    parts = tuple(
        replace(part, properties=replace(part.properties, bending_stiffness_y=stiffness))
        if part is deck
        else part
        for part in model.parts
    )
    uneven = replace(bridge, model=replace(model, parts=parts))
    uneven = replace(uneven, system=compile_model(uneven.model).system)
    np.testing.assert_allclose(xs(cut_at(uneven, wanted)), [0.0, 2.5, 6.5, 9.0, 9.5, 12.0], atol=1e-12)


def test_a_node_moves_by_half_the_way_to_the_next_at_most():
    bridge = simple_span(length=12.0, elements=4, **DECK)
    np.testing.assert_allclose(
        xs(cut_at(bridge, np.array([4.4]))), [0.0, 4.4, 6.0, 9.0, 12.0], atol=1e-12
    )  # 1.4 m
    np.testing.assert_allclose(
        xs(cut_at(bridge, np.array([0.2]))), [0.0, 0.2, 3.0, 6.0, 9.0, 12.0], atol=1e-12
    )

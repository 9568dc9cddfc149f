"""Where running lines are in space."""

import numpy as np
import pytest

from axlespan.bridges import simple_span
from axlespan.elements.beam import BeamProperties
from axlespan.model.compile import compile_model
from axlespan.model.model import Model
from axlespan.model.nodal import nodal_values, rigid_motion
from axlespan.running.geometry import LineGeometry
from axlespan.running.line import path_on_beams
from axlespan.running.structure import Structure

BEAM = BeamProperties(1e9, 1e8, 1e8, 1e7, mass_per_length=1e3)


def test_a_curved_line_in_space():
    angle = np.linspace(0.0, 0.8, 7)
    points = np.column_stack([30 * np.sin(angle), 5 + 30 * (1 - np.cos(angle)), 2 + 0.5 * angle])
    model = Model(plane=False).with_nodes(points)
    model = model.with_beams(np.column_stack([np.arange(6), np.arange(1, 7)]), BEAM)
    model = model.with_support(0, ("x", "y", "z", "rx", "ry", "rz"))
    compiled = compile_model(model)
    path = path_on_beams(model, compiled.table, range(7), start=4.0)
    geometry = LineGeometry.of(Structure(compiled.system, {"main": path}, model=model))
    assert geometry.points == pytest.approx(points, abs=1e-9)
    assert geometry.at(path.breaks[3]) == pytest.approx(points[3])
    middle = 0.5 * (path.breaks[2] + path.breaks[3])
    assert geometry.at([middle, path.breaks[0]])[0] == pytest.approx(points[2:4].mean(axis=0))
    # straight on beyond the ends
    ahead = points[0] + (points[0] - points[1]) * 2.0 / (path.breaks[1] - path.breaks[0])
    assert geometry.at(path.start - 2.0) == pytest.approx(ahead)


def test_tied_and_eccentric_beams():
    """The line is where its beams' axes are: 0.6 m beside their nodes, which hang on others by links."""
    x = np.linspace(0.0, 8.0, 5)
    flat = np.zeros(5)
    model = Model(plane=False).with_nodes(np.column_stack([x, flat + 0.6, flat]))
    model = model.with_nodes(np.column_stack([x, flat, flat]))
    model = model.with_beams(np.column_stack([np.arange(4), np.arange(1, 5)]), BEAM, name="rail")
    model = model.with_beams(np.column_stack([np.arange(5, 9), np.arange(6, 10)]), BEAM, name="deck")
    for i in range(5):
        model = model.with_rigid_link(5 + i, [i])
    model = model.with_support(5, ("x", "y", "z", "rx", "ry", "rz"))
    compiled = compile_model(model)
    path = path_on_beams(model, compiled.table, range(5)).transformed(compiled.system.elimination)
    geometry = LineGeometry.of(Structure(compiled.system, {"main": path}, model=model))
    assert geometry.points == pytest.approx(np.column_stack([x, flat + 0.6, flat]), abs=1e-9)


def test_without_a_model():
    bridge = simple_span(length=9.0, youngs_modulus=1e10, second_moment=0.1, mass_per_length=1.0, elements=3)
    geometry = LineGeometry.of(Structure(bridge.system, bridge.lines))
    assert geometry.at([-1.0, 4.0]) == pytest.approx(np.array([[-1.0, 0.0, 0.0], [4.0, 0.0, 0.0]]))


def test_rigid_motions_strain_nothing():
    model = Model(plane=False).with_nodes([[0, 0, 0], [2, 1, 0], [3, 3, 2]])
    model = model.with_beams([[0, 1], [1, 2]], BEAM)
    system = compile_model(model).system
    for component in ("x", "y", "z", "rx", "ry", "rz"):
        motion = rigid_motion(model, component, center=(1.0, -2.0, 0.5))
        assert np.abs(system.stiffness @ motion).max() < 1e-6
        at_nodes = nodal_values(model, motion)
        assert at_nodes.shape == (3, 6)
    turned = nodal_values(model, rigid_motion(model, "rz", center=(1.0, 0.0, 0.0)))
    assert turned[2] == pytest.approx([-3.0, 2.0, 0.0, 0.0, 0.0, 1.0])

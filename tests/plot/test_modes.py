"""Figures of mode shapes: what is drawn is the shape."""

import numpy as np
import pytest
from matplotlib import pyplot as plt

import axlespan as asp
from axlespan.model.compile import compile_model
from axlespan.model.from_mesh import Solids, parts_from_mesh
from axlespan.model.materials import Material
from axlespan.model.mesh import Mesh
from axlespan.model.modal import modes_of
from axlespan.model.model import Model
from axlespan.plot import modes as figures
from axlespan.running.structure import Structure
from axlespan.running.surface import line_over


def test_shapes_along_the_line():
    bridge = asp.bridges.simple_span(
        length=20.0, youngs_modulus=3e10, second_moment=0.1, mass_per_length=4e3, elements=24
    )
    modes = modes_of(bridge.system, 24).modes
    ax = figures.line_shapes(bridge, modes)
    curves = [line for line in ax.lines if len(line.get_xdata()) > 2]
    assert len(curves) == 20  # not more fit
    plt.close("all")
    labels = [text.get_text() for text in ax.get_yticklabels()]
    assert labels[0] == f"1:  {np.pi / 2 / 400 * np.sqrt(3e9 / 4e3):.4g} Hz"
    for n in (1, 2, 3):
        x, y = curves[n - 1].get_data()
        shape = y + 2.4 * (n - 1)
        assert (x[0], x[-1]) == (0.0, 20.0)
        sine = np.sin(n * np.pi * x / 20.0)
        assert np.abs(np.abs(shape) - np.abs(sine)).max() < 0.01


def solid_beam():
    mesh = Mesh.box((6.0, 0.5, 0.5), (12, 1, 1))
    model = Model(plane=False).with_nodes(mesh.points)
    for part in parts_from_mesh(mesh, {"volume": Solids(Material(3e10, 0.2, 2500.0))}):
        model = model.with_part(part)
    for node in np.flatnonzero(mesh.points[:, 0] == 0.0).tolist():
        model = model.with_support(node, ("x", "y", "z"))
    compiled = compile_model(model)
    path = line_over(model, compiled.table, [[0.0, 0.25, 0.5], [6.0, 0.25, 0.5]])
    return Structure(compiled.system, {"main": path.transformed(compiled.system.elimination)}, model=model)


def test_shape_in_space():
    structure = solid_beam()
    modes = modes_of(structure.system, 3).modes
    ax = figures.space_shape(structure, modes, 0)
    _, bent = ax.collections
    amounts = bent.get_array()
    # 13 cross-sections of 4 edges and 12 × 4 edges along; the free end moves most, the clamped one not at all
    assert len(amounts) == 13 * 4 + 12 * 4
    assert 0.99 < amounts.max() <= 1.0 and amounts.min() == pytest.approx(0.0, abs=1e-12)
    assert ax.get_title() == f"Mode 1: {modes.frequencies[0]:.4g} Hz"
    ax.figure.draw_without_rendering()
    plt.close("all")


def test_what_cannot_be_drawn(monkeypatch):
    structure = solid_beam()
    modes = modes_of(structure.system, 1).modes
    with pytest.raises(asp.InputError, match="given by matrices"):
        figures.space_shape(Structure(structure.system, structure.lines), modes, 0)
    monkeypatch.setattr(figures, "_EDGES", 50)
    with pytest.raises(asp.InputError, match=r"too many edges for a figure, 100\. Open modes.vtu"):
        figures.space_shape(structure, modes, 0)

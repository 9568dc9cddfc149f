"""Materials and sections turned into stiffness and mass, and systems built of them."""

import math

import numpy as np
import pytest

from axlespan.bridges.spans import simple_span
from axlespan.elements.beam import BeamProperties
from axlespan.errors import InputError
from axlespan.linalg.eigen import lowest_modes
from axlespan.model.compile import compile_model
from axlespan.model.materials import BeamSection, Material, require_positive
from axlespan.model.model import Model
from axlespan.reference import euler_bernoulli_frequencies, timoshenko_frequencies

STEEL = Material(210e9, 0.3, 7850.0)


def test_section_properties():
    section = BeamSection(
        second_moment=2e-4,
        area=0.02,
        lateral_second_moment=1e-4,
        torsion_constant=3e-6,
        shear_area=0.012,
        lateral_shear_area=0.015,
    )
    p = section.properties(STEEL)
    g = 210e9 / 2.6
    assert STEEL.shear_modulus == pytest.approx(g)
    assert p.axial_stiffness == pytest.approx(210e9 * 0.02)
    assert (p.bending_stiffness_y, p.bending_stiffness_z) == pytest.approx((42e6, 21e6))
    assert p.torsional_stiffness == pytest.approx(g * 3e-6)
    assert (p.shear_stiffness_y, p.shear_stiffness_z) == pytest.approx((g * 0.015, g * 0.012))
    assert p.mass_per_length == pytest.approx(157.0)
    assert (p.rotary_inertia_y, p.rotary_inertia_z) == pytest.approx((7850 * 2e-4, 7850 * 1e-4))


def test_thin_beams_have_no_rotary_inertia_unless_asked():
    thin = BeamSection(second_moment=2e-4, area=0.02).properties(STEEL)
    assert (thin.rotary_inertia_y, thin.shear_stiffness_z) == (0.0, math.inf)
    asked = BeamSection(second_moment=2e-4, area=0.02, rotary_inertia=True).properties(STEEL)
    assert asked.rotary_inertia_y == pytest.approx(7850 * 2e-4)


def test_rotary_inertia_needs_the_area():
    with pytest.raises(InputError, match="area: is needed for the rotary inertia"):
        BeamSection(second_moment=1.0, shear_area=1.0, mass_per_length=1.0).properties(STEEL)


@pytest.mark.parametrize(
    ("build", "field"),
    [
        (lambda: Material(0.0), "youngs_modulus"),
        (lambda: Material(1e9, 0.5), "poisson_ratio"),
        (lambda: Material(1e9, 0.2, -1.0), "density"),
        (lambda: BeamSection(second_moment=-1.0), "second_moment"),
        (lambda: BeamSection(second_moment=1.0, area=0.0), "area"),
        (lambda: BeamSection(second_moment=1.0, mass_per_length=-1.0), "mass_per_length"),
        (lambda: require_positive(math.inf, "length"), "length"),
        (lambda: require_positive(math.nan, "length"), "length"),
        (lambda: require_positive(0.0, "length"), "length"),
    ],
)
def test_errors(build, field):
    with pytest.raises(InputError) as caught:
        build()
    assert caught.value.field == field


def test_spans_have_the_frequencies_of_beams():
    """Through builder, assembly and supports: what the elements promise."""
    thin = simple_span(
        length=25.0, youngs_modulus=2.87e9, second_moment=2.9, mass_per_length=2303.0, elements=50
    )
    blocks = thin.system.partition
    modes = lowest_modes(blocks.K_FF, blocks.M_FF, 4)
    exact = euler_bernoulli_frequencies(25.0, 2.87e9 * 2.9, 2303.0, 4)
    np.testing.assert_allclose(modes.angular_frequencies, exact, rtol=3e-6)
    area, second, mass = 5.568, 2.9, 2303.0
    deep = simple_span(
        length=25.0,
        youngs_modulus=2.87e9,
        second_moment=second,
        mass_per_length=mass,
        elements=80,
        area=area,
        shear_area=area * 5 / 6,
    )
    blocks = deep.system.partition
    shear = 2.87e9 / 2.4 * area * 5 / 6
    exact = timoshenko_frequencies(25.0, 2.87e9 * second, shear, mass, mass / area * second, 3)
    modes = lowest_modes(blocks.K_FF, blocks.M_FF, 8)
    vertical = [deep.system.free_name(i).endswith(".z") for i in range(len(deep.system.free))]
    bends = np.abs(modes.shapes[vertical]).max(axis=0) > 1e-6 * np.abs(modes.shapes).max(axis=0)
    bending = modes.angular_frequencies[bends]
    np.testing.assert_allclose(bending[:3], exact, rtol=1e-4)


def test_three_dimensional_beams_in_a_model():
    """A cantilever in space, mass and tip deflection in all three directions."""
    section = BeamSection(second_moment=2e-4, area=0.02, lateral_second_moment=1e-4, torsion_constant=3e-6)
    model = Model(plane=False).with_nodes(np.column_stack([np.linspace(0, 6, 4), np.zeros((4, 2))]))
    model = model.with_beams([[0, 1], [1, 2], [2, 3]], section.properties(STEEL))
    model = model.with_support(0, ["x", "y", "z", "rx", "ry", "rz"])
    system = compile_model(model).system
    assert [system.total_mass(c) for c in "xyz"] == pytest.approx([157.0 * 6.0] * 3)
    k = system.partition.K_FF.toarray()
    names = [system.free_name(i) for i in range(len(k))]
    load = np.zeros(len(k))
    for name, amount in (("n4.x", 1e5), ("n4.y", 1e3), ("n4.z", -1e3), ("n4.rx", 500.0)):
        load[names.index(name)] = amount
    u = dict(zip(names, np.linalg.solve(k, load), strict=True))
    assert u["n4.x"] == pytest.approx(1e5 * 6 / (210e9 * 0.02))
    assert u["n4.y"] == pytest.approx(1e3 * 216 / (3 * 21e6))
    assert u["n4.z"] == pytest.approx(-1e3 * 216 / (3 * 42e6))
    assert u["n4.rx"] == pytest.approx(500.0 * 6 / (STEEL.shear_modulus * 3e-6))


def test_bars_make_a_truss():
    """Two bars at 45 degrees under a vertical force: N = P / √2 each."""
    model = Model().with_nodes([[0, 0], [2, 0], [1, 1]], ["left", "right", "top"])
    model = model.with_bars([[0, 2], [1, 2]], 3e8, 10.0)
    model = model.with_support("left", ["x", "z"]).with_support("right", ["x", "z"])
    system = compile_model(model).system
    u = np.linalg.solve(system.partition.K_FF.toarray(), [0.0, -1e4])
    np.testing.assert_allclose(u, [0.0, -1e4 * math.sqrt(2.0) / 3e8], atol=1e-18)
    reactions = system.partition.K_FP.toarray().T @ u
    np.testing.assert_allclose(reactions, [5e3, 5e3, -5e3, 5e3], rtol=1e-12)
    assert system.total_mass("x") == pytest.approx(20.0 * math.sqrt(2.0))


def test_load_histories():
    model = Model().with_nodes([[0, 0], [0, 1]], ["ground", "mass"]).with_springs([[0, 1]], {"z": 1e3})
    model = model.with_mass("mass", 1.0, directions=("z",)).with_support("ground", ["z"])
    model = model.with_load("mass", "z", 3.0).with_load("mass", "z", 2.0, lambda t: np.sin(t))
    first, second = compile_model(model).system.loads
    t = np.array([0.0, 0.5])
    np.testing.assert_array_equal(first.factor(t), [1.0, 1.0])
    np.testing.assert_allclose(second.factor(t), np.sin(t))
    np.testing.assert_array_equal(second.vector, [0.0, 2.0])


def test_properties_by_element():
    several = BeamProperties(
        bending_stiffness_y=np.array([1e9, 2e9]), mass_per_length=np.array([100.0, 300.0])
    )
    system = compile_model(
        Model().with_nodes([[0, 0], [2, 0], [4, 0]]).with_beams([[0, 1], [1, 2]], several)
    ).system
    assert system.total_mass() == pytest.approx(800.0)

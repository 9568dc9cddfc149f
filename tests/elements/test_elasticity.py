"""Elasticity matrices against Hooke's law written out, and their checks."""

import numpy as np
import pytest

from axlespan.elements import elasticity as el
from axlespan.errors import InputError

WOOD = ((11e9, 0.9e9, 0.5e9), (0.37, 0.43, 0.42), (0.69e9, 0.05e9, 0.7e9))


@pytest.mark.parametrize("nu", [-0.3, 0.0, 0.2, 0.49, 0.4999])
def test_isotropic_matrix_inverts_hookes_law(nu: float) -> None:
    e = 30e9
    sigma = np.array([1.0, -2.0, 0.5, 0.3, 0.7, -0.4]) * 1e6
    strain = np.array([*(sigma[:3] * (1 + nu) - nu * sigma[:3].sum()) / e, *sigma[3:] * 2 * (1 + nu) / e])
    np.testing.assert_allclose(el.isotropic(e, nu) @ strain, sigma, rtol=1e-11, atol=1e-5)


def test_orthotropic_matrix_gives_back_its_constants() -> None:
    (e_x, e_y, e_z), (nu_xy, nu_yz, nu_xz), (g_xy, g_yz, g_zx) = WOOD
    compliance = np.linalg.inv(el.orthotropic(*WOOD))
    for i, e in enumerate((e_x, e_y, e_z)):
        assert 1 / compliance[i, i] == pytest.approx(e)
    assert -compliance[1, 0] * e_x == pytest.approx(nu_xy)
    assert -compliance[2, 1] * e_y == pytest.approx(nu_yz)
    assert -compliance[2, 0] * e_x == pytest.approx(nu_xz)
    np.testing.assert_allclose(1 / np.diag(compliance)[3:], [g_xy, g_yz, g_zx])


def test_orthotropic_with_equal_constants_is_isotropic() -> None:
    e, nu = 2.1e11, 0.3
    g = e / 2 / (1 + nu)
    matrix = el.orthotropic((e, e, e), (nu, nu, nu), (g, g, g))
    np.testing.assert_allclose(matrix, el.isotropic(e, nu), rtol=1e-12, atol=1e-2)


def random_rotation(seed: int) -> np.ndarray:
    q, _ = np.linalg.qr(np.random.default_rng(seed).standard_normal((3, 3)))
    return q * np.sign(np.linalg.det(q))


def test_rotated_matrix_is_the_rotated_tensor() -> None:
    """C_ijkl = a_mi a_nj a_pk a_ql C'_mnpq, written out with einsum."""
    axes, material = random_rotation(1), el.orthotropic(*WOOD)
    pairs = el.PAIRS[3]
    index = {pair: i for i, pair in enumerate(pairs)} | {pair[::-1]: i for i, pair in enumerate(pairs)}
    tensor = np.array(
        [
            [[[material[index[i, j], index[k, m]] for m in range(3)] for k in range(3)] for j in range(3)]
            for i in range(3)
        ]
    )
    turned = np.einsum("mi,nj,pk,ql,mnpq->ijkl", axes, axes, axes, axes, tensor)
    expected = np.array([[turned[i, j, k, m] for (k, m) in pairs] for (i, j) in pairs])
    np.testing.assert_allclose(el.rotated(material, axes), expected, rtol=1e-10, atol=1e-2)
    several = el.rotated(material, np.stack([np.eye(3), axes]))
    np.testing.assert_allclose(several, [material, expected], rtol=1e-10, atol=1e-2)


def test_isotropic_matrix_does_not_change_by_rotation() -> None:
    matrix = el.isotropic(1.0, 0.3)
    np.testing.assert_allclose(el.rotated(matrix, random_rotation(2)), matrix, atol=1e-14)


def test_plane_matrices_of_an_isotropic_material() -> None:
    e, nu = 7e10, 0.33
    stress = el.plane_stress(el.isotropic(e, nu))
    expected = e / (1 - nu**2) * np.array([[1, nu, 0], [nu, 1, 0], [0, 0, (1 - nu) / 2]])
    np.testing.assert_allclose(stress, expected, rtol=1e-12, atol=1e-3)
    strain = el.plane_strain(el.isotropic(e, nu))
    # Plane strain is plane stress with E/(1-ν²) and ν/(1-ν).
    e_s, nu_s = e / (1 - nu**2), nu / (1 - nu)
    expected = e_s / (1 - nu_s**2) * np.array([[1, nu_s, 0], [nu_s, 1, 0], [0, 0, (1 - nu_s) / 2]])
    np.testing.assert_allclose(strain, expected, rtol=1e-12, atol=1e-3)


def test_plane_stress_of_a_rotated_orthotropic_material_is_the_inverse_of_the_compliance() -> None:
    matrix = el.rotated(el.orthotropic(*WOOD), np.stack([random_rotation(s) for s in range(3)]))
    inside = [0, 1, 3]
    compliance = np.linalg.inv(matrix)[:, inside][:, :, inside]
    np.testing.assert_allclose(
        el.plane_stress(matrix) @ compliance, np.tile(np.eye(3), (3, 1, 1)), atol=1e-10
    )
    np.testing.assert_array_equal(el.plane_strain(matrix), matrix[:, inside][:, :, inside])


@pytest.mark.parametrize(
    ("call", "text"),
    [
        (lambda: el.isotropic(-1.0, 0.3), "youngs_modulus = -1.0: must be positive"),
        (lambda: el.isotropic(np.nan, 0.3), "youngs_modulus"),
        (lambda: el.isotropic(1.0, 0.5), "poisson_ratio = 0.5: must lie between -1 and 0.5"),
        (lambda: el.isotropic(1.0, -1.0), "poisson_ratio"),
        (lambda: el.orthotropic((1.0, 1.0, 1.0), (0.6, 0.6, 0.6), (1.0, 1.0, 1.0)), "positive strain energy"),
        (lambda: el.orthotropic((1.0, 20.0, 1.0), (0.3, 0.3, 0.0), (1.0, 0.0, 1.0)), "shear_moduli = 0.0"),
        (lambda: el.rotated(np.eye(6), 2.0 * np.eye(3)), "orthonormal"),
        (lambda: el.check_elasticity(np.eye(5), 6), r"\(6, 6\)"),
        (lambda: el.check_elasticity(np.diag([1.0, 1.0, -1.0]), 3), "positive definite"),
        (lambda: el.check_elasticity(np.eye(3) + np.eye(3, k=1) * 0.1, 3), "symmetric"),
        (lambda: el.check_elasticity(np.full((2, 3, 3), np.nan), 3), "finite"),
    ],
)
def test_impossible_materials_are_named(call, text: str) -> None:
    with pytest.raises(InputError, match=text):
        call()


def test_one_bad_matrix_among_many_is_found() -> None:
    many = np.tile(el.isotropic(2e11, 0.3), (5, 1, 1))
    assert el.check_elasticity(many, 6) is not None
    many[3, 3, 3] = -1.0
    with pytest.raises(InputError, match="positive definite"):
        el.check_elasticity(many, 6)

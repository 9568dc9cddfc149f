"""Classes of congruent elements."""

import numpy as np

from axlespan.elements import congruence
from axlespan.elements.congruence import congruent


def shifted(shape: np.ndarray, count: int, seed: int = 0) -> np.ndarray:
    offsets = np.random.default_rng(seed).uniform(-1000, 1000, (count, 1, shape.shape[1]))
    return shape + offsets


def test_translated_copies_are_one_class_and_others_are_not() -> None:
    a, b = np.random.default_rng(1).uniform(0, 0.3, (2, 8, 3))
    x = np.concatenate([shifted(a, 500), shifted(b, 300), shifted(a, 200, seed=7)])
    classes = congruent(x)
    assert len(classes) == 2
    assert classes.first.tolist() == [0, 500]
    assert classes.label.tolist() == [0] * 500 + [1] * 300 + [0] * 200


def test_properties_split_classes() -> None:
    x = shifted(np.random.default_rng(1).uniform(0, 1, (4, 2)), 6)
    material = np.array([1.0, 2.0, 1.0, 2.0, 0.0, -0.0])
    assert congruent(x, material).label.tolist() == [0, 1, 0, 1, 2, 2]


def test_a_real_difference_of_shape_is_kept() -> None:
    x = np.zeros((2, 3, 2)) + np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    x[1, 2, 1] += 1e-9
    assert len(congruent(x)) == 2
    x[1, 2, 1] = 1.0 + 1e-15
    assert len(congruent(x)) == 1


def test_batches_visit_each_element_once_with_its_own_class() -> None:
    label = np.random.default_rng(2).integers(0, 40, 1000)
    shapes = np.random.default_rng(3).uniform(0, 1, (40, 4, 3))
    x = shapes[label] + np.random.default_rng(4).uniform(0, 50, (1000, 1, 3))
    seen = np.zeros(1000, int)
    for elements, distinct, position in congruent(x).batches(64):
        seen[elements] += 1
        assert len(elements) <= 64 and len(distinct) <= 64
        np.testing.assert_array_equal(label[distinct[position]], label[elements])
    assert (seen == 1).all()


def test_a_collision_of_the_hash_does_not_merge_elements(monkeypatch) -> None:
    class Constant:
        def integers(self, *_: object, size: int, **__: object) -> np.ndarray:
            return np.zeros(size, np.uint64)

    monkeypatch.setattr(congruence.np.random, "default_rng", lambda _: Constant())
    # With equal multipliers a permutation of a row has the same key.
    x = np.array([[[0.0, 0.0], [1.0, 2.0]], [[0.0, 0.0], [2.0, 1.0]], [[5.0, 5.0], [6.0, 7.0]]])
    assert congruent(x).label.tolist() == [0, 1, 0]


def test_no_elements() -> None:
    assert len(congruent(np.empty((0, 8, 3)))) == 0

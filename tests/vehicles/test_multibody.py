"""Multibody vehicles in the plane: matrices, frequencies and static forces against matrices written by hand."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.linalg import eigh

from axlespan.errors import InputError
from axlespan.vehicles import Body, BodyLoad, Hinge, Suspension, Wheel, multibody

G = 9.81


def by_name(system, matrix, names):
    at = [list(system.independent).index(system.dof(name)) for name in names]
    return matrix.toarray()[np.ix_(at, at)]


# ICE 3: masses, inertias, primary and secondary suspension, half distances of bogies and axles.
MC, IC, MB, IB, MW = 47.8e3, 1_957_888.0, 3500.0, 1715.0, 1800.0
KP, CP, KS, CS, L, B = 2.4e6, 20e3, 0.7e6, 40e3, 17.375 / 2, 1.25


def coach():
    bodies = [
        Body("body", MC, L + B, IC),
        Body("bogie1", MB, B, IB),
        Body("bogie2", MB, 2 * L + B, IB),
    ]
    wheels = [Wheel(x, MW) for x in (0.0, 2 * B, 2 * L, 2 * L + 2 * B)]
    pairs = [("bogie1", "wheel1"), ("bogie1", "wheel2"), ("bogie2", "wheel3"), ("bogie2", "wheel4")]
    primary = [Suspension(pair, KP, CP) for pair in pairs]
    secondary = [Suspension(("body", bogie), KS, CS) for bogie in ("bogie1", "bogie2")]
    return multibody(bodies=bodies, wheels=wheels, suspensions=primary + secondary)


NAMES = (
    "body.z", "body.pitch", "bogie1.z", "bogie1.pitch", "bogie2.z", "bogie2.pitch",
    "wheel1.z", "wheel2.z", "wheel3.z", "wheel4.z",
)  # fmt: skip


def ten_dof(secondary, primary):
    """The matrix of the 10-dof coach, row by row; pitch lowers the front."""
    s, p = secondary, primary
    a = np.zeros((10, 10))
    a[0, [0, 2, 4]] = 2 * s, -s, -s
    a[1, [1, 2, 4]] = 2 * s * L**2, s * L, -s * L
    for bogie, sign, first in ((2, 1.0, 6), (4, -1.0, 8)):
        a[bogie, [0, 1, bogie]] = -s, sign * s * L, s + 2 * p
        a[bogie, [first, first + 1]] = -p, -p
        a[bogie + 1, [bogie + 1, first, first + 1]] = 2 * p * B**2, p * B, -p * B
        a[first, [bogie, bogie + 1, first]] = -p, p * B, p
        a[first + 1, [bogie, bogie + 1, first + 1]] = -p, -p * B, p
    return a


class TestCoach:
    def test_matrices(self):
        system = coach().system
        np.testing.assert_allclose(
            by_name(system, system.stiffness, NAMES), ten_dof(KS, KP), rtol=1e-12, atol=1e-6
        )
        np.testing.assert_allclose(
            by_name(system, system.damping, NAMES), ten_dof(CS, CP), rtol=1e-12, atol=1e-8
        )
        mass = np.diag([MC, IC, MB, IB, MB, IB, MW, MW, MW, MW])
        np.testing.assert_array_equal(by_name(system, system.mass, NAMES), mass)

    def test_frequencies(self):
        mass = np.diag([MC, IC, MB, IB, MB, IB])
        omega2 = eigh(ten_dof(KS, KP)[:6, :6], mass, eigvals_only=True)
        np.testing.assert_allclose(coach().frequencies(), np.sqrt(omega2) / (2 * np.pi), rtol=1e-10)

    def test_bounce_and_pitch_with_bogies_held(self):
        k, m = ten_dof(KS, KP)[:2, :2], np.diag([MC, IC])
        bounce, pitch = np.sqrt(np.diag(k) / np.diag(m)) / (2 * np.pi)
        assert bounce == pytest.approx(0.8613, abs=1e-4)
        stiff = [Suspension(("body", f"wheel{i + 1}"), KS) for i in range(2)]
        held = multibody(
            bodies=[Body("body", MC, L, IC)], wheels=[Wheel(0.0), Wheel(2 * L)], suspensions=stiff
        )
        np.testing.assert_allclose(held.frequencies(), sorted([bounce, pitch]), rtol=1e-10)

    def test_axle_loads(self):
        np.testing.assert_allclose(coach().static_forces(), (MC + 2 * MB + 4 * MW) * G / 4)
        assert coach().static_forces()[0] == pytest.approx(152.06e3, rel=1e-4)
        assert coach().total_mass == pytest.approx(MC + 2 * MB + 4 * MW)


# Five-axle articulated truck: masses and inertias of tractor and trailer, a2 from the fifth wheel to the trailer's
# center, b1 from the tractor's center to the fifth wheel, axles ahead (+) and behind (-) their body's center.
M1, I1, M2, I2, A2, B1 = 4500.0, 4604.0, 31450.0, 16302.0, 6.15, 2.15
K_S = np.array([400e3, 1000e3, 750e3, 750e3, 750e3])
K_T = np.array([1.75e6, 3.5e6, 3.5e6, 3.5e6, 3.5e6])
AXLE = np.array([700.0, 1100.0, 750.0, 750.0, 750.0])
BEHIND = np.array([-0.5, 2.5, 1.8, 2.9, 4.0])  # of the axles, behind the center of their own body


def truck():
    tractor, hinge = 0.5, 0.5 + B1
    trailer = hinge + A2
    x = np.concatenate([tractor + BEHIND[:2], trailer + BEHIND[2:]])
    bodies = [Body("tractor", M1, tractor, I1), Body("trailer", M2, trailer, I2)]
    bodies += [Body(f"axle{i + 1}", AXLE[i], x[i]) for i in range(5)]
    suspensions = [
        Suspension(("tractor" if i < 2 else "trailer", f"axle{i + 1}"), K_S[i], at=x[i]) for i in range(5)
    ]
    suspensions += [Suspension((f"axle{i + 1}", f"wheel{i + 1}"), K_T[i]) for i in range(5)]
    return multibody(
        bodies=bodies,
        wheels=[Wheel(position) for position in x],
        suspensions=suspensions,
        hinges=[Hinge(("tractor", "trailer"), hinge)],
    )


def eight_dof():
    """K and M of the truck over yB1, θB1, θB2, axles, with the constraint of the fifth wheel put in by hand."""
    # θ > 0 lowers the front: a point d behind a center moves by z + d θ; yB2 = yB1 + b1 θ1 + a2 θ2.
    rows = np.zeros((5, 8))
    rows[:2, 0], rows[:2, 1] = 1.0, BEHIND[:2]
    rows[2:, 0], rows[2:, 1], rows[2:, 2] = 1.0, B1, A2 + BEHIND[2:]
    rows[np.arange(5), 3 + np.arange(5)] = -1.0
    k = rows.T @ (K_S[:, None] * rows)
    k[3:, 3:] += np.diag(K_T)
    trailer = np.array([1.0, B1, A2, 0, 0, 0, 0, 0])
    m = np.diag([M1, I1, I2, *AXLE]) + M2 * np.outer(trailer, trailer)
    return k, m


class TestTruck:
    NAMES = ("tractor.z", "tractor.pitch", "trailer.pitch", *(f"axle{i + 1}.z" for i in range(5)))

    def test_matrices(self):
        system, (k, m) = truck().system, eight_dof()
        np.testing.assert_allclose(by_name(system, system.stiffness, self.NAMES), k, rtol=1e-12, atol=1e-6)
        np.testing.assert_allclose(by_name(system, system.mass, self.NAMES), m, rtol=1e-12, atol=1e-8)

    def test_frequencies(self):
        k, m = eight_dof()
        expected = np.sqrt(eigh(k, m, eigvals_only=True)) / (2 * np.pi)
        np.testing.assert_allclose(truck().frequencies(), expected, rtol=1e-9)

    def test_the_fifth_wheel_carries_the_trailer_by_levers(self):
        """Two free bodies by hand: the trailer on the fifth wheel and its three springs."""
        k, _ = eight_dof()
        u = np.linalg.solve(k, -G * np.concatenate([[M1 + M2, M2 * B1, M2 * A2], AXLE]))
        np.testing.assert_allclose(truck().static_forces(), -K_T * u[3:], rtol=1e-10)
        loads = truck().static_forces()
        x = np.array([point.behind for point in truck().contacts])
        moment = loads @ x - G * (M1 * 0.5 + M2 * (0.5 + B1 + A2) + AXLE @ x)
        assert loads.sum() == pytest.approx((M1 + M2 + AXLE.sum()) * G)
        assert moment == pytest.approx(0.0, abs=1e-3)

    def test_hinges_in_a_row(self):
        """Three bodies on two hinges, the middle one without wheels of its own: a beam on two hinges."""
        chain = multibody(
            bodies=[Body("a", 9e3, 3.0, 1e4), Body("b", 4e3, 8.0, 1e4), Body("c", 9e3, 13.0, 1e4)],
            wheels=[Wheel(0.0), Wheel(5.0), Wheel(11.0), Wheel(16.0)],
            suspensions=[
                Suspension((body, f"wheel{i}"), 1e6)
                for i, body in enumerate(("a", "a", "c", "c"), 1)
            ],
            hinges=[Hinge(("a", "b"), 6.0), Hinge(("b", "c"), 10.0)],
        )  # fmt: skip
        # half of b hangs on each neighbor, 6 m behind the first wheel of a
        front = 9e3 * (2.0 / 5.0) + 2e3 * (-1.0 / 5.0)
        rear = 9e3 * (3.0 / 5.0) + 2e3 * (6.0 / 5.0)
        np.testing.assert_allclose(
            chain.static_forces(), np.array([front, rear, rear, front]) * G, rtol=1e-10
        )


class TestJacobsBogies:
    """Three coaches on four bogies: the two in the middle carry the ends of two coaches each."""

    def train_set(self):
        centers = 1.5 + 18.7 * np.arange(4)
        bogies = [Body(f"bogie{i + 1}", 2900.0, x, 2508.0) for i, x in enumerate(centers)]
        coaches = [
            Body(f"coach{i + 1}", 22e3, 0.5 * (a + b), 8e5) for i, (a, b) in enumerate(pairwise(centers))
        ]
        wheels = [Wheel(x + side, 1900.0) for x in centers for side in (-1.5, 1.5)]
        suspensions = [Suspension((f"bogie{i // 2 + 1}", f"wheel{i + 1}"), 2e6) for i in range(8)]
        suspensions += [
            Suspension((f"coach{i + 1}", f"bogie{i + 1 + end}"), 0.58e6, 20e3)
            for i in range(3)
            for end in (0, 1)
        ]
        return multibody(bodies=coaches + bogies, wheels=wheels, suspensions=suspensions)

    def test_a_shared_bogie_carries_two_half_coaches(self):
        end, shared = (0.5 * 22e3 + 2900.0) / 2 + 1900.0, (22e3 + 2900.0) / 2 + 1900.0
        expected = np.array([end, end, shared, shared, shared, shared, end, end]) * G
        np.testing.assert_allclose(self.train_set().static_forces(), expected, rtol=1e-10)

    def test_frequencies(self):
        """All 14 of them against matrices of the energies, spring by spring, in the test."""
        centers = 1.5 + 18.7 * np.arange(4)
        k = np.zeros((14, 14))  # z, θ of three coaches; z, θ of four bogies
        for coach in range(3):
            middle = 0.5 * (centers[coach] + centers[coach + 1])
            for bogie in (coach, coach + 1):
                row = np.zeros(14)
                row[[2 * coach, 2 * coach + 1, 6 + 2 * bogie]] = 1.0, centers[bogie] - middle, -1.0
                k += 0.58e6 * np.outer(row, row)
        for bogie in range(4):
            for side in (-1.5, 1.5):
                row = np.zeros(14)
                row[[6 + 2 * bogie, 7 + 2 * bogie]] = 1.0, side
                k += 2e6 * np.outer(row, row)
        m = np.diag([22e3, 8e5] * 3 + [2900.0, 2508.0] * 4)
        expected = np.sqrt(eigh(k, m, eigvals_only=True)) / (2 * np.pi)
        np.testing.assert_allclose(self.train_set().frequencies(), expected, rtol=1e-9)


def test_loads_in_the_plane():
    """A weight on the body and a braking moment: shares by the lever rule."""
    car = multibody(
        bodies=[Body("body", 1e4, 3.0, 5e4)],
        wheels=[Wheel(0.0), Wheel(5.0)],
        suspensions=[Suspension(("body", "wheel1"), 1e6), Suspension(("body", "wheel2"), 2e6)],
    )
    empty = car.static_forces()
    loaded = car.loaded([BodyLoad("body", z=-1e3, pitch=500.0)])
    np.testing.assert_allclose(loaded.static_forces() - empty, [400.0 + 100.0, 600.0 - 100.0], rtol=1e-9)
    np.testing.assert_allclose(loaded.static_forces(0.0), [500.0, 500.0], rtol=1e-9)
    np.testing.assert_array_equal(loaded.frequencies(), car.frequencies())
    with pytest.raises(InputError, match=r"wheel '1' of vehicle .* would tip over"):
        car.loaded([BodyLoad("body", pitch=-5e5)]).static_forces()


def car(body=None, wheels=None, suspensions=None, **more):
    return multibody(
        bodies=[body or Body("body", 1e4, 2.0, 5e4)],
        wheels=wheels or [Wheel(0.0), Wheel(4.0)],
        suspensions=[Suspension(("body", "wheel1"), 1e6), Suspension(("body", "wheel2"), 1e6)]
        if suspensions is None
        else suspensions,
        **more,
    )


@pytest.mark.parametrize(
    ("build", "rule"),
    [
        (lambda: car(Body("body", 1e4, 2.0, -5.0)), r"bodies\.0\.inertia = -5\.0: must be positive"),
        (lambda: car(Body("body", 1e4, 2.0, 0.0)), r"bodies\.0\.inertia = 0\.0: must be positive"),
        (lambda: car(Body("body", 0.0, 2.0)), r"bodies\.0\.mass = 0\.0: must be positive"),
        (lambda: car(Body("body", 1e4, float("nan"))), r"bodies\.0\.position = nan: must be a finite"),
        (lambda: car(Body("body", 1e4, 2.0, 1.0, 1.0)), r"roll_inertia: is for vehicles with left and right wheels"),
        (lambda: car(Body("wheel1", 1e4, 2.0)), "'wheel1': is the name of more than one"),
        (lambda: car(suspensions=[]), r"bodies\.0: has no suspension: nothing carries body 'body'"),
        (
            lambda: car(wheels=[Wheel(0.0), Wheel(4.0, 10.0)], suspensions=[Suspension(("body", "wheel1"), 1e6)]),
            r"suspensions: must stand on its wheels, but can move freely at .*body\.pitch",
        ),
        (lambda: car(suspensions=[Suspension(("body", "wheel1"), 1e6)]), r"wheels\.1: has no mass and no suspension"),
        (
            lambda: car(suspensions=[Suspension(("body", "whel1"), 1e6)]),
            r"suspensions\.0\.between = 'whel1': .*Did you mean 'wheel1'",
        ),
        (lambda: car(suspensions=[Suspension(("wheel1", "wheel2"), 1e6)]), "connects two wheels"),
        (lambda: car(suspensions=[Suspension(("body", "wheel1"))]), "has no stiffness and no damping"),
        (lambda: car(suspensions=[Suspension(("body", "wheel1"), -1.0)]), r"stiffness = -1\.0: must be zero or pos"),
        (lambda: car(suspensions=[Suspension(("body", "wheel1"), 1.0, spread=2.0)]), "spread = 2.0: is for vehicles"),
        (lambda: car(wheels=[Wheel(0.0), Wheel(4.0, gauge=1.5)]), r"wheels\.0\.gauge: is missing"),
        (lambda: car(wheels=[Wheel(0.0, roll_inertia=5.0), Wheel(4.0)]), r"wheels\.0\.roll_inertia = 5\.0"),
        (lambda: car(wheels=[Wheel(1.0), Wheel(4.0)]), "must have its first wheel at 0"),
        (lambda: car(hinges=[Hinge(("body", "trailer"), 3.0)]), r"hinges\.0\.between = 'trailer'"),
        (lambda: car(loads=[BodyLoad("box", z=1.0)]), r"loads\.0\.body = 'box': .* Did you mean 'body'"),
        (lambda: car(loads=[BodyLoad("body", roll=1.0)]), r"loads\.0 = 'body': turns a body that cannot roll"),
        (lambda: car(loads=[BodyLoad("body", y=1.0)]), r"loads\.0\.height: is missing"),
        (lambda: car(Body("body", 1e4, 9.0, 5e4)).static_forces(), "wheel '1' of vehicle .* must press"),
    ],
)  # fmt: skip
def test_errors(build, rule):
    with pytest.raises(InputError, match=rule):
        build()

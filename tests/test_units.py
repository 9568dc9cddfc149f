"""Units: values against hand-worked conversions, and what is said about wrong quantities."""

import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from axlespan import units
from axlespan.errors import InputError

KINDS = {name: value for name, value in vars(units).items() if isinstance(value, units.Dimension)}


@pytest.mark.parametrize(
    ("text", "kind", "expected"),
    [
        ("47.7 km/h", "SPEED", 13.25),
        ("47.7km/h", "SPEED", 13.25),
        ("80 km / h", "SPEED", 80 / 3.6),
        ("30 mph", "SPEED", 13.4112),
        ("2.87 GPa", "PRESSURE", 2.87e9),
        ("34 kN/mm^2", "PRESSURE", 34e9),
        ("1 ksi", "PRESSURE", 6894757.293168361),
        ("2.90 m^4", "SECOND_MOMENT", 2.9),
        ("2.90 m⁴", "SECOND_MOMENT", 2.9),
        ("2.9m4", "SECOND_MOMENT", 2.9),
        ("2.9 m**4", "SECOND_MOMENT", 2.9),
        ("3038.3 cm^4", "SECOND_MOMENT", 3.0383e-5),
        ("2303 kg/m", "MASS_PER_LENGTH", 2303.0),
        ("2.303 t/m", "MASS_PER_LENGTH", 2303.0),
        ("1 ms", "TIME", 1e-3),
        ("2 min", "TIME", 120.0),
        ("0.5 mm", "LENGTH", 5e-4),
        ("−5 µm", "LENGTH", -5e-6),
        (".5 m", "LENGTH", 0.5),
        ("1_000 m", "LENGTH", 1000.0),
        ("1e3m", "LENGTH", 1000.0),
        ("10 ft", "LENGTH", 3.048),
        ("7", "LENGTH", 7.0),
        (7, "LENGTH", 7.0),
        (2.5, "LENGTH", 2.5),
        ("1595 kN/m", "STIFFNESS", 1.595e6),
        ("65 kN/mm", "STIFFNESS", 65e6),
        ("1.4 GN/m", "STIFFNESS", 1.4e9),
        ("20 kNs/m", "DAMPING", 2e4),
        ("20 kN*s/m", "DAMPING", 2e4),
        ("20 kN·s/m", "DAMPING", 2e4),
        ("20 kN.s.m^-1", "DAMPING", 2e4),
        ("20 kN s m-1", "DAMPING", 2e4),
        ("3 N/(m/s)", "DAMPING", 3.0),
        ("22.5 t", "MASS", 22500.0),
        ("5 kg m^2", "INERTIA", 5.0),
        ("5 kgm²", "INERTIA", 5.0),
        ("1960 t m^2", "INERTIA", 1.96e6),
        ("180 deg", "ANGLE", math.pi),
        ("90°", "ANGLE", math.pi / 2),
        ("1 %", "RATIO", 0.01),
        ("5 ‰", "RATIO", 0.005),
        ("4.8 Hz", "FREQUENCY", 4.8),
        ("2 1/s", "FREQUENCY", 2.0),
        ("0.2 s^-1", "PER_TIME", 0.2),
        ("3.5 m/s2", "ACCELERATION", 3.5),
        ("3.5 m/s^2", "ACCELERATION", 3.5),
        ("0.35 g", "ACCELERATION", 3.4323275),
        ("5 g", "MASS", 0.005),
        ("170 kN", "FORCE", 1.7e5),
        ("1 tf", "FORCE", 9806.65),
        ("12 kNm", "MOMENT", 12e3),
        ("12 kN-m", "MOMENT", 12e3),
        ("50 MNm/rad", "ROTATIONAL_STIFFNESS", 5e7),
        ("50 MNm", "ROTATIONAL_STIFFNESS", 5e7),
        ("20 kNms/rad", "ROTATIONAL_DAMPING", 2e4),
        ("1.15e11 N/m^1.5", "HERTZ_STIFFNESS", 1.15e11),
        ("1.15e11 N/m^(3/2)", "HERTZ_STIFFNESS", 1.15e11),
        ("2500 kg/m3", "DENSITY", 2500.0),
        ("7.85 g/cm^3", "DENSITY", 7850.0),
        ("5.57 m ^2", "AREA", 5.57),
    ],
)
def test_values_are_the_nearest_to_the_exact_product(text, kind, expected):
    assert units.parse(text, KINDS[kind]) == expected


SUCH_AS_LENGTH = "Write a number and its unit, such as 25 m"


@pytest.mark.parametrize(
    ("text", "kind", "expected"),
    [
        ("25 kg", "LENGTH", "'25 kg': must be a length; 'kg' is a mass. Write 25 m"),
        ("25 foo", "LENGTH", f"'25 foo': 'foo' is not a known unit. {SUCH_AS_LENGTH}"),
        ("25 metres", "LENGTH", "'25 metres': 'metres' is not a known unit. Write 25 m"),
        ("25 m.", "LENGTH", "'25 m.': 'm.' is not a unit. Write 25 m"),
        ("25 Mm", "LENGTH", "'25 Mm': 'Mm' is not a known unit. Write 25 mm"),
        ("80 KM/H", "SPEED", "'80 KM/H': 'KM' is not a known unit. Write 80 km/h"),
        ("80 kph", "SPEED", "'80 kph': 'kph' is not a known unit. Write 80 km/h"),
        ("210 gpa", "PRESSURE", "'210 gpa': 'gpa' is not a known unit. Write 210 GPa"),
        ("10 tons", "MASS", "'10 tons': 'tons' is not a known unit. Write 10 t"),
        ("5 KN", "FORCE", "'5 KN': 'KN' is not a known unit. Write 5 kN"),
        ("22.5 t", "FORCE", "'22.5 t': must be a force; 't' is a mass. Write 220.7 kN, the weight of 22.5 t"),
        ("57 kN", "MASS", "'57 kN': must be a mass; 'kN' is a force. Write 5.81 t, which weighs 57 kN"),
        (
            "30 rad/s",
            "FREQUENCY",
            "'30 rad/s': must be a frequency; 'rad/s' is an angular frequency. "
            "Write 4.775 Hz, the angular frequency over 2 pi",
        ),
        ("5 deg", "RATIO", "'5 deg': must be a pure number; 'deg' is an angle. Write a plain number, such as 0.01, or 1 %"),
        ("5 %", "ANGLE", "'5 %': must be an angle; '%' is a pure number. Write a number and its unit, such as 2 mrad"),
        ("2 m", "NUMBER", "'2 m': must be a number; 'm' is a length. Write a plain number, such as 0.5"),
        ("1 m s", "LENGTH", "'1 m s': must be a length; 'm s' is something else. Write 1 m"),
        ("5 kN/m", "DAMPING", "'5 kN/m': must be a damping constant; 'kN/m' is a stiffness. Write 5 kNs/m"),
        ("12,5 m", "LENGTH", "'12,5 m': has a decimal comma. Write 12.5 m"),
        ("-12,5", "LENGTH", "'-12,5': has a decimal comma. Write -12.5 m"),
        (
            "1,595 kN/m",
            "STIFFNESS",
            "'1,595 kN/m': has a decimal comma. Write 1.595 kN/m, or 1595 kN/m if the comma parts thousands",
        ),
        ("1,595.5 kN/m", "STIFFNESS", "'1,595.5 kN/m': has separators in its number. Write 1595.5 kN/m"),
        ("1.595,5 kN/m", "STIFFNESS", "'1.595,5 kN/m': has separators in its number. Write 1595.5 kN/m"),
        ("1 595 kN/m", "STIFFNESS", "'1 595 kN/m': has separators in its number. Write 1595 kN/m"),
        ("1'000 m", "LENGTH", "\"1'000 m\": has separators in its number. Write 1000 m"),
        ("1.000.000 N", "FORCE", "'1.000.000 N': has separators in its number. Write 1000000 N"),
        ("1/3 m", "LENGTH", f"'1/3 m': must be one number and its unit. {SUCH_AS_LENGTH}"),
        ("25 ± 1 m", "LENGTH", f"'25 ± 1 m': must be one number and its unit. {SUCH_AS_LENGTH}"),
        ("20-25 m", "LENGTH", f"'20-25 m': must be one number and its unit. {SUCH_AS_LENGTH}"),
        ("12 5 m", "LENGTH", f"'12 5 m': must be one number and its unit. {SUCH_AS_LENGTH}"),
        ("5 m^99", "LENGTH", f"'5 m^99': 'm^99' is not a unit. {SUCH_AS_LENGTH}"),
        ("5 m/", "LENGTH", f"'5 m/': 'm/' is not a unit. {SUCH_AS_LENGTH}"),
        ("5 (m", "LENGTH", f"'5 (m': '(m' is not a unit. {SUCH_AS_LENGTH}"),
        ("m", "LENGTH", f"'m': must be a length. {SUCH_AS_LENGTH}"),
        ("", "LENGTH", f"'': must be a length. {SUCH_AS_LENGTH}"),
        (None, "LENGTH", f"None: must be a length. {SUCH_AS_LENGTH}"),
        (True, "LENGTH", f"True: must be a length. {SUCH_AS_LENGTH}"),
        ("nan", "LENGTH", "'nan': must be a finite number"),
        ("-inf m", "LENGTH", f"'-inf m': must be a length. {SUCH_AS_LENGTH}"),
        (math.nan, "LENGTH", "nan: must be a finite number"),
        (-math.inf, "LENGTH", "-inf: must be a finite number"),
        ("1e400 m", "LENGTH", "'1e400 m': must be a finite number"),
        ("1e308 km", "LENGTH", "'1e308 km': must be a finite number"),
        ("1e300 m", "LENGTH", "'1e300 m': is too large to compute with. Look at its exponent"),
        (-1e-300, "LENGTH", "-1e-300: is too small to compute with. Look at its exponent"),
    ],
)  # fmt: skip
def test_messages(text, kind, expected):
    with pytest.raises(InputError) as caught:
        units.parse(text, KINDS[kind])
    assert str(caught.value) == expected


def test_integers_beyond_floats_are_not_finite():
    with pytest.raises(InputError, match="must be a finite number"):
        units.parse(10**400, units.LENGTH)


@pytest.mark.parametrize(
    ("value", "kind", "expected"),
    [
        (2.87e9, "PRESSURE", "2.87 GPa"),
        (13.25, "SPEED", "47.7 km/h"),
        (-5e-4, "LENGTH", "-0.5 mm"),
        (25.0, "LENGTH", "25 m"),
        (1595e3, "STIFFNESS", "1.595 MN/m"),
        (0.01, "RATIO", "1 %"),
        (0.25, "NUMBER", "0.25"),
        (0.0, "FORCE", "0 N"),
        (3.0383e-5, "SECOND_MOMENT", "3038 cm^4"),
        (999.9999999, "MASS", "1000 kg"),
        (math.inf, "TIME", "inf s"),
    ],
)
def test_show(value, kind, expected):
    assert units.show(value, KINDS[kind]) == expected


def test_every_kind_reads_its_own_example_and_what_it_shows():
    for kind in KINDS.values():
        assert units.parse(kind.example, kind) > 0.0
        for unit in kind.shown:
            assert units.factor(unit, kind) > 0.0
        assert units.factor(kind.unit, kind) == 1.0


@given(st.sampled_from(sorted(KINDS)), st.floats(min_value=1e-12, max_value=1e15))
def test_what_is_shown_reads_back(name, value):
    kind = KINDS[name]
    assert units.parse(units.show(value, kind, digits=17), kind) == pytest.approx(value, rel=1e-14)


@given(
    st.lists(st.sampled_from(["m", "kg", "s", "kN", "mm", "Hz", "GPa", "t", "min"]), min_size=1, max_size=4),
    st.data(),
)
def test_products_multiply_out_from_left_to_right(symbols, data):
    signs = [data.draw(st.sampled_from(["*", "/", " "])) for _ in symbols[1:]]
    text = symbols[0] + "".join(f"{sign}{symbol}" for sign, symbol in zip(signs, symbols[1:], strict=True))
    reading = units.read(f"1 {text}")
    value, powers = 1.0, [0.0] * 4
    for sign, symbol in zip(["*", *signs], symbols, strict=True):
        one, direction = units.read(f"1 {symbol}"), -1 if sign == "/" else 1
        value *= one.value**direction
        powers = [power + direction * own for power, own in zip(powers, one.exponents, strict=True)]
    assert reading.value == pytest.approx(value, rel=1e-14)
    assert list(reading.exponents) == powers


@given(
    st.sampled_from(sorted(KINDS)),
    st.text(max_size=20) | st.from_regex(r"[0-9.,eE' ]{1,8}[a-zA-Z/^*%.()0-9 -]{0,8}"),
)
def test_any_text_is_a_finite_number_or_refused(name, text):
    try:
        value = units.parse(text, KINDS[name])
    except InputError as error:
        assert re.search(r": (must|has|'.*' is not) ?", str(error), re.S)
    else:
        assert math.isfinite(value)

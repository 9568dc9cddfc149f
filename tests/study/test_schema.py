"""The JSON Schema agrees with the loader."""

import pytest
from ruamel.yaml import YAML

from axlespan.errors import InputError
from axlespan.study import read_case, schema

jsonschema = pytest.importorskip("jsonschema")


@pytest.fixture(scope="module")
def validator():
    described = schema()
    jsonschema.Draft202012Validator.check_schema(described)
    return jsonschema.Draft202012Validator(described)


def data_of(text):
    return YAML(typ="safe", pure=True).load(text)


RIGHT = [
    (),
    (("speed: 80 km/h", "speed_history: [[0, 80 km/h], [5 s, 20]]"),),
    (
        (
            "steps: 2000",
            "duration: 2 s\n  contact: rigid\n  footprint: auto\n  method: iterative\n  tolerance: 1e-8",
        ),
    ),
    (
        (
            "{kind: rayleigh, ratio: 1 %, frequencies: [3 Hz, 12 Hz]}",
            "{kind: rayleigh, alpha: 0.2, beta: 0.1 ms}",
        ),
    ),
    (("{kind: rayleigh, ratio: 1 %, frequencies: [3 Hz, 12 Hz]}", "{kind: modal, ratio: 1 %}"),),
    (("80 km/h", "80 km/h\n  irregularity: {kind: table, points: [[0, 0], [1 m, 2 mm]], from: 0, to: 1 m}"),),
    (
        (
            "80 km/h",
            "80 km/h\n  irregularity: {kind: spectrum, name: fra-4, seed: 1, wavelengths: [1 m, 80 m]}",
        ),
    ),
    (("80 km/h", "80 km/h\n  irregularity: none"),),
    (
        (
            "80 km/h",
            "80 km/h\n  irregularity: {kind: sum, of: [none, {kind: bump, at: 1, height: 1 mm, length: 2 m}, "
            "{kind: ramp, from: 0, to: 1, height: 1 mm}, {kind: dipped-joint, at: 1, depth: 1 mm, length: 1 m}, "
            "{kind: squat, at: 1, depth: 1 mm, length: 40 mm, crest: 30 %}, {kind: settlement, at: 0, depth: 9 mm, "
            "inflection: 3}, {kind: pothole, at: 1, depth: 9 mm, length: 1 m, edge: 0.1 m}]}",
        ),
    ),
    (
        (
            "80 km/h",
            "80 km/h\n  irregularity: {kind: table, points: [[0, 0], [1 m, 2 mm]], smooth: true, detrend: true, "
            "band: D1, scale: -1, shift: 3 m}",
        ),
    ),
    (
        (
            "80 km/h",
            "80 km/h\n  irregularity: {kind: table, points: [[0, 0], [1, 0]], detrend: 2, band: [3 m, 25 m]}",
        ),
    ),
    (
        (
            "count: 3",
            "count: 3\n    wheel_flat: {length: 50 mm, wheels: [1.1, '1.2'], shape: rounded, at: 3 m}",
        ),
    ),
    (("count: 3", "count: 3\n    out_of_round: [{amplitude: 1 mm, order: 3, wheels: all, phase: 30 deg}]"),),
    (("count: 3", "count: 3\n    contact_patch: 0.24 m"),),
    (
        (
            "80 km/h",
            "80 km/h\n  acceleration: -0.5 m/s^2\n  to_speed: 10\n  direction: backward\n  delay: 1 s",
        ),
    ),
    (
        (
            "80 km/h",
            "80 km/h\n  irregularity: {kind: lines, lines: {main: none, left: {kind: table, points: [[0, 0], [1, 0]]}}}",
        ),
    ),
    (
        (
            "analysis:",
            "other_trains:\n  - {train: [{vehicle: hslm-b, forces: 12, distance: 3 m}], speed: 30}\nanalysis:",
        ),
    ),
    (("steps: 2000", "steps: 2000\n  vehicles: axle-loads"),),
    (
        (
            "<train>",
            "  - {vehicle: axle-loads, loads: [170 kN, 170 kN], spacings: [3 m]}\n  - {vehicle: ice3, gap: 3 m}",
        ),
    ),
    (
        (
            "elements: 20",
            "elements: 20\n  supports: [{at: 0, fixed: [z]}, {at: 25 m, stiffness: {z: 1 GN/m}}]",
        ),
    ),
    (("output:", "output:\n  fields: {every: 10}\n  reactions: false\n  every: 2"),),
    (("output:", "output:\n  section_forces: [midspan]\n  envelopes: [moment, deflection]"),),
]
WRONG = [
    ("length:", "lenght:"),
    ("25 m", "-25"),
    ("25 m", "true"),
    ("simple-span", "arch"),
    ("speed: 80 km/h", "start: 0 m"),
    ("speed: 80 km/h", "speed: 80 km/h\n  speed_history: [[0, 80 km/h], [5 s, 20]]"),
    ("  steps: 2000\n", ""),
    ("steps: 2000", "steps: 2000\n  method: newton"),
    ("steps: 2000", "steps: 2000\n  alpha: 0.1"),
    ("elements: 20", "elements: 2.5"),
    ("    stiffness: 1595 kN/m\n", ""),
    ("reactions", "reaction"),
    ("midspan: 12.5 m", "midspan: [12.5 m]"),
    ("output:", "output:\n  envelopes: [displacement]"),
    ("80 km/h", "80 km/h\n  irregularity: {kind: sum, of: []}"),
    ("80 km/h", "80 km/h\n  irregularity: {kind: sum, of: [{kind: sum, of: [none]}]}"),
    ("80 km/h", "80 km/h\n  irregularity: {kind: lines, lines: {}}"),
    ("80 km/h", "80 km/h\n  irregularity: {kind: squat, at: 1, depth: 0, length: 40 mm}"),
    ("80 km/h", "80 km/h\n  irregularity: {kind: table, points: [[0, 0], [1, 0]], band: D4}"),
    ("count: 3", "count: 3\n    out_of_round: {order: 3}"),
    ("count: 3", "count: 3\n    wheel_flat: {length: 50 mm, wheels: []}"),
]


@pytest.mark.parametrize("edits", RIGHT)
def test_what_the_loader_takes_the_schema_takes(validator, footbridge, blocks, edits):
    for old, new in edits:
        footbridge = footbridge.replace(blocks.get(old, old), new)
    read_case(footbridge)
    assert [error.message for error in validator.iter_errors(data_of(footbridge))] == []


@pytest.mark.parametrize(("old", "new"), [pair for pair in WRONG if pair[0] != "reactions"])
def test_what_the_schema_refuses_the_loader_refuses(validator, footbridge, old, new):
    text = footbridge.replace(old, new, 1)
    assert text != footbridge
    with pytest.raises(InputError):
        read_case(text)
    assert list(validator.iter_errors(data_of(text)))


def test_descriptions_name_the_units():
    described = schema()
    assert described["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    parts = described["$defs"]
    number, text = parts["SimpleSpan"]["properties"]["youngs_modulus"]["anyOf"]
    assert (number["description"], number["exclusiveMinimum"]) == ("In Pa.", 0.0)
    assert text["description"] == "With its unit: '210 GPa'."
    assert parts["SprungMass"]["properties"]["stiffness"]["anyOf"][0]["description"] == "In N/m."
    undescribed = [
        f"{name}.{key}"
        for name, part in parts.items()
        for key, value in part["properties"].items()
        if key not in ("kind", "vehicle", "x", "y", "z", "rx", "ry", "rz")
        and "description" not in value
        and "anyOf" not in value
    ]
    assert undescribed == []


def test_the_fixed_names_are_there():
    described = schema()
    assert list(described["properties"]) == [
        *("title", "structure", "train", "crossing", "other_trains", "analysis", "output", "assessment")
    ]
    parts = described["$defs"]
    assert {"time_step", "steps", "alpha", "beta", "gamma", "method", "basis", "contact"} <= set(
        parts["Analysis"]["properties"]
    )
    assert {"from", "to", "amplitude", "wavelength"} <= set(parts["HarmonicIrregularity"]["properties"])
    assert {
        "sensors",
        "compare",
        "every",
        "reactions",
        "line",
        "fields",
        "section_forces",
        "stresses",
        "envelopes",
    } == set(parts["Output"]["properties"])

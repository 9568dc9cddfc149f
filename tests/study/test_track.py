"""Tracks, decks in a row, frames and load distributions of case files: what is built, and what is found then."""

import numpy as np
import pytest

from axlespan.errors import InputError
from axlespan.interaction.runs import run_plan
from axlespan.study.build import build

DAMPING = "  damping: {kind: rayleigh, ratio: 1 %, frequencies: [3 Hz, 12 Hz]}"


def tracked(track, *more):
    """Edits that lay a track on the bridge."""
    return ((DAMPING, f"  track: {track}"), *more)


ON_GROUND = (
    ("  kind: simple-span", "  kind: track"),
    ("  length: 25 m\n  youngs_modulus: 34 GPa\n  second_moment: 0.9 m^4\n", "  length: 60 m\n"),
    ("  mass_per_length: 12 t/m\n  elements: 20\n", ""),
    (DAMPING, "  track: ballasted"),
)


EARLIER = (
    "speed: 80 km/h",
    "speed: 80 km/h\n  start: -15 m",
)  # before the bridge, where rails at rest do no harm


class TestTrack:
    def test_of_a_word(self, loaded):
        built = build(loaded(*tracked("ballasted"), EARLIER))
        structure = built.crossing.structure
        assert set(structure.lines) == {"main", "rail", "deck"}
        assert structure.line("deck").stop == 25.0
        assert built.cautions == ()
        text = "\n".join(built.facts)
        assert "ballasted track zhai-2004, rail CHN60, supports every 0.6 m, 1/beta = 0.867 m" in text
        assert "rail: -49.2 to 74.4 m" in text
        assert "to be checked: shear_damping, shear_stiffness" in text

    def test_of_values(self, loaded):
        values = "preset: railfe, rail: 54E1, sleeper_spacing: 0.5 m, pad_stiffness: 120 MN/m"
        track = f"{{kind: ballasted, {values}, approach: 30 m, exit: 28 m}}"
        structure = build(loaded(*tracked(track))).crossing.structure
        assert structure.line().start == -30.0
        assert structure.line().stop == pytest.approx(53.0)
        pads = next(part for part in structure.model.parts if part.name == "pads")
        assert np.median(pads.stiffness) == 120e6
        rail = next(part for part in structure.model.parts if part.name == "rail")
        assert np.min(rail.properties.bending_stiffness_y) == pytest.approx(2 * 210e9 * 2.3372e-5)

    @pytest.mark.parametrize("name", ["60E1", "'60E1'", "46E3", "UIC60"])
    def test_rails_whose_names_are_numbers_to_yaml(self, loaded, name):
        case = loaded(*tracked(f"{{kind: slab, rail: {name}}}")).case
        assert case.structure.track.rail == name.strip("'")

    def test_zones_and_run_in(self, loaded):
        track = "{kind: ballasted, run_in: 10 m, zones: [{from: -12 m, to: 0 m, factor: [1, 3]}]}"
        structure = build(loaded(*tracked(track))).crossing.structure
        ballast = next(part for part in structure.model.parts if part.name == "ballast")
        assert ballast.stiffness.max() > 100.0 * 275.5e6  # at the ends
        x = structure.model.points[ballast.nodes[:, 1], 0]
        last = np.argmin(np.abs(x + 0.3))
        assert ballast.stiffness[last, 0] == pytest.approx(275.5e6 * (3.0 - 2.0 * 0.3 / 12.0))

    def test_on_the_ground_alone(self, loaded):
        structure = build(loaded(*ON_GROUND)).crossing.structure
        assert structure.system.support_names == ("track.z",)
        assert (structure.line().start, structure.line().stop) == (0.0, 60.0)

    def test_on_other_kinds_of_decks(self, loaded):
        spans = (("simple-span", "simple-spans"), ("length: 25 m", "spans: [{length: 25 m}, {length: 20 m}]"))
        structure = build(loaded(*spans, *tracked("slab"))).crossing.structure
        assert structure.line("deck").stop == 45.0
        assert structure.system.support_names[:4] == (
            "span1.left.z",
            "span1.right.z",
            "span2.left.z",
            "span2.right.z",
        )

    def test_sensors_on_deck_and_rail(self, loaded):
        sensors = ("    midspan: 12.5 m", "    midspan: 12.5 m\n    above: {at: 12.5 m, line: rail}")
        built = build(loaded(*tracked("ballasted"), sensors, ("steps: 2000", "steps: 600")))
        result = run_plan(built.plan)
        deck, rail = result.sensor_displacement.min(axis=0)
        assert result.sensor == ("midspan", "above")
        assert rail < 1.05 * deck < 0.0

    def test_a_short_approach_is_warned_of(self, loaded):
        built = build(loaded(*tracked("{kind: ballasted, approach: 18 m}"), EARLIER))
        assert built.cautions == (
            "case.yaml: structure: track: approach = 18 m is shorter than the run-in of 15 m and 10 characteristic "
            "lengths of 0.867 m: the bridge may feel where the track ends; use at least 23.7 m",
        )

    def test_a_start_at_the_bridge_is_warned_of(self, loaded):
        (word,) = build(loaded(*tracked("ballasted"))).cautions
        assert "starts at the bridge, on a track that does not move yet" in word
        assert "at -10 m or further away" in word


class TestSleepers:
    def test_they_share_the_loads(self, loaded):
        steps = ("steps: 2000", "steps: 1000\n  load_distribution: {kind: sleepers, spacing: 0.65 m}")
        built = build(loaded(steps))
        assert built.plan.settings.sleepers == 0.65
        assert (
            build(loaded(("steps: 2000", "steps: 10\n  load_distribution: sleepers"))).plan.settings.sleepers
            == 0.6
        )
        assert (
            build(loaded(("steps: 2000", "steps: 10\n  load_distribution: point"))).plan.settings.sleepers
            == 0.0
        )


class TestFrames:
    def test_a_portal_of_the_case_file(self, loaded):
        column = "height: 8 m, youngs_modulus: 34 GPa, second_moment: 0.2 m^4, area: 2 m^2"
        columns = f"[{{at: 0 m, {column}}}, {{at: 25 m, {column}, base: pinned, mass_per_length: 5 t/m}}]"
        built = build(
            loaded(
                ("simple-span", "frame"),
                ("length: 25 m", "spans: [{length: 25 m, area: 4 m^2}]"),
                ("elements: 20", f"elements: 20\n  columns: {columns}"),
            )
        )
        assert built.crossing.structure.system.support_names == (
            "column1.x",
            "column1.z",
            "column1.ry",
            "column2.x",
            "column2.z",
        )

    def test_stations_of_the_case_file(self, loaded):
        stations = "[{at: 0 m, second_moment: 2 m^4}, {at: 12.5 m, second_moment: 0.5 m^4}, {at: 25 m, second_moment: 2 m^4}]"
        built = build(
            loaded(
                ("simple-span", "continuous-beam"),
                ("length: 25 m", "spans: [{length: 25 m}]"),
                ("elements: 20", f"elements: 20\n  stations: {stations}"),
            )
        )
        stiffness = built.crossing.structure.model.parts[0].properties.bending_stiffness_y
        assert stiffness[0] == pytest.approx(34e9 * 1.925, rel=0.01)
        assert stiffness[9] == pytest.approx(34e9 * 0.575, rel=0.02)


LATE = {
    "approach": (
        tracked("{kind: ballasted, approach: 10 m}"),
        "case.yaml:9:38: structure.track.approach = 10 m: must be longer than the run-in, 15 m. Use 49 m",
    ),
    "spacing": (
        tracked("{kind: ballasted, sleeper_spacing: 6 m}"),
        "case.yaml:9:45: structure.track.sleeper_spacing = 6 m: must be at most 3 m. 0.6 m is usual",
    ),
    "zone": (
        tracked("{kind: ballasted, zones: [{from: 200 m, to: 210 m, factor: 2}]}"),
        "case.yaml:9:36: structure.track.zones.0 = 200 to 210 m: lies off the track, which goes from -49.2 to 74.4 m",
    ),
    "layer": (
        tracked("{kind: ballasted, zones: [{from: -10 m, to: 0 m, factor: [1, 2], layer: balast}]}"),
        "case.yaml:9:82: structure.track.zones.0.layer = balast: is not a known layer of this track. Did you mean "
        "'ballast'?",
    ),
    "no values": (
        tracked("{kind: ballasted, preset: none}"),
        "case.yaml:9:3: structure.track.sleeper_spacing: is missing. Give it, or name a preset",
    ),
    "length": (
        (*ON_GROUND, ("length: 60 m", "length: 50 m")),
        "case.yaml:4:11: structure.length = 50 m: must be a whole number of spacings, 0.6 m. Use 49.8 m",
    ),
    "sensor": (
        tracked("ballasted", ("midspan: 12.5 m", "midspan: {at: 200 m, line: rail}")),
        "case.yaml:23:14: output.sensors.midspan = 200.0: must lie on the structure, between -49.2 and 74.4 m",
    ),
    "line": (
        tracked("ballasted", ("midspan: 12.5 m", "midspan: {at: 2 m, line: rial}")),
        "case.yaml:23:30: output.sensors.midspan.line = rial: no such running line. Did you mean 'rail'?",
    ),
}


@pytest.mark.parametrize("name", LATE)
def test_what_is_found_when_it_is_built(loaded, name):
    edits, message = LATE[name]
    with pytest.raises(InputError) as caught:
        build(loaded(*edits))
    assert str(caught.value) == message


GRID = (
    ("  kind: simple-span", "  kind: beam-grid"),
    ("  second_moment: 0.9 m^4", "  girders: [-3 m, -1 m, 1 m, 3 m]"),
    (
        "  mass_per_length: 12 t/m",
        "  girder: {second_moment: 0.4 m^4, torsion_constant: 0.02 m^4, area: 1.2 m^2, mass_per_length: 3 t/m}\n"
        "  cross_beam: {second_moment: 0.02 m^4, torsion_constant: 0.02 m^4, area: 0.5 m^2}\n"
        "  skew: 30 deg\n  bearings: {stiffness: 3 GN/m, damping: 1 MNs/m}",
    ),
)


class TestGrids:
    def test_a_skew_deck_with_track(self, loaded):
        built = build(loaded(*GRID, *tracked("ballasted")))
        structure = built.crossing.structure
        assert {"main", "rail", "left", "right", "deck"} <= set(structure.lines)
        shift = 0.75 * np.tan(np.radians(30.0))
        approach = -structure.line().start - shift
        assert approach == pytest.approx(0.6 * np.ceil(49.0 / 0.6))
        assert "girder4.end.z" in structure.system.support_names

    @pytest.mark.parametrize(
        ("change", "message"),
        [
            (
                ("skew: 30 deg", "skew: 80 deg"),
                "structure.skew = 80 deg: must be at most 60 deg to either side",
            ),
            (("elements: 20", "elements: 20\n  cross_beams: 7"), "must divide the 20 elements of a girder"),
            (("skew: 30 deg", "track_centers: [5 m]"), "must lie between the outer girders, -3 and 3 m"),
        ],
    )
    def test_bad_grids(self, loaded, change, message):
        with pytest.raises(InputError) as caught:
            build(loaded(*GRID, change))
        assert message in str(caught.value)


class TestMeshes:
    def test_track_on_a_beam_of_solids(self, loaded):
        """The solid's end sections hold it as pins do; under stiff track it bends as a beam."""
        mesh = (
            "  kind: mesh\n  mesh: {box: {lengths: [25 m, 1.5 m, 2 m], divisions: [50, 2, 2]}}\n"
            "  materials: {concrete: {youngs_modulus: 34 GPa, poisson_ratio: 0.2, density: 2500 kg/m^3}}\n"
            "  sections: {volume: {material: concrete}}\n"
            "  supports:\n    - {name: left, at: {x: 0 m, z: 1 m}, fixed: [x, y, z]}\n"
            "    - {name: right, at: {x: 25 m, z: 1 m}, fixed: [y, z]}\n"
            "  running_lines: {left: {nodes: {y: 1.5 m, z: 2 m}}, right: {nodes: {y: 0 m, z: 2 m}}}\n"
            "  track: {kind: ballasted, approach: 26 m, exit: 26 m}\n"
        )
        text = (
            "  kind: simple-span\n  length: 25 m\n  youngs_modulus: 34 GPa\n  second_moment: 0.9 m^4\n"
            "  mass_per_length: 12 t/m\n  elements: 20\n"
            "  damping: {kind: rayleigh, ratio: 1 %, frequencies: [3 Hz, 12 Hz]}\n"
        )
        case = loaded(
            (text, mesh), ("speed: 80 km/h", "speed: 80 km/h\n  start: 22.5 m"), ("steps: 2000", "steps: 1")
        )
        built = build(case)
        result = run_plan(built.plan)
        force = 5750.0 * 9.81

        def beam(a):  # deflection at midspan per unit force at a
            b = min(a, 25.0 - a)
            return b * (3 * 25.0**2 - 4 * b**2) / (48 * 34e9 * 1.5 * 2.0**3 / 12)

        exact = -force * (beam(22.5) + beam(12.5) + beam(2.5))
        assert result.sensor_displacement[0, 0] == pytest.approx(exact, rel=0.04)  # with shear

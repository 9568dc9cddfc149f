"""Wrong inputs: one message with file, line, column, value, rule and fix; exit code 2; nothing written.

What the loader says of each wrong value stands in tests/study/wrong; here is what only shows when the case is
built, and what the command does about it.
"""

import json

import pytest

MASS = "  - vehicle: sprung-mass\n    mass: 5750 kg\n    stiffness: 1595 kN/m\n"


def supports(text):
    return ("elements: 20", f"elements: 20\n  supports: {text}")


def crossing(text):
    return ("speed: 80 km/h", f"speed: 80 km/h\n  {text}")


def analysis(text):
    return ("steps: 50", f"steps: 50\n  {text}")


@pytest.fixture
def refused(axlespan, tmp_path):
    """Run and check a case that is wrong; the one line that both say, without the name of the file."""

    def refuse(path):
        out = tmp_path / "new" / "out"
        answer = axlespan("run", path, "-o", out)
        assert (answer.code, answer.out) == (2, "")
        assert not out.parent.exists()
        assert answer.err.count("\n") == 1 and answer.err.startswith("axlespan: ")
        assert axlespan("check", path) == answer
        return answer.err.removeprefix("axlespan: ").removeprefix(f"{path}").removeprefix(":").rstrip("\n")

    return refuse


@pytest.mark.parametrize(
    ("edits", "said"),
    [
        ([("  length", "  lenght")], "4:3: structure.lenght: unknown key. Did you mean length?"),
        ([("length: 25 m", "length: 25 kg")], "4:11: structure.length = 25 kg: must be a length; 'kg' is a mass. Write 25 m"),
        ([("length: 25 m", "length:")], "4:3: structure.length: is empty. Write length: 25 m"),
        ([("  length: 25 m\n", "")], "2:1: structure.length: is missing. Add length: 25 m"),
        ([("5750 kg", "-5750 kg")], "11:11: train.0.mass = -5750 kg: must be positive. Write 5750 kg"),
        ([("1595 kN/m", "-1595 kN/m")], "12:16: train.0.stiffness = -1595 kN/m: must be positive. Write 1595 kN/m"),
        ([analysis("alpha: -0.5")], "18:10: analysis.alpha = -0.5: must be from -1/3 to 0"),
        ([analysis("alpha: 0.1")], "18:10: analysis.alpha = 0.1: must be from -1/3 to 0"),
        ([analysis("beta: 0.1\n  gamma: 0.5")],
         "18:9: analysis.beta = 0.1: must be at least 0.25 for this alpha and gamma, or the method is only conditionally "
         "stable. Use 0.25 with gamma = 0.5, or leave both out"),
        ([analysis("gamma: 0.4")],
         "18:10: analysis.gamma = 0.4: must be at least 1/2, or the method is unstable. Use 0.5, or leave it out"),
        ([("1 ms", "0 s")], "16:14: analysis.time_step = 0 s: must be positive. Write, for example, 1 ms"),
        ([("1 ms", "200 ms")],
         "16:14: analysis.time_step = 200 ms: is too long: 1.89 steps per shortest period of vehicle 'sprung mass' (0.3773 s); "
         "at least 4 are needed. Use 0.009 s or less"),
        ([("80 km/h", "200 km/s"), (MASS, "  - {vehicle: axle-loads, loads: 100 kN}\n")],
         "14:14: analysis.time_step = 1 ms: is too long: a wheel advances 200 m a step on a line of 25 m. Use 6e-07 s or less"),
        ([("12.5 m", "26 m")], "20:14: output.sensors.midspan = 26 m: must lie on the beam, from 0 to 25 m"),
        ([crossing("start: 30 m")],
         "14:3: crossing = the first wheel runs from 30 to 31.1111 m: never brings a wheel onto the structure, which lies "
         "between 0 and 25 m. Check start, speed, time_step and steps"),
        ([("80 km/h", "0 m/s\n  start: -5 m")],
         "14:3: crossing = the first wheel runs from -5 to -5 m: never brings a wheel onto the structure, which lies "
         "between 0 and 25 m. Check start, speed, time_step and steps"),
        ([crossing("irregularity: {kind: table, points: [[0 m, 0 mm], [2 m, 1 mm], [2 m, 0 mm]]}")],
         "15:67: crossing.irregularity.points.2.0 = 2 m: must increase: the pair before has 2 m"),
        ([crossing("irregularity: {kind: harmonic, amplitude: 1 mm, wavelength: 3 m, from: 9 m, to: 3 m}")],
         "15:83: crossing.irregularity.to = 3 m: must be greater than from. Exchange the two"),
        ([crossing("irregularity: {kind: spectrum, name: german-lo, seed: 1}")],
         "15:40: crossing.irregularity.name = german-lo: no such spectrum. Did you mean german-low?"),
        ([crossing("irregularity: {kind: spectrum, name: german-low, seed: 1, wavelengths: [1 mm, 1 km]}")],
         "15:74: crossing.irregularity.wavelengths = [1 mm, 1 km]: needs a table of 6.4e+08 points, more than 8.4e+06. Use a "
         "narrower band of wavelengths, or fewer components"),
        ([crossing("irregularity: {kind: spectrum, name: german-low, seed: 1, components: 1000000000}")],
         "15:73: crossing.irregularity.components = 1000000000: needs a table of 3.3e+10 points, more than 8.4e+06. Use a "
         "narrower band of wavelengths, or fewer components"),
        ([supports("[{at: 0 m, fixed: [z]}]")],
         "3:3: structure: is a mechanism: it can move freely at n20.z (x = 23.75 m), n19.z (x = 22.5 m), n18.z (x = 21.25 m), "
         "n17.z (x = 20 m). Support these degrees of freedom, or connect the part that they belong to"),
        ([supports("[{at: 0 m, fixed: [z]}, {at: 25 m, fixed: [z]}]"), ("elements: 20", "elements: 20\n  area: 5 m^2")],
         "3:3: structure: has a part that no support holds: it can move freely at n2.x (x = 1.25 m), n3.x (x = 2.5 m), "
         "n4.x (x = 3.75 m), n5.x (x = 5 m). Support these degrees of freedom, or connect the part that they belong to"),
        ([supports("[{at: 0 m, damping: {z: 1 kNs/m}}, {at: 25 m, fixed: [z]}]")],
         "3:3: structure: is a mechanism: it can move freely at n2.z (x = 1.25 m), n3.z (x = 2.5 m), n4.z (x = 3.75 m), "
         "n5.z (x = 5 m). Support these degrees of freedom, or connect the part that they belong to"),
        ([supports("[{at: 0 m, fixed: [z, ry]}, {at: 25 m, fixed: [z, ry]}]"), ("elements: 20", "elements: 1")],
         "3:3: structure = simple span: has no free degree of freedom"),
        ([supports("[{at: 0 m, fixed: [z]}, {at: 25 m, fixed: [x, z]}]")],
         "9:37: structure.supports.1 = right.x: has no x at this node, so it cannot be supported there. No element uses that "
         "degree of freedom: leave it out"),
        ([supports("[{at: 0 m, fixed: [z]}, {at: 12 m, fixed: [z]}, {at: 25 m, fixed: [y, z]}]")],
         "9:61: structure.supports.2 = support3.y: has no y at this node, so it cannot be supported there. No element uses "
         "that degree of freedom: leave it out"),
        ([supports("[{at: 0 m, fixed: [z]}, {at: 1 um, fixed: [ry]}, {at: 25 m, fixed: [z]}]")],
         "9:42: structure.supports.1.at = 1 um: has a support already, supports.0. Put all directions into one of them"),
        ([supports("[{at: 0 m, motion: {z: {kind: harmonic, amplitude: 1 mm, frequency: 2 Hz}}}, {at: 25 m, fixed: [z]}]"),
          ("elements: 20", "elements: 20\n  damping: {kind: modal, ratio: 1 %}")],
         "9:12: structure.damping = modal: acts on the motion relative to supports that stand still, but a support moves. Use "
         "Rayleigh damping"),
        ([supports("[{at: 0 m, motion: {z: {kind: table, points: [[1 s, 0 m], [0 s, 1 mm]]}}}, {at: 25 m, fixed: [z]}]")],
         "9:72: structure.supports.0.motion.z.points.1.0 = 0 s: must increase: the pair before has 1 s"),
        ([("elements: 20", "elements: 9000")],
         "8:13: structure.elements = 9000: makes elements so short that their stiffness drowns in rounding. Use at most 5000 in "
         "a span; 20 to 100 are plenty for most"),
        ([("elements: 20", "elements: 1000000000")], "8:13: structure.elements = 1000000000: must be at most 100000"),
        ([("steps: 50", "steps: 1000000000000")], "17:10: analysis.steps = 1000000000000: must be at most 1000000000"),
        ([("steps: 50", "steps: 200000000")], "17:10: analysis.steps = 200000000: must be at most 100 000 000"),
        ([("steps: 50", "duration: 1e9 s")],
         "17:13: analysis.duration = 1e9 s: takes 1e+12 steps. Use a longer time step"),
        ([("1595 kN/m", "1595 kN/m\n    count: 1000000\n    spacing: 3 m")],
         "13:12: train.0.count = 1000000: must be at most 100000"),
        ([("output:", "output:\n  every: 51")],
         "19:10: output.every = 51: must be at most 50, the number of steps: nothing but the start would be recorded. Write 1"),
        ([("output:", "output:\n  fields: [0.1 s]")],
         "19:12: output.fields.0 = 0.1 s: must be within the time that is simulated, 50 ms"),
        ([("midspan: 12.5 m", '"a\\nb": 1 m')],
         "20:13: output.sensors.a\\nb = 1 m: must be a text in one line; it has the character U+000A"),
        ([("midspan: 12.5 m", '"\\0": 1 m')],
         "20:11: output.sensors.\\x00 = 1 m: must be a text in one line; it has the character U+0000"),
        ([("midspan: 12.5 m", "a: 1 m\n    a: 2 m")],
         "21:5: output.sensors.a: is given twice; the first is in line 20"),
        ([analysis("solver: superLU")], "18:11: analysis.solver = superLU: must be auto, banded, superlu, pardiso or cholmod. "
         "Did you mean superlu?"),
        ([analysis("footprint: 26 m")], "18:14: analysis.footprint = 26 m: must be between 0 and the length of the line, 25 m"),
        ([(MASS, MASS + "    gap: 3 m\n")],
         "13:10: train.0.gap = 3 m: is for later entries: nothing runs ahead of this one. Leave it out; start, of the "
         "crossing, moves the whole train"),
        ([("5750 kg", "5750 kg\n    <<: *coach")],
         "12:9: no anchor &coach stands before this alias. Name what it repeats with &coach"),
    ],
)  # fmt: skip
def test_wrong_values(case, refused, edits, said):
    assert refused(case(*edits)) == said


@pytest.mark.parametrize("word", [".nan", "nan", ".inf", "-.inf", "1e999", "NaN m"])
@pytest.mark.parametrize(
    ("old", "path"),
    [
        ("length: 25 m", "structure.length"),
        ("mass: 5750 kg", "train.0.mass"),
        ("speed: 80 km/h", "crossing.speed"),
        ("time_step: 1 ms", "analysis.time_step"),
        ("midspan: 12.5 m", "output.sensors.midspan"),
    ],
)
def test_numbers_that_are_none(case, refused, old, path, word):
    said = refused(case((old, f"{old.split(':')[0]}: {word}")))
    assert f": {path} = {word}: must be " in said


class TestFiles:
    def test_missing(self, tmp_path, refused, case):
        case()
        assert refused(tmp_path / "csae.yaml") == f" no such file. Did you mean {tmp_path}/case.yaml?"
        assert refused(tmp_path / "no/case.yaml") == f" no such file. There is no folder {tmp_path}/no"

    def test_a_wrong_name_is_told_before_a_folder_that_exists(self, axlespan, tmp_path):
        (tmp_path / "csae").mkdir()
        (tmp_path / "csae" / "result.nc").touch()
        answer = axlespan("run", tmp_path / "csae.yaml")
        assert answer == (2, "", f"axlespan: {tmp_path}/csae.yaml: no such file\n")

    def test_a_folder(self, refused, tmp_path, case):
        case()
        assert (
            refused(tmp_path)
            == f" is a folder, not a case file. Name a file in it, such as {tmp_path}/case.yaml"
        )

    def test_this_folder(self, axlespan, tmp_path, monkeypatch):
        monkeypatch.chdir(tmp_path)
        for word in (".", "", "/"):
            answer = axlespan("run", word)
            assert answer.code == 2
            assert "is a folder, not a case file. Name a case file" in answer.err
        assert list(tmp_path.iterdir()) == []

    @pytest.mark.parametrize(
        ("raw", "said"),
        [
            (b"", " is empty. axlespan examples writes cases to begin with"),
            (b"# nothing\n", " is empty. axlespan examples writes cases to begin with"),
            (b"\x89PNG\r\n\x1a\n\0\0\0", " is not a text file. A case file is YAML, written with a text editor"),
            (b"title: {", "1:9: the text ends here, within brackets or braces. Close them"),
            (b"to whom it may concern,\nplease compute a bridge", "1:1: must be keys and values; this is a single value. "
             "Begin with title: ..., structure: ..., train: ..."),
            (b"- 1\n- 2\n", "1:1: must be keys and values; this is a list. Begin with title: ..., structure: ..., train: ..."),
            ("title: Brücke\n".encode("latin-1"), "1:10: is not UTF-8: byte 0xfc, in Windows-1252 'ü'. Save it as UTF-8"),
            (b"a: &a [*a]\n", "1:4: an alias (*name) stands within its own anchor (&name)"),
            (b"a: " + b"[" * 1500, "1:1: is nested too deeply"),
        ],
    )  # fmt: skip
    def test_no_case(self, refused, tmp_path, raw, said):
        path = tmp_path / "case.yaml"
        path.write_bytes(raw)
        assert refused(path) == said

    def test_too_large(self, refused, tmp_path):
        path = tmp_path / "large.yaml"
        with path.open("wb") as stream:
            stream.truncate(100_000_000)
        assert refused(path).startswith(
            " is larger than 5 MB, the most that a case file may have. Put long tables into"
        )

    @pytest.mark.parametrize(
        ("rows", "said"),
        [
            ("x,r\n0,0\n2,0.001\n1,0\n", "4: x[2] = 1.0: must be larger than x[1] = 2 (positions strictly increase). Sort the "
             "points; for a step, give two points a small distance apart"),
            ("x,r\n0,0\n2,0.001\n2,0\n", "4: x[2] = 2.0: must be larger than x[1] = 2 (positions strictly increase). Sort the "
             "points; for a step, give two points a small distance apart"),
            ("x,r\n0,0\n2,nan\n", "3: r[1] = nan: has a gap: every entry must be a finite number. Fill it, or cut the record in "
             "two there"),
            ("", " file: has no rows"),
        ],
    )  # fmt: skip
    def test_tables(self, axlespan, case, tmp_path, rows, said):
        path = case(crossing("irregularity: {kind: table, file: data/profile.csv}"))
        table = tmp_path / "data" / "profile.csv"
        table.parent.mkdir()
        table.write_text(rows)
        answer = axlespan("run", path, "-o", tmp_path / "out")
        assert answer == (2, "", f"axlespan: {table}:{said}\n")
        assert not (tmp_path / "out").exists()

    def test_a_table_that_is_not_there(self, case, refused, tmp_path):
        said = refused(case(crossing("irregularity: {kind: table, file: profile.csv}")))
        assert said == (
            "15:37: crossing.irregularity.file = profile.csv: no such file. Names are relative to the case file's folder, "
            f"{tmp_path}"
        )


def test_several_slips_are_told_at_once(axlespan, case, tmp_path):
    path = case(("25 m", "-25 m"), ("80 km/h", "80 km"), ("  steps", "  step"))
    answer = axlespan("run", path, "-o", tmp_path / "out")
    assert answer.code == 2
    first, *lines = answer.err.splitlines()
    assert first == "axlespan:"
    assert [line.removeprefix(f"{path}:").split(": ")[:2] for line in lines] == [
        ["4:11", "structure.length = -25 m"],
        ["14:10", "crossing.speed = 80 km"],
        ["17:3", "analysis.step"],
    ]
    assert not (tmp_path / "out").exists()


def test_vehicles_that_cannot_stand(case, refused):
    tilted = """\
  - vehicle: multibody
    bodies: [{name: body, mass: 32 t, inertia: 1.1e6 kg m^2, position: 17 m}]
    wheels: [{position: 0 m}, {position: 14 m}]
    suspensions:
      - {between: [body, wheel1], stiffness: 1.4 MN/m}
      - {between: [body, wheel2], stiffness: 1.4 MN/m}
"""
    said = refused(case((MASS, tilted)))
    lever = -32e3 * 9.81 * 3.0 / 14.0
    assert said == (
        f"10:5: train.0: wheel '1' of vehicle 'multibody vehicle' = '{lever:.6g} N': must press on the line when it stands "
        "still on level ground. Check the masses and the positions of the bodies over the wheels"
    )


def test_a_solver_that_is_not_installed(case, refused, monkeypatch):
    monkeypatch.setattr("axlespan.study.build_checks.available", lambda: ("superlu", "banded"))
    assert refused(case(analysis("solver: pardiso"))) == (
        "18:11: analysis.solver = pardiso: is not installed here. Write auto, superlu, banded, or pip install mkl"
    )


def test_names_that_look_odd_and_are_right(axlespan, case, tmp_path):
    names = ["Brücke-Ω", "中文", "'%s{}'", "a/b", "1.5", "true", "A b", "a b", "$"]
    sensors = "\n    ".join(f"{name}: {n} m" for n, name in enumerate(names, 1))
    path = case(("midspan: 12.5 m", sensors), ("Footbridge", "|\n  a title\n  in two lines"))
    answer = axlespan("run", path, "-o", tmp_path / "out", "--no-figures")
    assert (answer.code, answer.err) == (0, "")
    summary = json.loads((tmp_path / "out/summary.json").read_text(encoding="utf-8"))
    assert list(summary["sensors"]) == [name.strip("'") for name in names]
    assert summary["run"]["title"] == "a title in two lines"
    assert answer.out.startswith("a title in two lines: completed\n")


def test_anchors_and_merges(axlespan, case, tmp_path):
    first = "  - &mass\n    vehicle: sprung-mass\n    mass: 5750 kg\n    stiffness: 1595 kN/m\n"
    path = case(
        (MASS, f"{first}  - {{<<: *mass, gap: 3 m}}\n"),
        ("elements: 20", "elements: &n 20"),
        ("steps: 50", "steps: *n"),
    )
    assert axlespan("run", path, "-o", tmp_path / "out", "--no-figures").code == 0
    run = json.loads((tmp_path / "out/summary.json").read_text(encoding="utf-8"))["run"]
    assert (run["steps"], run["contacts"]) == (20, 2)

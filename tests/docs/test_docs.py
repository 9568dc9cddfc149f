"""The code in the README and in the pages runs, links lead somewhere, and the README's commands do what it says."""

from __future__ import annotations

import json
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from axlespan.cli.app import app
from axlespan.interaction.settings import DAMPED_ALPHA, FOOTPRINT, FOOTPRINT_SHARE
from axlespan.interaction.simulate import simulate

ROOT = Path(__file__).parents[2]
# Pages in docs/made come with a build of the documentation, see test_build.py.
PAGES = [
    ROOT / "README.md",
    *(path for path in sorted((ROOT / "docs").rglob("*.md")) if not {"made", "_build"} & set(path.parts)),
]
# Pages with tests of their own for their code.
TESTED_ELSEWHERE = {"irregularities.md"}
README = (ROOT / "README.md").read_text(encoding="utf-8")
AXLESPAN = Path(sys.executable).with_name("axlespan")


def blocks(page: Path, language: str) -> list[str]:
    text = page.read_text(encoding="utf-8")
    return re.findall(rf"^```{language}\n(.*?)^```", text, flags=re.DOTALL | re.MULTILINE)


def command(line: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run one line of the README, with the command of this environment."""
    words = shlex.split(line, comments=True)
    assert words[0] == "axlespan"
    return subprocess.run(
        [str(AXLESPAN), *words[1:]],
        check=False,
        cwd=folder,
        capture_output=True,
        text=True,
        env=os.environ | {"MPLBACKEND": "Agg"},
    )


WITH_PYTHON = [page for page in PAGES if blocks(page, "python") and page.name not in TESTED_ELSEWHERE]


def test_pages_with_code_are_found():
    names = {page.name for page in WITH_PYTHON}
    assert {"README.md", "direct-method.md", "alpha-method.md", "wheels-with-mass.md", "beams.md"} <= names


@pytest.mark.parametrize("page", WITH_PYTHON, ids=lambda page: page.name)
def test_python_blocks_run(page):
    space: dict[str, object] = {}
    try:
        exec(compile("\n".join(blocks(page, "python")), page.name, "exec"), space)
    finally:
        if "matplotlib.pyplot" in sys.modules:
            sys.modules["matplotlib.pyplot"].close("all")
    if page.name == "README.md":
        result = space["result"]
        assert result.contact_force.shape == (14_001, 50)  # (time, contact)
        assert result.outcome.code == "completed"
        # First mass of example 3.2, by the semi-analytical solution.
        assert 1e3 * result.at("vehicle_displacement", "1.body.z").min() == pytest.approx(-12.84, abs=1e-3)


def test_shell_commands_of_the_readme(tmp_path):
    lines = [line for block in blocks(ROOT / "README.md", "sh") for line in block.splitlines() if line]
    own = [line for line in lines if line.startswith("axlespan")]
    assert [line.split()[0] for line in lines] == ["make", "make", "make", "pip", "axlespan", "axlespan"]
    for line in own:
        done = command(line, tmp_path)
        assert done.returncode == 0, done.stderr
    named = set(re.findall(r"`([\w-]+\.(?:png|nc|json))`", README))
    assert named == {path.name for path in (tmp_path / "out").iterdir()}
    summary = json.loads((tmp_path / "out" / "summary.json").read_text(encoding="utf-8"))
    assert summary["verdict"] == "pass"
    assert 1e3 * summary["sensors"]["midspan"]["displacement_min_m"] == pytest.approx(-2.4069, abs=5e-5)


@pytest.mark.slow
def test_the_tutorial_works_as_written(tmp_path):
    """All its commands, in order, in one folder, with the files that it shows."""
    page = ROOT / "docs" / "tutorial.md"
    (study,) = [block for block in blocks(page, "yaml") if block.startswith("base:")]
    (tmp_path / "study.yaml").write_text(study, encoding="utf-8")
    for line in (line for block in blocks(page, "sh") for line in block.splitlines() if line):
        done = command(line, tmp_path)
        assert done.returncode == 0, f"{line}\n{done.stderr}"
    assert (tmp_path / "bridge" / "report.html").stat().st_size > 10_000
    summary = json.loads((tmp_path / "bridge" / "summary.json").read_text(encoding="utf-8"))
    outcomes = {verdict["outcome"] for verdict in summary["verdicts"]}
    assert outcomes & {"pass", "fail"}
    assert "not assessed" in outcomes  # forces have no car bodies
    # With vehicles in place of forces, by the edit that it describes.
    text = (tmp_path / "bridge.yaml").read_text(encoding="utf-8")
    (tmp_path / "vehicles.yaml").write_text(
        text.replace("vehicle: hslm-a5", "vehicle: ice3"), encoding="utf-8"
    )
    assert command("axlespan check vehicles.yaml", tmp_path).returncode == 0


def test_targets_of_make_exist():
    rules = re.findall(r"^([a-z]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), flags=re.MULTILINE)
    for page in PAGES:
        named = re.findall(
            r"`make ([a-z]+)`|^make ([a-z]+)", page.read_text(encoding="utf-8"), flags=re.MULTILINE
        )
        assert {first or second for first, second in named} <= set(rules), page.name


def test_case_of_the_readme_is_the_example():
    (case,) = blocks(ROOT / "README.md", "yaml")
    shipped = (ROOT / "src" / "axlespan" / "examples" / "neves2012-3.1.yaml").read_text(encoding="utf-8")
    assert case == "".join(line + "\n" for line in shipped.splitlines() if not line.startswith("#"))


def test_message_of_the_readme(tmp_path):
    """A wrong input: the message as printed, exit code 2, nothing written."""
    (case,) = blocks(ROOT / "README.md", "yaml")
    # The README's example has three lines of comments in front, as shipped.
    (tmp_path / "case.yaml").write_text("#\n#\n#\n" + case.replace("5750 kg", "-5750 kg"), encoding="utf-8")
    done = command("axlespan run case.yaml -o out", tmp_path)
    (message,) = re.findall(r"`(case\.yaml:\d+:\d+: [^`]*)`", README)
    assert done.returncode == 2
    assert done.stderr.strip() == f"axlespan: {message}"
    assert not (tmp_path / "out").exists()


def test_all_commands_are_listed():
    listed = re.findall(r"^\| `axlespan ([a-z]+)", README, flags=re.MULTILINE)
    assert sorted(listed) == sorted(
        entry.name or entry.callback.__name__ for entry in app.registered_commands
    )
    done = command("axlespan --help", ROOT)
    assert done.returncode == 0
    for name in listed:
        assert name in done.stdout


def test_the_shell_completes():
    """What ``--install-completion`` installs asks the command itself for what fits."""
    assert "--install-completion" in README
    words = {"_AXLESPAN_COMPLETE": "complete_bash", "COMP_WORDS": "axlespan sw", "COMP_CWORD": "1"}
    done = subprocess.run(
        [str(AXLESPAN)], check=False, capture_output=True, text=True, env=os.environ | words
    )
    assert done.stdout.split() == ["sweep"]


def test_failed_analysis(tmp_path):
    """Exit code 3; what was computed is kept."""
    (case,) = blocks(ROOT / "README.md", "yaml")
    heavy = case.replace(
        "stiffness: 1595 kN/m}", "stiffness: 1595 kN/m, unsprung_mass: 500 kg, count: 2, spacing: 3 m}"
    )
    heavy = heavy.replace("time_step: 1 ms, steps: 900", "time_step: 0.25 ms, steps: 5000, footprint: 0 m")
    (tmp_path / "diverges.yaml").write_text(heavy, encoding="utf-8")
    done = command("axlespan run diverges.yaml -o out --no-figures", tmp_path)
    assert done.returncode == 3
    assert "diverged" in done.stderr
    summary = json.loads((tmp_path / "out" / "summary.json").read_text(encoding="utf-8"))
    assert summary["outcome"]["code"] == "failed"
    assert 0 < summary["run"]["completed_steps"] < 5000


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page):
    for target in re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", page.read_text(encoding="utf-8")):
        if not target.startswith(("http://", "https://", "mailto:")) and "made/" not in target:
            assert (page.parent / target).exists(), target


def test_files_named_in_tables_exist():
    for name in ("docs/theory/direct-method.md", "docs/architecture.md"):
        text = (ROOT / name).read_text(encoding="utf-8")
        for path in re.findall(r"`((?:\w+/)+\w+\.py)`", text):
            assert (ROOT / "src" / "axlespan" / path).exists() or (ROOT / path).exists(), path


def test_rooms_are_those_of_the_linter():
    """The table of docs/architecture.md against the layers in pyproject.toml."""
    config = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    (text,) = re.findall(r"^layers = \[(.*?)^\]", config, flags=re.DOTALL | re.MULTILINE)
    layers = [re.findall(r"\w+", line) for line in re.findall(r'"([^"]+)"', text)]
    there = {path.stem for path in (ROOT / "src" / "axlespan").iterdir()}
    wanted = [[room for room in layer if room in there] for layer in layers]
    wanted = [layer for layer in wanted if layer]
    page = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (\d+) \| `(\w+)` \|", page, flags=re.MULTILINE)
    lines = sorted({int(number) for number, _ in rows}, reverse=True)
    assert [sorted(room for number, room in rows if int(number) == line) for line in lines] == [
        sorted(layer) for layer in wanted
    ]


def test_defaults_are_those_of_the_code():
    page = (ROOT / "docs" / "theory" / "wheels-with-mass.md").read_text(encoding="utf-8")
    assert f"footprint of {FOOTPRINT:g} m or {100.0 * FOOTPRINT_SHARE:g} % of the line" in page
    assert DAMPED_ALPHA == -0.1
    assert r"$\alpha = -0.1$ unless `alpha` is given" in page
    decisions = (ROOT / "docs" / "decisions.md").read_text(encoding="utf-8")
    assert f"min({FOOTPRINT:g} m, {100.0 * FOOTPRINT_SHARE:g} % of the line)" in decisions
    assert f"{FOOTPRINT:g} m or {100.0 * FOOTPRINT_SHARE:g} % of the line" in str(simulate.__doc__)


@pytest.mark.parametrize(
    "page", [page for page in PAGES if page.parent.name == "theory"], ids=lambda page: page.name
)
def test_equation_numbers_are_unique_and_defined(page):
    text = page.read_text(encoding="utf-8")
    tags = re.findall(r"\\tag\{([^}]*)\}", text)
    assert len(set(tags)) == len(tags)
    letters = {match[0] for tag in tags if (match := re.match(r"[A-Z](?=\d)", tag))}
    if len(letters) != 1 or page.name not in {
        "direct-method.md",
        "alpha-method.md",
        "wheels-with-mass.md",
        "beams.md",
    }:
        return
    (letter,) = letters
    cited = set(re.findall(rf"\(({letter}\d+)\)", text))
    assert cited <= set(tags), cited - set(tags)

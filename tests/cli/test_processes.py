"""``axlespan`` as a process: full disks, closed streams, signals, terminals, pipes."""

import os
import pty
import re
import select
import shutil
import signal
import subprocess
import sys
import time

import pytest

linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="needs /dev/full")

LIMITED = ("bash", "-c", 'ulimit -f "$0"; exec "$@"')  # blocks of 1024 byte that a file may have


@pytest.mark.skipif(shutil.which("bash") is None, reason="needs a shell with ulimit")
class TestFullDisks:
    def test_nothing_half_is_left(self, axlespan_process, case, tmp_path):
        path = case(("steps: 50", "steps: 1000"))
        answer = axlespan_process("run", path, "-o", tmp_path / "a/out", prefix=(*LIMITED, "50"))
        assert (answer.code, answer.out) == (3, "")
        assert answer.err == f"axlespan: {tmp_path}/a/out: the results cannot be written: File too large\n"
        assert not (tmp_path / "a").exists()

    def test_old_results_stay(self, axlespan, axlespan_process, case, tmp_path):
        out = tmp_path / "out"
        assert axlespan("run", case(), "-o", out, "--no-figures").code == 0
        before = {p.name: p.read_bytes() for p in out.iterdir()}
        path = case(("steps: 50", "steps: 1000"))
        answer = axlespan_process("run", path, "-o", out, "--force", prefix=(*LIMITED, "50"))
        assert answer.code == 3
        assert {p.name: p.read_bytes() for p in out.iterdir()} == before

    def test_fields_too(self, axlespan_process, case, tmp_path):
        path = case(("output:", "output:\n  fields: {every: 1}"), ("elements: 20", "elements: 100"))
        answer = axlespan_process(
            "run", path, "-o", tmp_path / "out", "--no-figures", prefix=(*LIMITED, "60")
        )
        assert (answer.code, answer.err.endswith("the results cannot be written: File too large\n")) == (
            3,
            True,
        )
        assert not (tmp_path / "out").exists()


@linux
def test_an_answer_that_cannot_be_printed(axlespan_process, case, tmp_path):
    with open("/dev/full", "wb") as full:
        answer = axlespan_process("run", case(), "-o", tmp_path / "out", "--no-figures", stdout=full)
    assert answer.code == 3
    assert answer.err == "axlespan: the answer cannot be written: No space left on device\n"
    assert {p.name for p in (tmp_path / "out").iterdir()} == {"result.nc", "summary.json"}


def test_streams_that_are_closed_or_poor(axlespan_process, case, tmp_path):
    """A terminal without the character ×, and no error stream at all."""
    path = case(("stiffness: 1595 kN/m", "stiffness: 1595 kN/m\n    count: 2\n    spacing: 3 m"))
    poor = {"PYTHONIOENCODING": "ascii", "LC_ALL": "C"}
    closed = ("bash", "-c", 'exec "$@" 2>&-', "x")
    answer = axlespan_process("run", path, "-o", tmp_path / "a", "--no-figures", env=poor, prefix=closed)
    assert answer.code == 0
    assert "  train        2 ? sprung mass, 2 wheels" in answer.out


class TestInterrupted:
    """A run of half a minute, stopped."""

    LONG = (("steps: 50", "steps: 800000"), ("sensors:", "every: 100\n  sensors:"))

    @pytest.mark.parametrize(
        ("number", "code", "words"),
        [
            (
                signal.SIGINT,
                130,
                r"axlespan: interrupted( after \d+ of 800000 steps)?; nothing was written\n",
            ),
            (signal.SIGTERM, 143, ""),
        ],
    )
    def test_nothing_is_left(self, axlespan_started, case, tmp_path, number, code, words):
        running = axlespan_started("run", case(*self.LONG), "-o", tmp_path / "a" / "out")
        for _ in range(300):  # until it has claimed its folder
            if list(tmp_path.glob("a/out/.axlespan-*")):
                break
            time.sleep(0.1)
        time.sleep(0.3)
        running.send_signal(number)
        out, err = running.communicate(timeout=30)
        assert (running.returncode, out) == (code, b"")
        assert re.fullmatch(words, err.decode())
        assert {p.name for p in tmp_path.iterdir()} == {"case.yaml"}

    @pytest.mark.parametrize("during", ["write_result", "write_summary", "publish"])
    def test_while_results_are_written(self, axlespan, case, tmp_path, monkeypatch, during):
        def interrupted(*arguments, **options):
            raise KeyboardInterrupt

        out = tmp_path / "out"
        assert axlespan("run", case(), "-o", out, "--no-figures").code == 0
        before = {p.name: p.read_bytes() for p in out.iterdir()}
        monkeypatch.setattr(f"axlespan.cli.run.{during}", interrupted)
        answer = axlespan("run", case(), "-o", out, "--force", "--no-figures")
        assert answer == (
            130,
            "",
            "axlespan: interrupted while the results were written; they are not kept\n",
        )
        assert {p.name: p.read_bytes() for p in out.iterdir()} == before


def on_a_terminal(command, columns=100, limit=60.0):
    """Run a command on a terminal of its own: exit code and what it showed, without colors."""
    pid, terminal = pty.fork()
    if pid == 0:
        os.environ.update(TERM="xterm-256color", COLUMNS=str(columns), MPLBACKEND="Agg")
        os.execv(command[0], command)
    shown, end = b"", time.monotonic() + limit
    while time.monotonic() < end:
        if select.select([terminal], [], [], 0.1)[0]:
            try:
                more = os.read(terminal, 1 << 16)
            except OSError:  # how Linux says that the other side is closed
                break
            if not more:
                break
            shown += more
    _, status = os.waitpid(pid, 0)
    os.close(terminal)
    return os.waitstatus_to_exitcode(status), re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", shown.decode("utf-8"))


class TestProgress:
    def test_a_bar_on_a_terminal(self, command, case, tmp_path):
        """With steps, rate and time left; a title is no markup."""
        path = case(("Footbridge", "'[red] {task} bridge [/nope]'"), ("steps: 50", "steps: 30000"))
        code, shown = on_a_terminal([command, "run", str(path), "-o", str(tmp_path / "out"), "--no-figures"])
        assert code == 0
        frames = [frame for frame in re.split(r"[\r\n]+", shown) if "/30000 steps" in frame]
        assert frames[0].startswith("[red] {task} bridge [/nope] ━")
        assert " 0/30000 steps " in frames[0]
        assert any(re.search(r" \d+/30000 steps [\d,]+/s \d:\d\d:\d\d left", frame) for frame in frames)
        assert "[red] {task} bridge [/nope]: completed" in shown

    def test_nothing_elsewhere(self, axlespan_process, case, tmp_path):
        answer = axlespan_process("run", case(), "-o", tmp_path / "out", "--no-figures")
        assert (answer.code, answer.err) == (0, "")
        assert "steps/s" in answer.out and "━" not in answer.out


def test_a_reader_that_stops_reading(axlespan_started, case, tmp_path):
    running = axlespan_started("run", case(), "-o", tmp_path / "out", "--no-figures")
    head = subprocess.run(["head", "-1"], stdin=running.stdout, capture_output=True, check=True)
    running.stdout.close()
    assert running.wait(30) in (0, 1)
    assert (head.stdout, running.stderr.read()) == (b"Footbridge: completed\n", b"")
    running.stderr.close()
    assert {p.name for p in (tmp_path / "out").iterdir()} == {"result.nc", "summary.json"}

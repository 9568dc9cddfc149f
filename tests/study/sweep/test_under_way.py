"""Progress within a batch, here and on Dask, and how the command shows it; processes: test_executors."""

from types import SimpleNamespace

import pytest
from tests.study.sweep.conftest import STUDY

from axlespan.cli import sweep as command
from axlespan.study.sweep import Study, on_dask, under_way, workshop
from axlespan.study.sweep.under_way import Meter

# Long enough for a stretch of 256 steps to end before the run does.
LONG = STUDY.replace("time_step: 4 ms", "time_step: 0.1 ms").replace("step: 40", "step: 200")


def plans(*steps):
    return [SimpleNamespace(settings=SimpleNamespace(steps=n)) for n in steps]


def test_a_meter_counts_scenarios_worth_of_steps():
    told = []
    meter = Meter(told.append, pause=0.0)
    look = meter.of(plans(100, 200, 400))
    for step in (50, 100, 100, 200, 400):
        look(step)
    # 50: 1/2 + 1/4 + 1/8; 100: 1 + 1/2 + 1/4; 200: 1 + 1 + 1/2; the same is not told twice
    assert told == pytest.approx([0.875, 1.75, 2.5, 3.0])
    meter.add(3)
    look = meter.of(plans(10, 10))
    for step in (5, 10, 2, 10):  # the second one begins anew, as what is tried alone
        look(step)
    assert told[4:] == pytest.approx([4.0, 5.0])


def test_a_meter_does_not_tell_all_the_time(monkeypatch):
    now, told = [0.0], []
    monkeypatch.setattr(under_way.time, "monotonic", lambda: now[0])
    look = Meter(told.append, pause=1.0).of(plans(10))
    for step in range(1, 11):
        now[0] += 0.4
        look(step)
    assert told == pytest.approx([0.1, 0.4, 0.7, 1.0])


@pytest.fixture
def often(monkeypatch):
    monkeypatch.setattr(workshop, "Meter", lambda tell: Meter(tell, pause=0.0))


def ran(study, folder, **options):
    """What a run tells: (done, share) in the order in which it comes."""
    seen, done = [], [0]

    def progress(number, failed, total):
        done[0] = number
        seen.append((number, 0.0))

    study.run(folder, progress=progress, under_way=lambda share: seen.append((done[0], share)), **options)
    return seen


def test_a_batch_tells_how_far_it_is_here(study_file, tmp_path, often):
    study = Study.load(study_file(LONG))
    seen = ran(study, tmp_path / "out")
    assert seen[0] == (0, 0.0) and seen[-1] == (8, 0.0)
    within = [share for done, share in seen if done == 0]
    assert len(within) > 5 and max(within) <= 8.0 + 1e-9
    rising = within[: within.index(max(within)) + 1]
    assert rising == sorted(rising)
    assert any(0.5 < share < 7.5 for share in within)


def test_dask_tells_how_far_tasks_are():
    pytest.importorskip("distributed")
    told = []
    client = SimpleNamespace(
        subscribe_topic=lambda topic, hear: told.append(hear), loop=None, scheduler_info=lambda **_: None
    )
    executor = on_dask.OnDask(client, 1)
    executor._listen()
    (hear,) = told
    hear((1.0, [3, 2.5]))
    hear((2.0, "nonsense"))  # somebody else's
    hear((3.0, (4, 0.5)))
    seen = []
    executor._tell(
        lambda number, share: seen.append((number, share)), [SimpleNamespace(number=n) for n in (2, 3)]
    )
    assert seen == [(3, 2.5)]  # of tasks that are on their way


def test_a_worker_of_dask_tells_through_the_scheduler_now_and_then(monkeypatch):
    sent = []
    worker = SimpleNamespace(log_event=lambda topic, message: sent.append((topic, message)))
    monkeypatch.setattr(on_dask, "_engine", lambda: SimpleNamespace(get_worker=lambda: worker))
    now = [0.0]
    monkeypatch.setattr(on_dask.time, "monotonic", lambda: now[0])

    def run_task(task, tell=None):
        for share in (0.5, 1.0, 1.5, 2.0):
            now[0] += 0.6
            tell(share)
        return "done"

    monkeypatch.setattr(on_dask, "run_task", run_task)
    assert on_dask._run_on_worker(SimpleNamespace(number=7), "news") == "done"
    assert sent == [("news", [7, 1.0]), ("news", [7, 2.0])]


def test_lines_of_progress_count_what_is_under_way(monkeypatch, capsys):
    now = [0.0]
    monkeypatch.setattr(command.time, "monotonic", lambda: now[0])
    counter = command._Counter(64)
    counter.shown = command._Lines(64)
    counter(0, 0, 64)
    now[0] = 100.0
    counter.under_way(10.0)
    assert capsys.readouterr().err == "axlespan: 0 of 64 done, 0 failed, 0.1 a second, about 9 min left\n"
    now[0] = 200.0
    counter.under_way(2.0)  # a batch is done, and will be counted
    assert capsys.readouterr().err == ""
    counter(32, 1, 64)
    assert capsys.readouterr().err == "axlespan: 32 of 64 done, 1 failed, 0.17 a second, about 2.9 min left\n"

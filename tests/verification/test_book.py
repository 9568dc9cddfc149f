"""The book itself: rows, choosing and running cases, its text, its Markdown and the command."""

import math

import numpy as np
import pytest

from axlespan.cli import verify
from axlespan.errors import InputError
from axlespan.verification import book, table
from axlespan.verification.case import case, history, value


def fake(name, rows, *, long=False):
    return case(name, f"Title of {name}", "a book", long=long)(rows)


def good():
    """One row that holds."""
    return [value("depth", "mm", -2.0, -2.001, 1e-3, "by hand")]


def bad():
    """One row that holds and one that does not."""
    return [*good(), value("length | width", "m", 5.0, 5.1, 0.01, "by hand")]


def broken():
    """Breaks."""
    raise InputError("must be positive", field="mass", value=-1.0)


GOOD, BAD, BROKEN = fake("good-case", good), fake("bad-case", bad), fake("broken-case", broken)
LONG = fake("long-case", good, long=True)


def test_a_row_compares_relative_to_its_scale():
    row = value("depth", "mm", -2.0, -2.003, 1e-3, "by hand")
    assert (row.error, row.of, row.verdict) == (pytest.approx(1.5e-3), "value", "FAIL")
    row = value("depth", "mm", -2.0, -2.003, 1e-3, "by hand", scale=10.0, of="span")
    assert (row.error, row.of, row.verdict) == (pytest.approx(3e-4), "span", "ok")


@pytest.mark.parametrize("obtained", [math.nan, math.inf])
def test_what_is_not_a_number_fails(obtained):
    assert value("depth", "mm", -2.0, obtained, 1e9, "by hand").verdict == "FAIL"
    curve = np.array([0.0, obtained, 1.0])
    assert history("depth", "mm", [0, 1, 2], [0.0, 0.5, 1.0], curve, 1e9, "by hand").verdict == "FAIL"


def test_a_history_shows_where_it_is_farthest_off():
    row = history("depth", "mm", [0.0, 1.0, 2.0], [0.0, -4.0, 2.0], [0.0, -4.1, 2.3], 0.05, "by hand")
    assert (row.expected, row.obtained, row.scale) == (2.0, 2.3, 4.0)
    assert row.error == pytest.approx(0.075)
    with pytest.raises(ValueError, match="cannot be compared"):
        history("depth", "mm", [0.0, 1.0], [0.0, 1.0], [0.0], 0.1, "by hand")


def test_names_are_unique_and_columns_hold_their_text():
    names = [item.name for item in book.CASES]
    assert len(set(names)) == len(names) >= 20
    assert all(name == name.lower() and " " not in name for name in names)
    assert all(item.title and item.source and item.description for item in book.CASES)
    assert [item.name for item in book.CASES if item.long] == ["couplings-train", "neves-3.2-solid"]


def test_long_cases_run_on_request_only():
    cases = [GOOD, LONG, BAD]
    assert book.select(cases=cases) == [GOOD, BAD]
    assert book.select(full=True, cases=cases) == cases
    assert book.select("BAD", cases=cases) == [BAD]
    assert book.select("case", cases=cases) == [GOOD, BAD]
    assert book.select("case", full=True, cases=cases) == cases
    assert book.select("long", cases=cases) == [LONG]  # named, and nothing shorter beside it


@pytest.mark.parametrize(("only", "fix"), [
    ("movingmass", "Did you mean 'moving-mass', "),
    ("beem", "Did you mean 'beam-order', 'beam-frequencies'"),
    ("settlements", "Did you mean 'settlement'?"),
    ("zzz", "Known: neves-3.1, neves-3.2, "),
])  # fmt: skip
def test_an_unknown_name_is_told_the_nearest(only, fix):
    with pytest.raises(InputError, match="is part of no case's name") as caught:
        book.select(only)
    assert fix in str(caught.value)


def test_a_case_that_breaks_does_not_stop_the_book():
    reports = list(book.run([BROKEN, GOOD, fake("empty-case", list)]))
    assert [report.ok for report in reports] == [False, True, False]
    assert reports[0].failure == "InputError: mass = -1.0: must be positive"
    assert reports[2].failure == "it gave no rows"


def test_the_table_has_one_line_per_row_and_the_time_in_the_first():
    report = book.Report(BAD, tuple(bad()), 1.234)
    first, second = table.lines_of(report)
    assert first.split() == ["bad-case", "depth", "mm", "-2", "-2.001", "5.0e-04", "value", "1.0e-03", "ok",
                             "1.23", "s"]  # fmt: skip
    assert second.endswith("2.0e-02  value    1.0e-02  FAIL               expected from: by hand")
    columns = table.heading()
    assert first.index("5.0e-04") + 7 == columns.index("error") + 5  # right-aligned under the heading
    assert table.total([report]) == "2 rows in 1 cases, 1 off, 1.2 s: FAIL in bad-case"
    assert table.total([book.Report(GOOD, tuple(good()), 0.5)]) == "1 rows in 1 cases, 0 off, 0.5 s: ok"
    (line,) = table.lines_of(book.Report(BROKEN, (), 0.1, "ValueError: no"))
    assert line.split()[0] == "broken-case" and line.endswith("FAIL       0.10 s  ValueError: no")


def test_markdown_has_a_section_and_a_table_for_each_case():
    text = book.as_markdown(book.run([BAD, BROKEN]))
    assert text.startswith(
        "## Title of bad-case\n\n`bad-case`. Source: a book.\n\nOne row that holds and one"
    )
    assert "| depth | mm | -2 | -2.001 | 5.0e-04 | value | 1.0e-03 | ok | by hand |" in text
    assert "| length \\| width | m | 5 | 5.1 | 2.0e-02 | value | 1.0e-02 | **FAIL** | by hand |" in text
    assert "**FAIL**: InputError: mass = -1.0: must be positive" in text
    assert " s |" not in text  # no times


@pytest.mark.parametrize(("cases", "code"), [
    ([GOOD], 0),
    ([GOOD, BAD], 3),
    ([BROKEN], 3),
])  # fmt: skip
def test_the_command_says_by_its_exit_code_whether_all_holds(cases, code, monkeypatch, capsys):
    monkeypatch.setattr(verify, "select", lambda only, *, full: cases)
    assert verify.run_book(full=True, only=None) == code
    lines = capsys.readouterr().out.splitlines()
    rows = 1 + sum(len(report.rows) or 1 for report in book.run(cases))
    assert lines[0].split()[:3] == ["case", "quantity", "unit"]
    assert lines[rows].startswith(f"{sum(1 if c is GOOD else 2 if c is BAD else 0 for c in cases)} rows in")
    assert ("FAIL" in "".join(lines)) == (code == 3)


def test_the_command_names_what_it_leaves_out_and_what_it_does_not_know(monkeypatch, capsys):
    monkeypatch.setattr(verify, "run", lambda cases: book.run([GOOD]))
    assert verify.run_book(full=False, only=None) == 0
    last = capsys.readouterr().out.splitlines()[-1]
    assert (
        last == "Left out, because they take longer: couplings-train, neves-3.2-solid. Run them with --full."
    )
    assert verify.run_book(full=False, only="timosenko") == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "Did you mean 'timoshenko-frequencies'?" in captured.err


def test_the_command_runs_one_case_of_the_book(capsys):
    assert verify.run_book(full=False, only="beam-freq") == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 14  # heading, 12 frequencies, total
    assert all(line.isascii() for line in lines)
    assert lines[1].startswith("beam-frequencies        pinned-pinned, mode 1")
    assert lines[-1].startswith("12 rows in 1 cases, 0 off, ") and lines[-1].endswith(": ok")

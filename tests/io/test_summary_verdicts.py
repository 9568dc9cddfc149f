"""Verdicts as lines of text."""

from axlespan.io.summary_verdicts import assessed, verdict_lines
from axlespan.standards.verdict import FROM_MEMORY, judged, not_assessed


def row(value, limit, check="deck_acceleration", unit="m/s^2", **more):
    return judged(check, "A2.4.4.2.1", "a", value, limit, unit, **more).as_dict()


def test_fails_come_first_then_utilization():
    rows = [
        row(1.0, 4.0, where="20 m", when=1.25),
        not_assessed("twist", "c", "twist", "one rail").as_dict(),
        row(3.0e-3, 2.0e-3, check="end_offset", unit="m", source=f"EN; {FROM_MEMORY}"),
        row(2.0, None, check="sperling", unit="", note="excellent"),
        row(3.0, 4.0, check="body_acceleration"),
    ]
    lines = verdict_lines({"verdicts": rows})
    assert lines[0] == "Rules: FAIL (1 of 3 fail, 1 not assessed)"
    heads = [
        line for line in lines[1:] if (line[2] != " " and "%" in line) or " -  " in line or "assessed" in line
    ]
    assert [line.split()[0] for line in heads] == ["FAIL", "pass", "pass", "reported", "not"]
    assert heads[0].split()[1:] == [
        "150",
        "%",
        "end",
        "offset*",
        "3",
        "mm,",
        "limit",
        "2",
        "mm",
        "A2.4.4.2.1",
    ]
    assert "at 20 m, 1.25 s" in "\n".join(lines)
    assert lines[-1].startswith("  * numbers of the standard from memory")


def test_nothing_to_say():
    assert verdict_lines({"verdicts": []}) == verdict_lines({}) == []
    assert assessed([]) is None


def test_only_what_is_missing():
    lines = verdict_lines({"verdicts": [not_assessed("twist", "c", "twist", "one rail").as_dict()]})
    assert lines == ["Rules: not assessed", "  not assessed          twist                one rail"]


def test_a_limit_from_below_and_huge_utilization():
    lines = verdict_lines({"verdicts": [row(900.0, 600.0, unit="", at_least=True), row(1e9, 1.0)]})
    assert "> 100" in lines[1] and "67 %" in lines[2] and "at least 600" in lines[2]


def test_a_limit_that_is_hardly_missed_is_not_shown_as_reached():
    lines = verdict_lines({"verdicts": [row(3.505, 3.5), row(3.5, 3.5)]})
    assert lines[1].split()[:3] == ["FAIL", ">", "100"]
    assert next(line for line in lines if "pass" in line and "%" in line).split()[:3] == ["pass", "100", "%"]

"""What is said about wrong case files: whole messages, with place, field, value, rule and fix.

The files in ``wrong/`` hold what to change in a right case (``---`` a piece of it, ``+++`` what takes its place;
both may go on for several lines) and all that is said then (``>>>``, one line for each error).
"""

import re
from pathlib import Path

import pytest

PIECE = re.compile(r"^(===|---|\+\+\+|>>>) ?(.*?)(?=^(?:===|---|\+\+\+|>>>)(?: |$)|\Z)", re.M | re.S)


def wrong_cases():
    for file in sorted((Path(__file__).parent / "wrong").glob("*.txt")):
        name, old, edits, said = "", "", [], []
        for mark, text in [*PIECE.findall(file.read_text(encoding="utf-8")), ("===", "")]:
            text = text.removesuffix("\n")
            if mark == "===":
                if said:
                    yield pytest.param(edits, "\n".join(said), id=f"{file.stem}: {name}")
                name, edits, said = text, [], []
            elif mark == "---":
                old = text
            elif mark == "+++":
                edits.append((old, text))
            else:
                said.append(text.rstrip("\n"))


@pytest.mark.parametrize(("edits", "expected"), list(wrong_cases()))
def test_message(complaint, blocks, edits, expected):
    assert complaint(*((blocks.get(old, old), new) for old, new in edits)) == expected


def test_the_gallery_is_read_as_a_whole():
    cases = list(wrong_cases())
    assert len(cases) > 200
    assert len({case.id for case in cases}) == len(cases)

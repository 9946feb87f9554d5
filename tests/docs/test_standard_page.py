"""docs/evidence/iec-62443-4-2.md answers each requirement, and each test that it names exists."""

import re
from collections import Counter
from collections.abc import Iterator

import pytest

from tests.docs.pages import ROOT, between_markers

PAGE = ROOT / "docs" / "evidence" / "iec-62443-4-2.md"
ROW = re.compile(r"^\| ((?:CCSC|CR|SAR) [\d.]+[^|]*) \| ([^|]+) \| ([^|]+) \| ([^|]+) \|$", re.MULTILINE)
TEST = re.compile(r"`(tests/[\w/]+\.py)(?:::(\w+))?`")
ANSWERS = ("met", "partly", "not", "does not apply")
LAST_OF: dict[int, int] = {1: 14, 2: 13, 3: 14, 4: 3, 5: 4, 6: 2, 7: 8}
"""The last requirement of each group."""


def _rows() -> Iterator[tuple[str, str, str, str]]:
    for found in ROW.finditer(PAGE.read_text(encoding="utf-8")):
        name, answer, what, shown = (part.strip() for part in found.groups())
        yield name, answer, what, shown


def _counted(answers: Counter[str]) -> list[str]:
    return ["| Answer | Requirements |", "|---|---|", *(f"| {one} | {answers[one]} |" for one in ANSWERS)]


def test_every_requirement_has_an_answer() -> None:
    text = PAGE.read_text(encoding="utf-8")
    told = {(int(one), int(two)) for one, two in re.findall(r"\b(?:CR|SAR) (\d)\.(\d+)", text)}
    for group, first, last in ((3, 10, 14), (5, 2, 4)):
        told |= {(group, number) for number in range(first, last + 1)}
    assert told == {(group, number) for group, last in LAST_OF.items() for number in range(1, last + 1)}


def test_every_answer_is_one_of_four_and_what_is_met_is_shown() -> None:
    rows = list(_rows())
    assert len(rows) > 45
    for name, answer, what, shown in rows:
        assert answer in ANSWERS, name
        assert what, name
        if answer == "met":
            assert shown != "-" or name.startswith(("CCSC 2", "SAR 3.2")), f"{name}: which test shows it?"


def test_the_counts_are_those_of_the_tables() -> None:
    text = PAGE.read_text(encoding="utf-8")
    counted = _counted(Counter(answer for _, answer, _, _ in _rows()))
    assert between_markers(text, "counts", iter(counted)) == text, "\n".join(counted)


@pytest.mark.parametrize("name", sorted({name for name, *_ in _rows()}))
def test_the_tests_that_show_it_exist(name: str) -> None:
    shown = next(row[3] for row in _rows() if row[0] == name)
    for path, function in TEST.findall(shown):
        content = (ROOT / path).read_text(encoding="utf-8")
        assert "def test_" in content, path
        if function:
            assert re.search(rf"\bdef {function}\(", content), f"{path}::{function}"

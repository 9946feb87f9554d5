"""The page on the condition of a motor has every state, kind, event and key."""

from collections.abc import Iterable

import pytest

from core.condition.assessment import Assessment, Level, Reference
from core.condition.events import EventKind
from core.condition.kinds import Kind, State
from core.condition.verdict.judging import condition_of
from core.motor_condition.condition import LikelyCause, motor_condition
from core.motor_condition.parts import Part, PartCondition
from testing.machines.motors import REFERENCE
from tests.docs.pages import ROOT

PAGE = (ROOT / "docs" / "reference" / "condition.md").read_text(encoding="utf-8")


def rows() -> set[str]:
    """Words in the first columns of the page's tables."""
    first = (line.split("|")[1] for line in PAGE.splitlines() if line.startswith("| `"))
    return {word.strip(" `,") for cell in first for word in cell.split("`, `")}


@pytest.mark.parametrize("words", [State, Kind, EventKind, Part], ids=lambda words: words.__name__)
def test_every_word_has_a_row(words: Iterable[str]) -> None:
    assert {str(word) for word in words} - rows() == set()


def test_every_key_of_the_document_has_a_row() -> None:
    reference = Reference(
        records=1,
        complete=False,
        since_ns=0,
        detectable=None,
        standing=Level(0.0, 0.01, 0),
        standing_score=0.0,
        from_bus=False,
    )
    assessment = Assessment(
        as_of_ns=0, reference=reference, change=None, standing_fault=False, statistic=0.0, threshold=16.0
    )
    document = motor_condition(condition_of(REFERENCE, assessment, 0), ()).as_dict()
    learnt, ahead = document["reference"], document["forecast"]
    assert isinstance(learnt, dict)
    assert isinstance(ahead, dict)
    assert {*document, *learnt} - rows() == set()
    part = PartCondition(Part.STATOR, State.HEALTHY, "no shorted turns").as_dict()
    cause = LikelyCause(("healthy",), "healthy", 1.0).as_dict()
    assert [key for key in {**ahead, **part, **cause} if f"`{key}`" not in PAGE] == []

"""The glossary has the words that the product shows."""

import re
from enum import StrEnum

import pytest

from core.condition.events import EventKind
from core.condition.kinds import Kind, State
from core.diagnosis.verdict import Verdict
from core.motor_condition.condition import Urgency
from core.motor_condition.parts import Part
from service.storage.states import (
    AlarmEvent,
    AlarmKind,
    AlarmPriority,
    AlarmState,
    ClockQuality,
    JobState,
    LinkState,
    RecordingRequestOrigin,
    RecordingRequestState,
    RecordingSource,
    RecordingState,
)
from tests.docs.pages import ROOT

PAGE = (ROOT / "docs" / "reference" / "glossary.md").read_text(encoding="utf-8")
SHOWN = [
    Verdict,
    State,
    Kind,
    Part,
    Urgency,
    EventKind,
    AlarmKind,
    AlarmState,
    AlarmPriority,
    AlarmEvent,
    ClockQuality,
    JobState,
    LinkState,
    RecordingRequestOrigin,
    RecordingRequestState,
    RecordingSource,
    RecordingState,
]


@pytest.mark.parametrize("words", SHOWN)
def test_every_word_that_an_answer_shows_is_explained(words: type[StrEnum]) -> None:
    assert [word for word in words if f"`{word}`" not in PAGE] == []


def test_every_term_stands_once() -> None:
    terms = re.findall(r"^- \*\*(.+?)\*\*", PAGE, re.MULTILINE)
    assert len(terms) > 90
    assert len({term.lower() for term in terms}) == len(terms)

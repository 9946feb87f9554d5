"""Why a condition is milder than the verdict of the latest record."""

import pytest

from core.condition.kinds import State
from core.condition.verdict.latest_record import why_milder
from core.diagnosis.verdict import Verdict


@pytest.mark.parametrize(
    ("state", "verdict", "words"),
    [
        (State.HEALTHY, Verdict.FAULT, "no more than such errors leave"),
        (State.HEALTHY, Verdict.WATCH, "says watch, 3.20% in phase b: one record cannot tell"),
        (State.WATCH, Verdict.FAULT, "sure of no more than watch"),
    ],
)
def test_a_milder_condition_says_why(state: State, verdict: Verdict, words: str) -> None:
    reason = why_milder(state, verdict, 0.032, "b", is_later=False)
    assert reason is not None
    assert words in reason


@pytest.mark.parametrize(
    ("state", "verdict"),
    [
        (State.FAULT, Verdict.FAULT),
        (State.WATCH, Verdict.HEALTHY),
        (State.UNKNOWN, Verdict.FAULT),
        (State.HEALTHY, Verdict.UNDIAGNOSABLE),
    ],
)
def test_a_condition_that_is_not_milder_needs_no_reason(state: State, verdict: Verdict) -> None:
    assert why_milder(state, verdict, None, None, is_later=False) is None


def test_a_record_that_is_not_in_the_condition_is_told_as_that() -> None:
    reason = why_milder(State.HEALTHY, Verdict.FAULT, None, None, is_later=True)
    assert reason == (
        "the latest record by itself says fault; it is not in the condition: it is yet to be taken into "
        "account, or was left out"
    )

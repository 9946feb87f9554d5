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
    reason = why_milder(state, verdict, 0.032, "b", is_later=False, is_complete=True, is_accepted=False)
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
    assert why_milder(state, verdict, None, None, is_later=False, is_complete=True, is_accepted=False) is None


def test_a_record_that_is_not_in_the_condition_is_told_as_that() -> None:
    reason = why_milder(
        State.HEALTHY, Verdict.FAULT, None, None, is_later=True, is_complete=True, is_accepted=False
    )
    assert reason == (
        "the latest record by itself says fault; it is not in the condition: it is yet to be taken into "
        "account, or was left out"
    )


@pytest.mark.parametrize(
    ("is_complete", "is_accepted", "words"),
    [
        (False, False, "too few yet to judge them together"),
        (True, True, "a person has declared healthy what the motor showed"),
        (False, True, "a person has declared healthy what the motor showed"),
    ],
)
def test_records_that_do_not_count_are_not_said_to_show_nothing(
    is_complete: bool, is_accepted: bool, words: str
) -> None:
    reason = why_milder(
        State.HEALTHY,
        Verdict.FAULT,
        0.03,
        "a",
        is_later=False,
        is_complete=is_complete,
        is_accepted=is_accepted,
    )
    assert reason is not None
    assert words in reason
    assert "no change" not in reason

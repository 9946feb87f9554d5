"""The phase of shorted turns in words, the same in reasons, commands and pages."""

from dataclasses import replace
from typing import Any

import pytest

from core.diagnosis.causes import Cause
from core.diagnosis.phase_words import phase_in_words, turns_phase_in_words
from core.diagnosis.verdict import Hypothesis, Verdict
from testing.service.plants import undiagnosable

TURNS = Hypothesis(Cause.SHORTED_TURNS, 0.98, 40.0, "equivalent level 4.0%")
JOINT = Hypothesis(Cause.CONNECTION, 0.98, 40.0, "drop of 2.0%")


@pytest.mark.parametrize(
    ("probabilities", "words"),
    [
        ((0.01, 0.97, 0.02), "b"),
        ((0.717, 0.003, 0.28), "a (72 %) or c (28 %)"),
        ((0.30, 0.36, 0.34), "b (36 %) or c (34 %) or a (30 %)"),
        (None, ""),
    ],
)
def test_a_phase_is_named_alone_or_with_the_others(
    probabilities: tuple[float, float, float] | None, words: str
) -> None:
    assert phase_in_words(probabilities) == words


def test_only_turns_that_are_the_answer_have_a_phase() -> None:
    found = replace(
        undiagnosable(), verdict=Verdict.FAULT, hypotheses=(TURNS,), phase_probabilities=(0.02, 0.98, 0.0)
    )

    def told(**changed: Any) -> str | None:
        return turns_phase_in_words(replace(found, **changed).as_dict())

    assert told() == "b"
    assert told(phase_probabilities=None) == ""
    assert told(hypotheses=(JOINT, TURNS)) is None
    assert told(verdict=Verdict.HEALTHY) is None
    assert told(theta_f=2, hypotheses=()) == "c"
    assert turns_phase_in_words(undiagnosable().as_dict()) is None

"""How an answer compares with the truth."""

from enum import StrEnum

from core.classification.classification import Classification
from core.diagnosis.causes import Causes


class Outcome(StrEnum):
    """How an answer compares with the truth."""

    RIGHT = "right"
    AMONG = "right among those not told apart"
    PARTLY = "a part of it, and nothing wrong"
    MISSED = "called healthy"
    UNTOLD = "nothing told"
    WRONG = "wrong"


def outcome_of(answer: Classification, truth: Causes) -> Outcome:
    """Compare an answer with the causes that are there."""
    likeliest, open_ones = answer.answer.causes, [pair.other.causes for pair in answer.not_told_apart]
    if answer.is_told:
        if likeliest == truth:
            return Outcome.RIGHT
        if not likeliest:
            return Outcome.MISSED
        return Outcome.PARTLY if likeliest < truth else Outcome.WRONG
    if truth in (likeliest, *open_ones) and open_ones:
        return Outcome.AMONG
    if any(one and one <= truth for one in (likeliest, *open_ones)):
        return Outcome.PARTLY
    return Outcome.WRONG if any((likeliest, *open_ones)) else Outcome.UNTOLD

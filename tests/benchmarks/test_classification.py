"""The benchmark of causes told apart."""

from itertools import islice

import pytest

from benchmarks.classification.following import FollowedMotor
from benchmarks.classification.lives import Life
from benchmarks.classification.motor_answers import Course, Said
from benchmarks.classification.outcomes import Outcome, outcome_of
from core.classification.classification import Classification, Explanation, NotToldApart
from core.diagnosis.causes import NOTHING, Cause, Causes

TURNS, JOINT = frozenset({Cause.SHORTED_TURNS}), frozenset({Cause.CONNECTION})


def _answer(*explanations: Causes) -> Classification:
    first, *others = (Explanation(causes, 1.0 / len(explanations)) for causes in explanations)
    open_ones = tuple(NotToldApart(first, other, ()) for other in others)
    return Classification(first, not others, (), (first, *others), open_ones, ())


@pytest.mark.parametrize(
    ("answer", "outcome"),
    [
        (_answer(TURNS), Outcome.RIGHT),
        (_answer(JOINT), Outcome.WRONG),
        (_answer(TURNS | JOINT), Outcome.WRONG),
        (_answer(NOTHING), Outcome.MISSED),
        (_answer(JOINT, TURNS), Outcome.AMONG),
        (_answer(JOINT, NOTHING), Outcome.WRONG),
    ],
)
def test_an_answer_is_compared_with_the_truth(answer: Classification, outcome: Outcome) -> None:
    assert outcome_of(answer, TURNS) is outcome


def test_one_of_two_causes_is_a_part() -> None:
    assert outcome_of(_answer(TURNS), TURNS | JOINT) is Outcome.PARTLY


@pytest.mark.parametrize(
    ("outcomes", "after"),
    [
        ((Outcome.RIGHT, Outcome.RIGHT), 1),
        ((Outcome.MISSED, Outcome.RIGHT, Outcome.WRONG, Outcome.RIGHT), 4),
        ((Outcome.RIGHT, Outcome.AMONG), None),
    ],
)
def test_an_answer_is_right_once_it_stays_right(outcomes: tuple[Outcome, ...], after: int | None) -> None:
    assert Course(TURNS, tuple(Said(one, TURNS, told=True) for one in outcomes)).right_after == after


def test_a_cause_changes_nothing_of_what_is_drawn_beside_it() -> None:
    life = Life("small", 3)
    (_, sound), (_, wrong) = (
        next(life.present(causes)) for causes in (NOTHING, frozenset({Cause.CURRENT_CHANNEL}))
    )
    channel = life.sizes.current_channel
    others = [number for number in range(6) if number != channel]
    assert (sound.samples[others] == wrong.samples[others]).all()
    assert abs(wrong.samples[channel]).max() != abs(sound.samples[channel]).max()
    assert sound.start_time_ns == wrong.start_time_ns


def test_a_copy_of_a_followed_motor_goes_on_as_it_does() -> None:
    life = Life("small", 3)
    motor = FollowedMotor(life.known())
    recordings = (recording for is_start, recording in life.past() if not is_start)
    for recording in islice(recordings, 2):
        motor.take_record(recording)
    same = motor.copy()
    third = next(recordings)
    for one in (motor, same):
        one.take_record(third)
    assert same.answer() == motor.answer()

"""What counts, and what is a replay, another configuration, a test, or silence."""

from dataclasses import replace

import pytest

from mms.goose import Reception, Subscription
from mms.goose.frame import GooseFrame
from tests.mms.goose.messages import BLOCK, FRAME, frame

LIFE_S = 3.0
HIGHEST = 2**32 - 1


@pytest.fixture
def subscription() -> Subscription:
    return Subscription(BLOCK)


def test_states_follow_each_other(subscription: Subscription) -> None:
    made = [
        subscription.receive(each, now_s)
        for now_s, each in enumerate(
            [frame(7, 4), frame(7, 5), frame(8, 0, (True, 5)), frame(8, 1, (True, 5))]
        )
    ]
    assert made == [Reception.FIRST, Reception.REPEATED, Reception.CHANGED, Reception.REPEATED]
    assert subscription.latest is not None
    assert subscription.latest.values == (True, 5)
    assert (subscription.missed_states, subscription.lost, subscription.ignored) == (0, 0, {})


def test_a_replay_changes_nothing(subscription: Subscription) -> None:
    subscription.receive(frame(7, 4), 0)
    subscription.receive(frame(8, 0, (True, 5)), 1)
    for old in (frame(7, 4), frame(7, 9), frame(8, 0, (True, 5))):
        assert subscription.receive(old, 2) is Reception.REPLAYED
    assert subscription.latest == frame(8, 0, (True, 5)).message
    assert subscription.ignored == {Reception.REPLAYED: 3}


def test_missed_states_are_counted(subscription: Subscription) -> None:
    subscription.receive(frame(7, 0), 0)
    assert subscription.receive(frame(11, 2), 1) is Reception.CHANGED
    assert subscription.missed_states == 3


@pytest.mark.parametrize(
    ("wrong", "reason"),
    [
        (frame(8, 0, configuration_revision=4), Reception.WRONG_REVISION),
        (frame(8, 0, data_set="A1_SEL710CFG/LLN0$DSet05"), Reception.WRONG_DATA_SET),
        (frame(8, 0, goose_id="ANOTHER"), Reception.WRONG_DATA_SET),
        (frame(8, 0, (True,)), Reception.WRONG_DATA_SET),
        (frame(8, 0, simulation=True), Reception.SIMULATED),
        (replace(frame(8, 0), simulated=True), Reception.SIMULATED),
        (frame(8, 0, needs_commissioning=True), Reception.NEEDS_COMMISSIONING),
        (frame(8, 0, time_allowed_to_live_ms=0), Reception.ENDLESS),
        (replace(FRAME, application_id=6), Reception.WRONG_ADDRESS),
        (replace(FRAME, destination=bytes.fromhex("010ccd010006")), Reception.WRONG_ADDRESS),
        (frame(7, 1, (True, 5)), Reception.CONTRADICTORY),
    ],
)
def test_what_does_not_count_is_told_by_its_reason(
    subscription: Subscription, wrong: GooseFrame, reason: Reception
) -> None:
    subscription.receive(frame(7, 0), 0)
    assert subscription.receive(wrong, 1) is reason
    assert subscription.ignored == {reason: 1}
    assert subscription.latest == frame(7, 0).message


def test_a_test_set_counts_where_it_is_asked_for() -> None:
    subscription = Subscription(BLOCK, accept_simulated=True)
    assert subscription.receive(replace(frame(7, 0), simulated=True), 0) is Reception.FIRST


def test_silence_is_told_once_and_any_state_ends_it(subscription: Subscription) -> None:
    subscription.receive(frame(7, 0), 0)
    assert not subscription.expire(LIFE_S)
    assert subscription.expire(LIFE_S + 0.01)
    assert not subscription.expire(LIFE_S + 1)
    assert not subscription.is_alive
    assert subscription.receive(frame(1, 0), 10) is Reception.RESUMED, "the relay was restarted"
    assert (subscription.is_alive, subscription.lost) == (True, 1)


def test_what_is_ignored_keeps_nobody_alive(subscription: Subscription) -> None:
    subscription.receive(frame(7, 0), 0)
    subscription.receive(frame(7, 0), LIFE_S - 0.1)
    assert subscription.expire(LIFE_S + 0.01)


def test_numbers_go_on_with_1(subscription: Subscription) -> None:
    subscription.receive(frame(HIGHEST, HIGHEST), 0)
    assert subscription.receive(frame(HIGHEST, 1), 1) is Reception.REPEATED
    assert subscription.receive(frame(1, 0, (True, 5)), 2) is Reception.CHANGED
    assert subscription.missed_states == 0
    assert subscription.receive(frame(HIGHEST, 2), 2.5) is Reception.REPLAYED

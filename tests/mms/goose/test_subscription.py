"""What a subscriber makes of replays, other configurations, tests, jumps, wraps and silence."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mms.goose import GooseFrame, Reception, Subscription
from mms.goose.subscription import LONGEST_CAP_S, SHORTEST_CAP_S, UNSAID_CAP_S, ahead, following
from mms.values import Timestamp
from tests.mms.goose.blocks import BLOCK, NOW_NS, frame, frames

HIGHEST = 2**32 - 1


@pytest.fixture
def subscription() -> Subscription:
    """It has heard state 5 at 0 s."""
    found = Subscription(BLOCK)
    assert found.receive(frame(), 0.0) is Reception.FIRST
    return found


def test_the_same_state_again_and_a_later_one_count(subscription: Subscription) -> None:
    assert subscription.receive(frame(sequence_number=1), 0.1) is Reception.REPEATED
    assert subscription.receive(frame(state_number=6, values=(True,)), 0.2) is Reception.CHANGED
    assert subscription.latest == frame(state_number=6, values=(True,)).message
    assert (subscription.missed_states, subscription.ignored) == (0, {})


@pytest.mark.parametrize(
    "old",
    [{}, {"state_number": 4, "sequence_number": 99, "values": (True,)}, {"sequence_number": 2}],
    ids=["the same again", "an earlier state", "an earlier telling"],
)
def test_a_replay_is_ignored_and_does_not_keep_the_publisher_alive(
    subscription: Subscription, old: dict[str, object]
) -> None:
    subscription.receive(frame(sequence_number=2), 0.0)
    before = subscription.latest
    assert subscription.receive(frame(**old), 1.9) is Reception.REPLAYED
    assert subscription.latest == before
    assert subscription.expire(2.1)


def test_another_content_under_the_same_number_is_ignored(subscription: Subscription) -> None:
    assert subscription.receive(frame(sequence_number=1, values=(True,)), 0.1) is Reception.CONTRADICTORY
    later = frame(sequence_number=1, time=Timestamp(NOW_NS + 10**9))
    assert subscription.receive(later, 0.1) is Reception.CONTRADICTORY


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"configuration_revision": 4}, Reception.WRONG_REVISION),
        ({"simulation": True}, Reception.SIMULATED),
        ({"needs_commissioning": True}, Reception.NEEDS_COMMISSIONING),
        ({"data_set": "A1_SEL710CFG/LLN0$DSet05"}, Reception.WRONG_DATA_SET),
        ({"goose_id": "other"}, Reception.WRONG_DATA_SET),
        ({"values": (True, True)}, Reception.WRONG_DATA_SET),
        ({"time_allowed_to_live_ms": 0}, Reception.ENDLESS),
    ],
)
def test_what_is_not_as_configured_is_ignored_and_counted(
    subscription: Subscription, changes: dict[str, object], expected: Reception
) -> None:
    before = subscription.latest
    strange = frame(**{"state_number": 6, "values": (True,), **changes})
    assert subscription.receive(strange, 0.1) is expected
    assert (subscription.latest, subscription.ignored) == (before, {expected: 1})
    assert subscription.receive(frame(state_number=6), 0.2) is Reception.CHANGED


def test_the_simulation_bit_of_the_header_counts_too(subscription: Subscription) -> None:
    simulated = replace(frame(state_number=6), simulated=True)
    assert subscription.receive(simulated, 0.1) is Reception.SIMULATED
    accepting = Subscription(BLOCK, accept_simulated=True)
    assert accepting.receive(simulated, 0.1) is Reception.FIRST


@pytest.mark.parametrize("other", [{"application_id": 0x3002}, {"destination": bytes(6)}])
def test_another_address_is_ignored(subscription: Subscription, other: dict[str, object]) -> None:
    strange = replace(frame(state_number=6), **other)  # type: ignore[arg-type] # fields by name
    assert subscription.receive(strange, 0.1) is Reception.WRONG_ADDRESS


def test_a_jump_of_the_state_number_is_counted(subscription: Subscription) -> None:
    assert subscription.receive(frame(state_number=9), 0.1) is Reception.CHANGED
    assert subscription.missed_states == 3


def test_both_numbers_go_on_with_one_after_the_highest() -> None:
    found = Subscription(BLOCK)
    found.receive(frame(state_number=HIGHEST, sequence_number=HIGHEST), 0.0)
    assert found.receive(frame(state_number=HIGHEST, sequence_number=1), 0.1) is Reception.REPEATED
    assert found.receive(frame(state_number=1, sequence_number=0), 0.2) is Reception.CHANGED
    assert found.receive(frame(state_number=HIGHEST, sequence_number=2), 0.3) is Reception.REPLAYED
    assert found.missed_states == 0


def test_a_publisher_that_is_silent_for_longer_than_it_said_is_lost_once(subscription: Subscription) -> None:
    assert subscription.is_alive
    assert not subscription.expire(2.0)
    assert subscription.expire(2.001)
    assert not subscription.expire(3.0)
    assert (subscription.is_alive, subscription.lost) == (False, 1)


def test_a_publisher_that_begins_anew_is_taken_only_after_its_time_has_run_out(
    subscription: Subscription,
) -> None:
    anew = frame(state_number=1, time=Timestamp(NOW_NS + 10**9))
    assert subscription.receive(anew, 1.9) is Reception.REPLAYED
    assert subscription.receive(anew, 2.1) is Reception.RESUMED
    assert subscription.lost == 1


@pytest.mark.parametrize(
    ("maximum_time_ms", "longest_s"),
    [
        (1000, 4.0),
        (10, SHORTEST_CAP_S),
        (10**9, LONGEST_CAP_S),
        (None, UNSAID_CAP_S),
        (0, UNSAID_CAP_S),
    ],
)
def test_no_state_lives_longer_than_its_block_allows(maximum_time_ms: int | None, longest_s: float) -> None:
    found = Subscription(replace(BLOCK, maximum_time_ms=maximum_time_ms))
    found.receive(frame(time_allowed_to_live_ms=HIGHEST), 0.0)
    assert not found.expire(longest_s)
    assert found.expire(longest_s + 0.001)


def forged(number: int = 0) -> GooseFrame:
    """A message of a state far ahead, which promises to live for ten minutes."""
    return frame(state_number=5 + 10**9, sequence_number=number, time_allowed_to_live_ms=600_000)


def told_every_second(found: Subscription, forge_every_s: int | None) -> tuple[list[bool], list[float]]:
    """Forge a state once, or on and on, while the publisher tells its own, and trips after 1.5 s.

    Returns whether it was disputed after each of its messages, and when its trip counted.
    """
    assert found.receive(forged(), 0.0).counts
    is_disputed, counted_s = [], []
    for second in range(1, 20):
        if forge_every_s and second % forge_every_s == 0:
            found.receive(forged(second), second - 0.5)
        trips = second > 1
        told = frame(state_number=6 if trips else 5, sequence_number=second, values=(trips,))
        if found.receive(told, float(second)).counts and trips:
            counted_s.append(float(second))
        is_disputed.append(found.is_disputed)
    return is_disputed, counted_s


def test_after_one_forged_state_the_publisher_counts_again_once_the_capped_life_is_over() -> None:
    found = Subscription(replace(BLOCK, maximum_time_ms=1000))
    found.receive(frame(), 0.0)
    is_disputed, counted_s = told_every_second(found, None)
    assert counted_s == [float(second) for second in range(5, 20)]
    # It is told from the second ignored message on, until none has been ignored for a life.
    assert is_disputed == [False, *[True] * 6, *[False] * 12]


def test_beside_a_forger_that_goes_on_the_publisher_counts_again_and_again() -> None:
    found = Subscription(replace(BLOCK, maximum_time_ms=1000))
    found.receive(frame(), 0.0)
    is_disputed, counted_s = told_every_second(found, 1)
    # Its first ignored message came after 1 s; each further time begins with the forger's next message.
    assert counted_s == [6.0, 12.0, 18.0]
    assert is_disputed == [False, *[True] * 18]


def test_duplicates_of_the_latest_state_are_no_dispute(subscription: Subscription) -> None:
    """As two paths of a redundant network bring them."""
    for number in range(1, 40):
        assert subscription.receive(frame(sequence_number=number), number / 2) is Reception.REPEATED
        assert subscription.receive(frame(sequence_number=number), number / 2) is Reception.REPLAYED
        assert not subscription.is_disputed


def test_one_frame_told_again_and_again_is_a_dispute_and_never_counts() -> None:
    found = Subscription(replace(BLOCK, maximum_time_ms=1000))
    found.receive(frame(), 0.0)
    for number in range(1, 40):
        assert found.receive(frame(sequence_number=number), number / 2) is Reception.REPEATED
        old = frame(state_number=4, values=(True,))
        assert found.receive(old, number / 2) is Reception.REPLAYED
    assert found.is_disputed


@given(st.integers(0, HIGHEST))
def test_the_number_after_a_number_is_one_ahead(number: int) -> None:
    assert ahead(number, following(number)) == 1
    assert ahead(following(number), number) <= -1 or number == 0
    assert ahead(number, number) == 0


@given(st.lists(st.tuples(frames, st.floats(0, 100)), max_size=10))
def test_frames_of_strangers_change_nothing(received: list[tuple[GooseFrame, float]]) -> None:
    found = Subscription(BLOCK)
    found.receive(frame(time_allowed_to_live_ms=10**6), 0.0)
    for strange, now_s in received:
        assert not found.receive(strange, now_s).counts
    assert found.latest == frame(time_allowed_to_live_ms=10**6).message

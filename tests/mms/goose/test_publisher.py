"""When a publisher tells its state, and that a subscriber follows it."""

import threading

from hypothesis import given
from hypothesis import strategies as st

from mms.goose import (
    PublishedBlock,
    Publisher,
    PublisherThread,
    Reception,
    Subscription,
    decode_frame,
)
from testing.waiting import eventually
from tests.mms.goose.blocks import BLOCK, NOW_NS, SOURCE

PUBLISHED = PublishedBlock(
    reference=BLOCK.reference,
    data_set=BLOCK.data_set,
    goose_id=BLOCK.goose_id,
    configuration_revision=BLOCK.configuration_revision,
    destination=BLOCK.destination,
    application_id=BLOCK.application_id,
    vlan_id=10,
)


def publisher() -> Publisher:
    return Publisher(PUBLISHED, SOURCE, [False], NOW_NS)


def test_intervals_grow_to_the_longest_and_a_message_outlives_the_next_two() -> None:
    publishing, now_s, intervals = publisher(), 100.0, []
    for _ in range(12):
        message = decode_frame(publishing.next_frame(now_s)).message
        intervals.append(round((publishing.due_s - now_s) * 1000))
        assert message.time_allowed_to_live_ms >= 2 * intervals[-1]
        now_s = publishing.due_s
    assert intervals == [4, 8, 16, 32, 64, 128, 256, 512, 1000, 1000, 1000, 1000]


def test_a_change_is_due_at_once_under_the_next_number() -> None:
    publishing = publisher()
    first = [decode_frame(publishing.next_frame(now_s)).message for now_s in (1.0, 2.0)]
    publishing.change([True], NOW_NS + 5)
    assert publishing.due_s == 0.0
    changed = decode_frame(publishing.next_frame(3.0))
    assert [(one.state_number, one.sequence_number) for one in first] == [(1, 0), (1, 1)]
    message = changed.message
    assert (message.state_number, message.sequence_number, message.values) == (2, 0, (True,))
    assert (changed.vlan_id, changed.vlan_priority) == (10, 4)


@given(st.lists(st.booleans(), max_size=30))
def test_a_subscriber_follows_whatever_is_published(changes: list[bool]) -> None:
    publishing, subscription, now_s = publisher(), Subscription(BLOCK), 0.0
    subscription.receive(decode_frame(publishing.next_frame(now_s)), now_s)
    for number, is_change in enumerate(changes):
        if is_change:
            publishing.change([number % 2 == 0], NOW_NS + number)
        now_s = max(now_s, publishing.due_s)
        made = subscription.receive(decode_frame(publishing.next_frame(now_s)), now_s)
        assert made is (Reception.CHANGED if is_change else Reception.REPEATED)
    assert (subscription.missed_states, subscription.lost, subscription.ignored) == (0, 0, {})


def test_the_thread_sends_changes_and_survives_an_interface_that_is_down() -> None:
    sent: list[bytes] = []
    down = threading.Event()

    def send(frame: bytes) -> None:
        if down.is_set():
            raise OSError("network is down")
        sent.append(frame)

    thread, publishing = PublisherThread(send), publisher()
    thread.add(publishing)
    thread.start()
    try:
        assert eventually(lambda: len(sent) >= 3)
        down.set()
        assert eventually(lambda: thread.failed > 0)
        down.clear()
        thread.change(publishing, [True], NOW_NS)
        assert eventually(lambda: decode_frame(sent[-1]).message.values == (True,))
    finally:
        thread.stop()

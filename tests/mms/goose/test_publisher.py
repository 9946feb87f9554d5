"""A state is told at once and then at growing intervals, and a subscriber follows."""

from itertools import pairwise

import pytest

from mms.goose import PublishedBlock, Publisher, PublisherThread, Reception, Subscription, decode_frame
from testing.waiting import eventually
from tests.mms.goose.messages import BLOCK, SOURCE

PUBLISHED = PublishedBlock(
    BLOCK.reference,
    BLOCK.data_set,
    BLOCK.goose_id,
    BLOCK.configuration_revision,
    BLOCK.destination,
    BLOCK.application_id,
)


def test_intervals_grow_to_the_longest() -> None:
    publisher = Publisher(PUBLISHED, SOURCE, (False, 5), 0)
    now_s, times_s, lives_s = 0.0, [], []
    for _ in range(12):
        message = decode_frame(publisher.next_frame(now_s)).message
        times_s.append(now_s)
        lives_s.append(message.time_allowed_to_live_ms / 1000)
        now_s = publisher.due_s
    intervals_s = [after - before for before, after in pairwise(times_s)]
    assert intervals_s[:3] == pytest.approx([0.004, 0.008, 0.016])
    assert intervals_s[-1] == pytest.approx(1.0)
    assert all(life_s > interval_s for life_s, interval_s in zip(lives_s, intervals_s, strict=False))


def test_a_subscriber_follows() -> None:
    publisher, subscription = Publisher(PUBLISHED, SOURCE, (False, 5), 0), Subscription(BLOCK)
    made = [subscription.receive(decode_frame(publisher.next_frame(0.0)), 0.0) for _ in range(2)]
    publisher.change((True, 5), 1_000_000_000)
    assert publisher.due_s == 0
    made += [subscription.receive(decode_frame(publisher.next_frame(0.005)), 0.005) for _ in range(2)]
    assert made == [Reception.FIRST, Reception.REPEATED, Reception.CHANGED, Reception.REPEATED]


def test_the_thread_sends_what_is_due_and_goes_on_after_a_failure() -> None:
    sent: list[bytes] = []
    broken = [True]

    def send(frame: bytes) -> None:
        if broken:
            raise OSError("the interface is down")
        sent.append(frame)

    thread = PublisherThread(send)
    publisher = Publisher(PUBLISHED, SOURCE, (False, 5), 0)
    thread.start()
    try:
        thread.add(publisher)
        assert eventually(lambda: thread.failed >= 2)
        broken.clear()
        assert eventually(lambda: len(sent) >= 1)
        thread.change(publisher, (True, 5), 1_000_000_000)
        assert eventually(lambda: any(decode_frame(each).message.values == (True, 5) for each in sent))
    finally:
        thread.stop()
    number = len(sent)
    assert not eventually(lambda: len(sent) > number, 0.2)

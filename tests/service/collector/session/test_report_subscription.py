"""Which report block tells of the records, and what happens where none can be had, over real MMS."""

import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from queue import SimpleQueue
from threading import Event

import pytest
from structlog.testing import capture_logs

import scl
from mms import Client, Report
from service.collector.records.pull import DailyAllowance
from service.collector.session.link import Link
from service.collector.session.notes import WrittenAtOnce
from service.collector.session.report_subscription import ReportQueue, ReportSubscription
from service.collector.session.session_policy import SessionPolicy
from service.plant import acquisition_from_scl
from service.storage.records import ReportPosition
from service.storage.states import LinkState
from testing.waiting import eventually
from tests.service.collector.conftest import Bench
from tests.service.collector.expectations import expecting
from tests.service.collector.scripted_relay import NAME, REPORT_CONTROL, ScriptedRelay

NODE = f"{NAME}CFG/LLN0"
BUFFERED = (f"{NODE}.BR.BRep01", f"{NODE}.BR.BRep02")
UNBUFFERED = f"{NODE}.RP.URep03"
"""Those that tell of a record, the best first."""

OVERFLOWED = "the relay's report buffer had overflowed"
CHATTER = 60


@pytest.fixture
def here(bench: Bench) -> Bench:
    """With what the relay's SCL says; reports alone can hurry a scan."""
    return expecting(bench.with_settings(poll_period_s=60.0), scl.read(scl.DEMO_PLANT_SCD).ied(NAME))


@contextmanager
def taken(relay: ScriptedRelay, *blocks: str) -> Iterator[None]:
    """Another client has these blocks."""
    with Client.connect("127.0.0.1", relay.port) as other:
        for block in blocks:
            other.subscribe(block, SimpleQueue())
        yield


def used(bench: Bench) -> object:
    """The block in use, "" before the first visit."""
    findings = bench.repository.relay_findings(NAME)
    return "" if findings is None else findings.acquisition["report_control"]


@pytest.mark.parametrize(
    ("by_another", "left"),
    [((), BUFFERED[0]), (BUFFERED[:1], BUFFERED[1]), (BUFFERED, UNBUFFERED)],
    ids=["none taken", "another buffered one", "an unbuffered one"],
)
def test_the_best_block_that_is_free_tells_of_the_records(
    here: Bench, relay: ScriptedRelay, by_another: tuple[str, ...], left: str
) -> None:
    with taken(relay, *by_another), here.session():
        assert eventually(lambda: used(here) == left)
        relay.write_record("HR_7")
        assert eventually(lambda: here.is_stored("HR_7")), "no poll finds it so soon"
        buffered = ".BR." in left
        assert eventually(lambda: (here.repository.entry_id(NAME, left) is not None) == buffered)
    assert here.repository.relay(NAME).link_reason is None


def test_with_all_blocks_taken_the_directory_is_polled_until_one_is_free(
    here: Bench, relay: ScriptedRelay
) -> None:
    here.policy = SessionPolicy(report_retry_s=0.5)
    here.with_settings(poll_period_s=0.2)
    with ExitStack() as others:
        others.enter_context(taken(relay, *BUFFERED, UNBUFFERED))
        with here.session():
            assert eventually(lambda: used(here) is None)
            relay.write_record("HR_1")
            assert eventually(lambda: here.is_stored("HR_1"))
            reason = here.repository.relay(NAME).link_reason or ""
            assert "the directory is polled" in reason
            assert "(and 2 others)" in reason
            others.close()
            assert eventually(lambda: used(here) == BUFFERED[0])
            assert eventually(lambda: here.repository.relay(NAME).link_reason is None)
    history = here.repository.link_changes(NAME, limit=10).items
    assert [("polled" in (change.reason or ""), change.state) for change in history] == [
        (False, LinkState.UP),
        (True, LinkState.UP),
    ]


def test_an_entry_id_is_of_the_block_it_came_from(here: Bench, relay: ScriptedRelay) -> None:
    with here.session():
        relay.write_record("HR_1")
        assert eventually(lambda: here.repository.entry_id(NAME, BUFFERED[0]) is not None)
    assert here.repository.entry_id(NAME, BUFFERED[1]) is None
    with taken(relay, BUFFERED[0]), here.session():
        assert eventually(lambda: used(here) == BUFFERED[1])
        assert eventually(lambda: here.link() is LinkState.UP)
    assert here.repository.link_figures(NAME).report_gaps == 0, "another block's buffer lost nothing"


def test_an_entry_id_of_before_blocks_were_told_apart_is_any_block_s(here: Bench) -> None:
    here.repository.save_report_positions([ReportPosition(NAME, b"12345678", None)])
    assert here.repository.entry_id(NAME, BUFFERED[1]) == b"12345678"


@pytest.mark.parametrize("resumed", [False, True])
def test_an_overflow_is_told_where_it_means_one(bench: Bench, relay: ScriptedRelay, resumed: bool) -> None:
    """A block that is enabled without an EntryID begins with the bit set."""
    report = Report(
        rcb_reference=REPORT_CONTROL,
        report_id="",
        entry_id=None,
        sequence_number=0,
        timestamp_ns=None,
        buffer_overflow=True,
        data_set=None,
        members=(),
    )
    notes = WrittenAtOnce(bench.repository)
    link = Link(NAME, notes, DailyAllowance(1))
    subscription = ReportSubscription(NAME, bench.repository, link, notes)
    if resumed:
        with bench.session():
            relay.write_record("HR_1")
            assert eventually(lambda: bench.repository.entry_id(NAME) is not None)
    with Client.connect("127.0.0.1", relay.port) as client, capture_logs() as logs:
        subscription.begin(client, ReportQueue(Event()), acquisition_from_scl(bench.relay))
        subscription.handle(report)
        assert [entry["event"] for entry in logs].count(OVERFLOWED) == int(resumed)
        subscription.handle(report)
        assert [entry["event"] for entry in logs].count(OVERFLOWED) == int(resumed) + 1


def test_a_chattering_input_lists_nothing(here: Bench, relay: ScriptedRelay) -> None:
    with here.session():
        assert eventually(lambda: here.link() is LinkState.UP)
        before = relay.listings
        for change in range(CHATTER):
            relay.server.update_many({f"{NAME}PRO/TRIPPTRC1.Tr.general": change % 2 == 0})
            time.sleep(0.02)  # a report each
        relay.write_record("HR_7")
        assert eventually(lambda: here.is_stored("HR_7"))
        assert eventually(lambda: here.repository.link_figures(NAME).reports > CHATTER / 2)
    assert relay.listings - before < CHATTER / 4, "the record alone was looked for"

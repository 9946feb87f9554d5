"""Buffered and unbuffered reports: delivery, resuming after a loss, overflow, and blocks that are taken."""

import gc
import itertools
import queue
import threading
import time
import weakref

import pytest

from mms import (
    Client,
    EntryNotFound,
    FunctionalConstraint,
    MmsError,
    NotFound,
    ProtocolError,
    Quality,
    Reason,
    Report,
    ReportControlInUse,
    Server,
    Timestamp,
    Validity,
)
from mms.client.reports import Subscriptions, _Field
from testing.ports import LOOPBACK, free_port
from testing.relays.model import MODEL_TEXT
from testing.relays.serving import RelayProcess, start_relay

BUFFERED = "T1PRO/LLN0.BR.BRep01"
UNBUFFERED = "T1PRO/LLN0.RP.URep01"
IND01 = "T1PRO/GGIO1.Ind01"


def _queue() -> "queue.SimpleQueue[Report]":
    return queue.SimpleQueue()


def _drain(reports: "queue.SimpleQueue[Report]", quiet_s: float = 0.4) -> list[Report]:
    """All reports until none has come for a while."""
    found = []
    while True:
        try:
            found.append(reports.get(timeout=quiet_s))
        except queue.Empty:
            return found


def _is_gone(reports: "weakref.ref[queue.SimpleQueue[Report]]") -> bool:
    """Whether nobody holds the queue any more."""
    gc.collect()
    return reports() is None


def _event(number: int) -> dict[str, bool | Timestamp]:
    """The state of event `number`; its time counts events, so that loss and order show."""
    return {f"{IND01}.stVal": number % 2 == 1, f"{IND01}.t": Timestamp(number * 1_000_000_000, 0)}


def _numbers(reports: list[Report]) -> list[int]:
    times = [
        member.value[2] for report in reports for member in report.members if isinstance(member.value, tuple)
    ]
    return [time.ns // 1_000_000_000 for time in times if isinstance(time, Timestamp)]


@pytest.mark.parametrize("reference", [BUFFERED, UNBUFFERED])
def test_a_change_is_reported_with_time_quality_and_reason(
    relay: Server, client: Client, reference: str
) -> None:
    reports = _queue()
    client.subscribe(reference, reports)
    sent_s = time.monotonic()
    relay.update_many({**_event(1), f"{IND01}.q": Quality(Validity.INVALID, failure=True)})
    report = reports.get(timeout=5)
    assert time.monotonic() - sent_s < 1
    assert report.rcb_reference == reference
    assert report.report_id == reference.rpartition(".")[2]
    assert report.data_set == "T1PRO/LLN0$DSet01"
    assert report.sequence_number == 0
    assert report.timestamp_ns is not None
    assert abs(report.timestamp_ns - time.time_ns()) < 60e9
    (member,) = report.members
    assert (member.index, member.reference) == (0, "T1PRO/GGIO1$ST$Ind01")
    value = member.value
    assert value == (True, Quality(Validity.INVALID, failure=True).bits, Timestamp(1_000_000_000, 0))
    assert Reason.DATA_CHANGE in member.reasons
    assert (report.entry_id is not None) == (reference == BUFFERED)
    assert not report.more_segments_follow


def test_a_general_interrogation_reports_every_member(relay: Server, client: Client) -> None:
    reports = _queue()
    client.subscribe(UNBUFFERED, reports, general_interrogation=True)
    report = reports.get(timeout=5)
    assert [member.index for member in report.members] == [0, 1, 2, 3]
    assert {member.reasons for member in report.members} == {Reason.GENERAL_INTERROGATION}


def test_a_block_without_a_report_id_is_matched_by_its_reference(relay: Server, client: Client) -> None:
    reports = _queue()
    client.subscribe("T1PRO/LLN0.BR.BRep02", reports)
    relay.update(f"{IND01}.stVal", value=True)
    assert reports.get(timeout=5).rcb_reference == "T1PRO/LLN0.BR.BRep02"


def test_two_blocks_of_one_client_keep_their_reports_apart(relay: Server, client: Client) -> None:
    buffered, unbuffered = _queue(), _queue()
    client.subscribe(BUFFERED, buffered)
    client.subscribe(UNBUFFERED, unbuffered)
    relay.update(f"{IND01}.stVal", value=True)
    assert buffered.get(timeout=5).rcb_reference == BUFFERED
    assert unbuffered.get(timeout=5).rcb_reference == UNBUFFERED


def test_two_blocks_with_one_report_id_cannot_be_told_apart(client: Client) -> None:
    client.subscribe("T1PRO/LLN0.RP.Twin01", _queue())
    with pytest.raises(ProtocolError, match="same report ID 'twin'"):
        client.subscribe("T1PRO/LLN0.RP.Twin02", _queue())


def test_a_block_taken_by_another_client_is_refused_and_given_back_later(
    relay: Server, client: Client
) -> None:
    for reference in (BUFFERED, UNBUFFERED):
        first = Client.connect(LOOPBACK, relay.port)
        first.subscribe(reference, _queue())
        with pytest.raises(ReportControlInUse):
            client.subscribe(reference, _queue())
        first.unsubscribe(reference)
        first.close()
        reports = _queue()
        client.subscribe(reference, reports)
        relay.update(f"{IND01}.stVal", reference == BUFFERED)
        assert reports.get(timeout=5)


def test_a_block_taken_at_the_last_moment_leaves_nothing_behind(
    relay: Server, client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A relay may refuse for months: what was to take the reports must not pile up till the link ends."""
    write = Subscriptions._write
    with Client.connect(LOOPBACK, relay.port) as other:

        def overtaken(self: Subscriptions, operation: str, block: int, field: _Field) -> None:
            if self is not other._subscriptions and field is _Field.ENABLE:
                other.subscribe(BUFFERED, _queue())
            write(self, operation, block, field)

        monkeypatch.setattr(Subscriptions, "_write", overtaken)
        reports = _queue()
        held = weakref.ref(reports)
        with pytest.raises(ReportControlInUse, match="another client holds the block"):
            client.subscribe(BUFFERED, reports)
        del reports
        assert _is_gone(held)


def test_a_block_given_back_leaves_nothing_behind(client: Client) -> None:
    reports = _queue()
    held = weakref.ref(reports)
    client.subscribe(BUFFERED, reports)
    del reports
    assert not _is_gone(held)
    client.unsubscribe(BUFFERED)
    assert _is_gone(held)


def test_a_block_is_enabled_once_a_client(client: Client) -> None:
    client.subscribe(BUFFERED, _queue())
    with pytest.raises(ReportControlInUse, match="this client"):
        client.subscribe(BUFFERED, _queue())


def test_no_reports_come_after_unsubscribing(relay: Server, client: Client) -> None:
    reports = _queue()
    client.subscribe(UNBUFFERED, reports)
    client.unsubscribe(UNBUFFERED)
    relay.update(f"{IND01}.stVal", value=True)
    assert _drain(reports, 0.2) == []
    client.subscribe(UNBUFFERED, reports)
    relay.update(f"{IND01}.stVal", value=False)
    assert reports.get(timeout=5).members[0].index == 0


def test_nothing_is_lost_over_disconnects(relay: Server) -> None:
    """Events go on while the client is cut off three times; it resumes after the last entry it had."""
    stop = threading.Event()
    sent = itertools.count(1)
    last = 0

    def produce() -> None:
        nonlocal last
        while not stop.wait(0.004):
            last = next(sent)
            relay.update_many(_event(last))

    reports = _queue()
    received: list[Report] = []
    producer = threading.Thread(target=produce)
    client = Client.connect(LOOPBACK, relay.port)
    client.subscribe(BUFFERED, reports)
    producer.start()
    for _ in range(3):
        received.append(reports.get(timeout=5))
        client.close()
        received += _drain(reports, 0.05)
        client = Client.connect(LOOPBACK, relay.port)
        client.subscribe(BUFFERED, reports, entry_id=received[-1].entry_id)
    received.append(reports.get(timeout=5))
    stop.set()
    producer.join()
    received += _drain(reports)
    client.close()
    assert _numbers(received) == list(range(1, last + 1))
    assert not any(report.buffer_overflow for report in received[1:])


def test_a_full_buffer_is_flagged() -> None:
    with start_relay(report_buffer_bytes=2_000) as relay, Client.connect(LOOPBACK, relay.port) as client:
        for number in range(1, 101):
            relay.update_many(_event(number))
        reports = _queue()
        client.subscribe(BUFFERED, reports)
        found = _drain(reports)
        assert found[0].buffer_overflow
        assert not any(report.buffer_overflow for report in found[1:])
        assert 1 < len(found) < 100
        assert _numbers(found)[-1] == 100


def test_first_values_are_no_events() -> None:
    server = Server(MODEL_TEXT, port=free_port())
    server.update_many(_event(1))
    with server, Client.connect(LOOPBACK, server.port) as client:
        assert client.read(f"{IND01}.stVal", FunctionalConstraint.ST) is True
        server.update_many(_event(2))
        reports = _queue()
        client.subscribe(BUFFERED, reports)
        assert _numbers(_drain(reports)) == [2]


def test_an_entry_the_relay_no_longer_holds_is_named(relay: Server, client: Client) -> None:
    with pytest.raises(EntryNotFound, match="does not hold entry 0123456789abcdef"):
        client.subscribe(BUFFERED, _queue(), entry_id=bytes.fromhex("0123456789abcdef"))
    reports = _queue()
    client.subscribe(BUFFERED, reports)
    relay.update(f"{IND01}.stVal", value=True)
    assert reports.get(timeout=5)


def test_wrong_arguments_are_refused_before_any_request(client: Client) -> None:
    with pytest.raises(ValueError, match="8 octets"):
        client.subscribe(BUFFERED, _queue(), entry_id=b"short")
    with pytest.raises(ValueError, match="buffered block"):
        client.subscribe(UNBUFFERED, _queue(), entry_id=bytes(8))
    with pytest.raises(ValueError, match="not a report control block"):
        client.subscribe("T1PRO/LLN0.BRep01", _queue())
    with pytest.raises(MmsError):
        client.subscribe("T1PRO/LLN0.BR.BRep99", _queue())
    with pytest.raises(NotFound):
        client.unsubscribe("T1PRO/LLN0.BR.BRep99")


def test_reports_arrive_while_requests_are_under_way(relay: Server, client: Client) -> None:
    """The SWIG layer deadlocks here: a report during a blocking call."""
    reports = _queue()
    client.subscribe(BUFFERED, reports)
    for number in range(1, 51):
        relay.update_many(_event(number))
        client.logical_devices()
    assert _numbers(_drain(reports)) == list(range(1, 51))


def test_subscribing_to_a_killed_relay_is_an_error(relay_process: RelayProcess) -> None:
    with Client.connect(LOOPBACK, relay_process.port) as client:
        reports = _queue()
        client.subscribe(BUFFERED, reports)
        relay_process.kill()
        assert client.wait_closed(10)
        with pytest.raises(MmsError):
            client.unsubscribe(BUFFERED)

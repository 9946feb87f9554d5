"""A relay that answers every request in time and gets nowhere holds nobody for long."""

import io
import time
from collections.abc import Callable
from dataclasses import replace
from threading import Timer

import pytest

from mms import Client, ClientLimits, ConnectFailed, ConnectionLost, MmsError, Timeout
from service.collector.records.policy import VISIT_ENDS, failure_of
from service.collector.session.session_policy import SessionPolicy
from service.storage.states import LinkState, RecordingState
from testing.ports import LOOPBACK
from testing.waiting import eventually
from tests.hostile import crafted
from tests.hostile.dialogue import PRO, Dialogue, overheard, tlv
from tests.hostile.relay import LIST_OF_NAMES, lying
from tests.service.collector.conftest import Bench, bench

__all__ = ["bench"]

PART_S = 0.05
NAME = "EVENTS/HR_10001.DAT"

pytestmark = pytest.mark.timeout(60)


@pytest.fixture(scope="module")
def dialogue() -> Dialogue:
    return overheard()


def parts_of(size: int) -> Callable[[int], bytes]:
    """A file without end, in parts of `size` bytes, one each PART_S."""
    content = tlv(0x80, bytes(size)) + tlv(0x81, b"\xff")

    def part(_number: int) -> bytes:
        time.sleep(PART_S)
        return b"\xbf\x49" + tlv(0x30, content)[1:]

    return part


def names(number: int) -> bytes:
    """A listing without end, of one name a part."""
    time.sleep(PART_S)
    entry = tlv(0x30, tlv(0xA0, tlv(0x19, b"HR_%09d.CFG" % number)) + tlv(0xA1, tlv(0x80, b"\x01")))
    return crafted.FILE_DIRECTORY + tlv(0x30, tlv(0xA0, tlv(0x30, entry)) + tlv(0x81, b"\xff"))[1:]


def test_a_file_of_a_byte_a_part_ends_in_words(dialogue: Dialogue) -> None:
    began_s = time.monotonic()
    limits = ClientLimits(throughput_window_s=0.5)
    with (
        lying(dialogue, {crafted.FILE_READ: parts_of(1)}) as port,
        Client.connect(LOOPBACK, port, limits=limits) as client,
    ):
        with pytest.raises(
            Timeout, match=r"expected at least 100 bytes a second, received \d+ bytes in 0\.\d s"
        ):
            client.download(NAME, io.BytesIO(), expected_size=10_000)
        assert time.monotonic() - began_s < 2.0
        assert client.read_data_set(f"{PRO}/LLN0.DSet01"), "the association stands"


def test_a_file_over_a_slow_line_is_not_given_up(dialogue: Dialogue) -> None:
    """48 bytes each twentieth of a second at most: a line of 9600 baud."""
    received = io.BytesIO()
    with (
        lying(dialogue, {crafted.FILE_READ: parts_of(48)}) as port,
        Client.connect(LOOPBACK, port, limits=ClientLimits(throughput_window_s=0.2)) as client,
        pytest.raises(MmsError, match="expected 960 bytes, received 1008"),
    ):
        client.download(NAME, received, expected_size=960)
    assert len(received.getvalue()) == 960


def test_a_listing_of_a_name_a_part_ends_in_words(dialogue: Dialogue) -> None:
    with (
        lying(dialogue, {crafted.FILE_DIRECTORY: names}) as port,
        Client.connect(LOOPBACK, port, limits=ClientLimits(listing_s=0.5)) as client,
    ):
        with pytest.raises(Timeout, match=r"expected the whole listing in 0\.5 s, received \d+ names"):
            client.files("EVENTS")
        assert client.read_data_set(f"{PRO}/LLN0.DSet01"), "the association stands"


def device(number: int) -> bytes:
    """A list of names without end, of one name a part."""
    time.sleep(PART_S)
    return tlv(0xA1, tlv(0xA0, tlv(0x1A, b"DEVICE%06d" % number)) + tlv(0x81, b"\xff"))


def test_a_relay_whose_names_never_end_is_no_association(dialogue: Dialogue) -> None:
    """The library asks for part after part within one call."""
    with (
        lying(dialogue, {LIST_OF_NAMES: device}) as port,
        pytest.raises(ConnectFailed, match=r"expected the names of all it offers in 0\.4 s, and more follow"),
    ):
        Client.connect(LOOPBACK, port, limits=ClientLimits(names_s=0.4))


def test_data_sets_that_never_end_end_their_own_association(dialogue: Dialogue) -> None:
    at_connecting = [answer for answer in dialogue.answers.values() if answer[:1] == LIST_OF_NAMES][:1]

    def later(number: int) -> bytes:
        return at_connecting[number] if number < len(at_connecting) else device(number)

    with (
        lying(dialogue, {}) as port,
        Client.connect(LOOPBACK, port) as other,
        lying(dialogue, {LIST_OF_NAMES: later}) as port,
        Client.connect(LOOPBACK, port, limits=ClientLimits(directory_s=0.4)) as client,
    ):
        with pytest.raises(Timeout, match=r"expected all names in 0\.4 s, and more follow"):
            client.data_sets(f"{PRO}/LLN0")
        assert other.read_data_set(f"{PRO}/LLN0.DSet01"), "nobody else's is ended"


@pytest.mark.parametrize("ending", ["close", "abandon"])
@pytest.mark.parametrize(
    "ask",
    [
        lambda client: client.download(NAME, io.BytesIO(), expected_size=10_000),
        lambda client: client.files("EVENTS"),
    ],
    ids=["download", "listing"],
)
def test_whoever_closes_waits_for_one_part_alone(
    dialogue: Dialogue, ask: Callable[[Client], object], ending: str
) -> None:
    lies = {crafted.FILE_READ: parts_of(1), crafted.FILE_DIRECTORY: names}
    with lying(dialogue, lies) as port, Client.connect(LOOPBACK, port) as client:
        closing = Timer(0.3, getattr(client, ending))
        closing.start()
        began_s = time.monotonic()
        with pytest.raises(ConnectionLost):
            ask(client)
        assert time.monotonic() - began_s < 1.5
        closing.join()


def test_a_session_puts_the_trickle_off_and_says_so(dialogue: Dialogue, bench: Bench) -> None:
    assert failure_of(Timeout("relay", "download", 0, "too slow")) in VISIT_ENDS
    bench.policy = SessionPolicy(client=ClientLimits(throughput_window_s=0.5))
    with lying(dialogue, {crafted.FILE_READ: parts_of(1)}) as port:
        bench.relay = replace(bench.relay, port=port)
        with bench.session():
            assert eventually(lambda: bench.link() is LinkState.DOWN, within_s=10)
            reason = bench.repository.relay(bench.relay.name).link_reason
    assert reason is not None
    assert "expected at least 100 bytes a second" in reason


@pytest.mark.campaign
def test_a_file_that_breaks_the_protocol_is_refused_at_last_and_the_relay_visited(
    bench: Bench, dialogue: Dialogue
) -> None:
    empty = b"\xbf\x49" + tlv(0x30, tlv(0x80, b"") + tlv(0x81, b"\xff"))[1:]
    with lying(dialogue, {crafted.FILE_READ: lambda _number: empty}) as port:
        bench = replace(bench, relay=replace(bench.relay, port=port))
        with bench.session():
            assert eventually(lambda: bench.link() is LinkState.QUARANTINED)
        assert state(bench) is RecordingState.ANNOUNCED
        with bench.session():  # the pause is over
            assert eventually(lambda: state(bench) is RecordingState.REJECTED)
            assert eventually(lambda: bench.link() is LinkState.UP)
    refused = bench.recording("HR_10001")
    assert refused is not None
    assert "empty parts without end" in (refused.reason or "")


def state(bench: Bench) -> RecordingState | None:
    recording = bench.recording("HR_10001")
    return None if recording is None else recording.state

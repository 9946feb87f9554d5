"""What a simulated relay tells by GOOSE."""

from dataclasses import replace
from queue import Queue

import pytest

import scl
from ied_sim.relay.goose import GooseOutlet, Held, RelayGoose
from mms import Quality, Timestamp
from mms.goose import GooseMessage, PublisherThread, decode_frame
from scl.goose_blocks import goose_blocks
from scl.ied_model import Ied

NOW_NS = 1_760_000_000 * 10**9
TRIP = "A1_SEL710PRO/TRIPPTRC1.Tr"


@pytest.fixture
def ied() -> Ied:
    return scl.read(scl.DEMO_PLANT_SCD).ied("A1_SEL710")


def test_a_trip_or_a_quality_is_a_new_state_and_a_new_time_alone_is_none(ied: Ied) -> None:
    sent: Queue[bytes] = Queue()
    thread = PublisherThread(sent.put)
    held: dict[str, Held] = {f"{TRIP}.general": False, f"{TRIP}.t": Timestamp(NOW_NS)}
    goose = RelayGoose(ied, GooseOutlet(thread, bytes(6)), held, NOW_NS)
    thread.start()
    try:
        first = message_of(sent, 1)
        goose.update({f"{TRIP}.t": Timestamp(NOW_NS + 1), f"{TRIP}.general": False}, NOW_NS + 1)
        goose.update({f"{TRIP}.general": True, f"{TRIP}.q": Quality(test=True)}, NOW_NS + 10**9)
        tripped = message_of(sent, 2)
        goose.update({f"{TRIP}.general": True, f"{TRIP}.q": Quality(test=True)}, NOW_NS + 2 * 10**9)
        goose.update({f"{TRIP}.q": Quality()}, NOW_NS + 3 * 10**9)
        good_again = message_of(sent, 3)
    finally:
        thread.stop()
    assert first.control_block == "A1_SEL710CFG/LLN0$GO$GPub01"
    assert (first.goose_id, first.configuration_revision, len(first.values)) == ("A1_SEL710", 1, 9)
    assert first.values[0] == (False, Quality().bits, Timestamp.of(Timestamp(NOW_NS).octets()))
    assert (tripped.sequence_number, tripped.time.ns) == (0, NOW_NS + 10**9)
    tripped_value = tripped.values[0]
    assert isinstance(tripped_value, tuple)
    assert tripped_value[:2] == (True, Quality(test=True).bits)
    assert good_again.time.ns == NOW_NS + 3 * 10**9


def test_its_frames_carry_the_tag_with_the_blocks_priority(ied: Ied) -> None:
    """The SCD says VLAN-ID 000 and VLAN-PRIORITY 4: a tag that asks for priority alone."""
    sent: Queue[bytes] = Queue()
    thread = PublisherThread(sent.put)
    RelayGoose(ied, GooseOutlet(thread, bytes(6)), {}, NOW_NS)
    thread.start()
    try:
        octets = sent.get(timeout=30)
    finally:
        thread.stop()
    assert octets[12:18] == bytes.fromhex("8100800088b8")


def message_of(sent: "Queue[bytes]", state: int) -> GooseMessage:
    """The first message of a state."""
    while True:
        message = decode_frame(sent.get(timeout=30)).message
        if message.state_number == state:
            return message


def test_a_block_that_cannot_be_sent_is_left_out_with_a_word(
    ied: Ied, caplog: pytest.LogCaptureFixture
) -> None:
    (block,) = goose_blocks(ied)
    device = ied.logical_devices[0]
    node = device.logical_nodes[0]
    unaddressed = replace(block.control, address=None)
    metered = replace(block.control, name="Metered", data_set="DSet02")
    nothing = replace(block.control, name="Nothing", data_set=None)
    changed = replace(node, goose_controls=(unaddressed, metered, nothing))
    devices = (replace(device, logical_nodes=(changed, *device.logical_nodes[1:])), *ied.logical_devices[1:])
    point = replace(ied.access_points[0], logical_devices=devices)
    thread = PublisherThread(lambda _: None)
    RelayGoose(replace(ied, access_points=(point,)), GooseOutlet(thread, bytes(6)), {}, NOW_NS)
    assert "GPub01: not published: the SCD's Communication section gives it no MAC-Address" in caplog.text
    assert "Metered: not published: A1_SEL710MET/METMMXU1.A: expected data without sub-objects" in caplog.text

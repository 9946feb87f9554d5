"""What a simulated relay tells by GOOSE."""

from dataclasses import replace
from pathlib import Path
from queue import Queue

import pytest

import scl
from ied_sim.relay.goose import GooseOutlet, RelayGoose
from mms import Quality, Timestamp
from mms.goose import GooseMessage, PublisherThread, decode_frame
from scl.goose_blocks import goose_blocks
from testing.relays.goose import REVISION, with_goose

NOW_NS = 1_760_000_000 * 10**9
TRIP = "A1_SEL710PRO/TRIPPTRC1.Tr"


def test_a_trip_is_a_new_state_and_a_new_time_alone_is_none(tmp_path: Path) -> None:
    ied = with_goose(scl.DEMO_PLANT_SCD, tmp_path / "plant.scd").ied("A1_SEL710")
    sent: Queue[bytes] = Queue()
    thread = PublisherThread(sent.put)
    goose = RelayGoose(ied, GooseOutlet(thread, bytes(6)))
    goose.update({f"{TRIP}.general": False, f"{TRIP}.t": Timestamp(NOW_NS)}, NOW_NS)
    goose.begin(NOW_NS)
    thread.start()
    try:
        first = message_of(sent, 1)
        goose.update({f"{TRIP}.t": Timestamp(NOW_NS + 1)}, NOW_NS + 1)
        goose.update({f"{TRIP}.general": True, f"{TRIP}.q": Quality(test=True)}, NOW_NS + 10**9)
        tripped = message_of(sent, 2)
    finally:
        thread.stop()
    assert first.control_block == "A1_SEL710CFG/LLN0$GO$GPub01"
    assert (first.configuration_revision, len(first.values)) == (REVISION, 9)
    assert first.values[0] == (False, Quality().bits, Timestamp.of(Timestamp(NOW_NS).octets()))
    assert (tripped.sequence_number, tripped.time.ns) == (0, NOW_NS + 10**9)
    tripped_value = tripped.values[0]
    assert isinstance(tripped_value, tuple)
    assert tripped_value[:2] == (True, Quality(test=True).bits)


def message_of(sent: "Queue[bytes]", state: int) -> GooseMessage:
    """The first message of a state."""
    while True:
        message = decode_frame(sent.get(timeout=30)).message
        if message.state_number == state:
            return message


def test_a_block_that_cannot_be_sent_is_left_out_with_a_word(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    ied = with_goose(scl.DEMO_PLANT_SCD, tmp_path / "plant.scd").ied("A1_SEL710")
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
    RelayGoose(replace(ied, access_points=(point,)), GooseOutlet(thread, bytes(6))).begin(NOW_NS)
    assert "GPub01: not published: the SCD's Communication section gives it no MAC-Address" in caplog.text
    assert "Metered: not published: A1_SEL710MET/METMMXU1.A: expected data without sub-objects" in caplog.text

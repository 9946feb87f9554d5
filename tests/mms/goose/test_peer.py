"""The frames of open61850, which is not ours, both ways."""

from datetime import UTC, datetime

from hypothesis import assume, given
from open61850 import data as peer_data
from open61850 import goose as peer

from mms.goose import GooseFrame, decode_frame, encode_frame
from mms.values import BitString, Timestamp
from tests.mms.goose.blocks import BLOCK, NOW_NS, SOURCE, frame, frames


@given(frames)
def test_the_peer_reads_our_frames_strictly(sent: GooseFrame) -> None:
    assume(sent.message.control_block)
    read = peer.decode_goose_frame(encode_frame(sent), strict=True)
    assert read is not None
    ethernet, pdu = read
    message = sent.message
    assert (pdu.gocb_ref, pdu.dat_set, pdu.go_id) == (
        message.control_block,
        message.data_set,
        message.goose_id,
    )
    assert (pdu.st_num, pdu.sq_num, pdu.conf_rev) == (
        message.state_number,
        message.sequence_number,
        message.configuration_revision,
    )
    assert (pdu.simulation, pdu.nds_com) == (message.simulation, message.needs_commissioning)
    assert len(pdu.all_data) == len(message.values)
    assert ethernet.app_id == sent.application_id


def test_we_read_what_the_peer_writes() -> None:
    pdu = peer.GoosePDU(
        gocb_ref=BLOCK.reference,
        time_allowed_to_live=2000,
        dat_set=BLOCK.data_set,
        go_id=BLOCK.goose_id,
        timestamp=datetime.fromtimestamp(NOW_NS // 10**9, UTC),
        st_num=2**32 - 1,
        sq_num=0,
        simulation=False,
        conf_rev=3,
        nds_com=False,
        num_dat_set_entries=4,
        all_data=[
            peer_data.BoolData(value=True),
            peer_data.IntData(-5),
            peer_data.FloatData(1.5),
            peer_data.StructureData([peer_data.BoolData(value=False), peer_data.BitStringData(bytes(2), 3)]),
        ],
    )
    octets = peer.encode_goose_frame(
        pdu,
        dst_mac="01:0c:cd:01:00:01",
        src_mac="02:00:00:00:00:01",
        app_id=0x3001,
        vlan_id=7,
        vlan_priority=4,
    )
    read = decode_frame(octets)
    assert (read.destination, read.source, read.vlan_id) == (BLOCK.destination, SOURCE, 7)
    expected = frame(
        state_number=2**32 - 1,
        time=Timestamp(NOW_NS, 0),
        values=(True, -5, 1.5, (False, BitString((False,) * 13))),
    )
    assert read.message == expected.message

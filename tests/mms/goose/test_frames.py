"""Frames there and back, read and written by another stack too, and whatever a network may send."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from open61850 import goose as peer
from open61850.data import BoolData, IntData

from mms.goose import GooseFrame, GooseFrameError, decode_frame, encode_frame
from mms.values import BitString, Timestamp, Value
from tests.mms.goose.messages import FRAME, MESSAGE

ETHERNET, HEADER = 14, 8
NUMBERS = st.integers(0, 2**32 - 1)
LEAVES: st.SearchStrategy[Value] = st.one_of(
    st.booleans(),
    st.integers(-(2**31), 2**31 - 1),
    st.floats(width=32, allow_nan=False),
    st.text(st.characters(codec="utf-8"), max_size=20),
    st.binary(max_size=20),
    st.lists(st.booleans(), max_size=20).map(lambda bits: BitString(tuple(bits))),
)
VALUES = st.recursive(LEAVES, lambda inner: st.lists(inner, max_size=4).map(tuple), max_leaves=12)


@given(
    values=st.lists(VALUES, max_size=6).map(tuple), state=NUMBERS, sequence=NUMBERS, simulated=st.booleans()
)
def test_a_frame_comes_back_as_it_was(
    values: tuple[Value, ...], state: int, sequence: int, simulated: bool
) -> None:
    message = replace(MESSAGE, values=values, state_number=state, sequence_number=sequence)
    sent = replace(FRAME, message=message, simulated=simulated)
    assert decode_frame(encode_frame(sent)) == sent


@pytest.mark.parametrize("vlan", [None, 0, 4095])
def test_a_tag_of_a_virtual_lan_is_kept(vlan: int | None) -> None:
    assert decode_frame(encode_frame(replace(FRAME, vlan_id=vlan))).vlan_id == vlan


def message_of(frame: bytes) -> bytes:
    """The message of a frame without tag, by its length."""
    length = int.from_bytes(frame[ETHERNET + 2 : ETHERNET + 4], "big")
    return frame[ETHERNET + HEADER : ETHERNET + length]


def test_another_stack_reads_what_is_written() -> None:
    read = peer.decode_goose_pdu(message_of(encode_frame(FRAME)), strict=True)
    assert (read.gocb_ref, read.dat_set, read.go_id) == (
        MESSAGE.control_block,
        MESSAGE.data_set,
        MESSAGE.goose_id,
    )
    assert (read.st_num, read.sq_num, read.conf_rev) == (7, 1, 3)
    assert (read.time_allowed_to_live, read.num_dat_set_entries) == (3000, 2)
    assert read.all_data == [BoolData(False), IntData(5)]  # noqa: FBT003 - the value


def test_what_another_stack_writes_is_read() -> None:
    pdu = peer.encode_goose_pdu(peer.decode_goose_pdu(message_of(encode_frame(FRAME))))
    length = (HEADER + len(pdu)).to_bytes(2, "big")
    frame = encode_frame(FRAME)[: ETHERNET + 2] + length + bytes(4) + pdu
    assert decode_frame(frame).message == MESSAGE


@given(octets=st.binary(max_size=300))
def test_any_octets_are_a_frame_or_an_error(octets: bytes) -> None:
    for each in (octets, encode_frame(FRAME)[:14] + octets):
        try:
            found = decode_frame(each)
        except GooseFrameError as error:
            assert str(error)  # noqa: PT017 - the error is what is tried
        else:
            assert isinstance(found, GooseFrame)


@given(place=st.integers(14, 150), octet=st.integers(0, 255), cut=st.integers(0, 150))
def test_damaged_frames_are_a_frame_or_an_error(place: int, octet: int, cut: int) -> None:
    whole = bytearray(encode_frame(FRAME))
    whole[place % len(whole)] = octet
    for each in (bytes(whole), bytes(whole)[: len(whole) - cut]):
        try:
            decode_frame(each)
        except GooseFrameError:
            continue


def test_deep_structures_are_refused() -> None:
    value: Value = True
    for _ in range(40):
        value = (value,)
    with pytest.raises(GooseFrameError, match="deep"):
        decode_frame(encode_frame(replace(FRAME, message=replace(MESSAGE, values=(value,)))))


def test_what_no_frame_can_carry_is_not_written() -> None:
    for wrong in (
        replace(MESSAGE, state_number=2**32),
        replace(MESSAGE, control_block="x" * 200),
        replace(MESSAGE, values=(None,)),
    ):
        with pytest.raises(ValueError, match=r"expected|carries"):
            encode_frame(replace(FRAME, message=wrong))


def test_times_keep_their_quality() -> None:
    stamped = replace(MESSAGE, time=Timestamp(1_760_000_000_500_000_000, 0x4A))
    time = decode_frame(encode_frame(replace(FRAME, message=stamped))).message.time
    assert (time.quality, abs(time.ns - stamped.time.ns) < 1000) == (0x4A, True)

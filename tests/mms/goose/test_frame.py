"""Frames: what is encoded is decoded again, and whatever octets come, no other error than the typed one."""

from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mms.goose import GooseFrame, GooseFrameError, decode_frame, encode_frame
from mms.goose.data import DEEPEST
from mms.goose.message import decode_message
from mms.values import Value
from tests.mms.goose.blocks import frame, frames


@given(frames)
def test_a_frame_is_read_as_it_was_written(sent: GooseFrame) -> None:
    assert decode_frame(encode_frame(sent)) == sent


@given(st.binary(max_size=300))
def test_any_octets_give_a_frame_or_the_typed_error(octets: bytes) -> None:
    for tried in (octets, encode_frame(frame())[:14] + octets, encode_frame(frame())[:22] + octets):
        with suppress(GooseFrameError):
            decode_frame(tried)
    with suppress(GooseFrameError):
        decode_message(b"\x61" + bytes([min(len(octets), 127)]) + octets[:127])


@given(frames, st.data())
def test_damaged_frames_give_a_frame_or_the_typed_error(sent: GooseFrame, data: st.DataObject) -> None:
    octets = bytearray(encode_frame(sent))
    for _ in range(data.draw(st.integers(1, 4))):
        octets[data.draw(st.integers(0, len(octets) - 1))] = data.draw(st.integers(0, 255))
    cut = data.draw(st.integers(0, len(octets)))
    with suppress(GooseFrameError):
        decode_frame(bytes(octets[:cut]) if data.draw(st.booleans()) else bytes(octets))


def test_a_frame_that_is_cut_is_never_taken_for_a_whole_one() -> None:
    octets = encode_frame(frame())
    for size in range(len(octets)):
        with pytest.raises(GooseFrameError):
            decode_frame(octets[:size])


def test_padding_behind_the_message_does_not_count() -> None:
    assert decode_frame(encode_frame(frame()) + bytes(40)) == frame()


def test_an_error_says_where_and_what() -> None:
    octets = bytearray(encode_frame(frame()))
    octets[12:14] = b"\x08\x00"
    with pytest.raises(GooseFrameError, match="Ethertype: expected 0x88b8, found 0x0800"):
        decode_frame(bytes(octets))
    whole = encode_frame(frame(values=(True, 7)))
    with pytest.raises(
        GooseFrameError, match="allData: expected 3 values, as numDatSetEntries says, found 2"
    ):
        decode_frame(whole.replace(b"\x8a\x01\x02", b"\x8a\x01\x03"))


def test_structures_that_are_too_deep_are_refused() -> None:
    value: Value = True
    for _ in range(DEEPEST):
        value = (value,)
    assert decode_frame(encode_frame(frame(values=(value,)))).message.values == (value,)
    with pytest.raises(GooseFrameError, match="deep"):
        decode_frame(encode_frame(frame(values=((value,),))))


def test_a_field_twice_or_out_of_order_is_refused() -> None:
    whole = encode_frame(frame(goose_id=None))
    with pytest.raises(GooseFrameError, match="in order"):
        decode_frame(whole.replace(b"\x87\x01\x00", b"\x86\x01\x00"))


def test_what_no_frame_can_carry_is_not_written() -> None:
    for wrong in ({"state_number": 2**32}, {"control_block": "ä"}, {"values": (None,)}):
        with pytest.raises(ValueError, match=r".+"):
            encode_frame(frame(**wrong))

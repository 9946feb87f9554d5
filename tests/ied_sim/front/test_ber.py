"""Encoding rules of the front: what is read is written again, and nonsense is refused."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ied_sim.front.ber import Element, MalformedError, decode, encode
from ied_sim.front.transport import units_of

primitive = st.builds(Element, st.sampled_from([b"\x02", b"\x80", b"\x9f\x49"]), st.binary(max_size=300))
constructed = st.recursive(
    primitive,
    lambda inner: st.builds(
        lambda tag, parts: Element(tag, parts=parts),
        st.sampled_from([b"\x30", b"\xa0", b"\xbf\x4d"]),
        st.lists(inner, max_size=4),
    ),
    max_leaves=12,
)


@given(constructed)
def test_what_is_written_is_read_again(element: Element) -> None:
    assert decode(encode(element)) == element


@given(st.binary(max_size=60))
def test_any_octets_are_an_element_or_malformed(octets: bytes) -> None:
    try:
        element = decode(octets)
    except MalformedError:
        return
    assert decode(encode(element)) == element


def test_what_is_nested_without_end_is_malformed() -> None:
    with pytest.raises(MalformedError, match="nested"):
        decode(encode_nested(60))


def encode_nested(depth: int) -> bytes:
    octets = b""
    for _ in range(depth):
        octets = encode(Element(b"\x30", content=octets))
    return octets


@given(st.binary(min_size=1, max_size=500), st.integers(10, 200))
def test_data_units_hold_all_and_end_once(user_data: bytes, size: int) -> None:
    octets, found, ends = units_of(user_data, size), b"", []
    while octets:
        length = int.from_bytes(octets[2:4], "big")
        assert length <= 4 + size
        found += octets[7:length]
        ends.append(octets[6] == 0x80)
        octets = octets[length:]
    assert found == user_data
    assert ends == [False] * (len(ends) - 1) + [True]

"""Messages on their way through the front: what is to be changed is, and nothing else."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ied_sim.front.ber import Element, decode, encode
from ied_sim.front.rewriting import Rewriter
from ied_sim.misbehaviour import MisbehaviourState
from ied_sim.profiles.profile import Files

SESSION = bytes([1, 0, 1, 0])
RESPONSE = b"\xa1"
FILE_READ, FILE_DIRECTORY = b"\xbf\x49", b"\xbf\x4d"


def message(pdu: Element) -> bytes:
    """With presentation and session around it (ISO 8823, ISO 8327)."""
    values = Element(b"\x30", parts=[Element(b"\x02", b"\x03"), Element(b"\xa0", parts=[pdu])])
    return SESSION + encode(Element(b"\x61", parts=[values]))


def answer(service: Element, invoke_id: bytes = b"\x07") -> bytes:
    return message(Element(RESPONSE, parts=[Element(b"\x02", invoke_id), service]))


def listing(names: list[str], size: int = 1000) -> Element:
    entries = [
        Element(
            b"\x30",
            parts=[
                Element(b"\xa0", parts=[Element(b"\x19", name.encode())]),
                Element(b"\xa1", parts=[Element(b"\x80", size.to_bytes(3, "big"))]),
            ],
        )
        for name in names
    ]
    return Element(FILE_DIRECTORY, parts=[Element(b"\xa0", parts=[Element(b"\x30", parts=entries)])])


def names_in(user_data: bytes) -> list[str]:
    values = decode(user_data[len(SESSION) :]).parts
    assert values
    found, unseen = [], [values[0]]
    while unseen:
        element = unseen.pop(0)
        unseen = [*(element.parts or ()), *unseen]
        if element.tag == b"\x19":
            found.append(element.content.decode())
    return found


def rewriter(files: Files | None) -> Rewriter:
    return Rewriter(files, MisbehaviourState((), lambda: 0.0), {})


@pytest.mark.parametrize(
    ("files", "shown"),
    [
        (None, ["EVENTS/HR_1.CFG", "EVENTS/HR_1.DAT"]),
        (Files(separator="\\"), ["EVENTS\\HR_1.CFG", "EVENTS\\HR_1.DAT"]),
        (Files(listed="name"), ["HR_1.CFG", "HR_1.DAT"]),
        (Files(entries_per_listing=1), ["EVENTS/HR_1.CFG"]),
    ],
)
def test_listings_are_shown_as_the_profile_says_to_every_request(
    files: Files | None, shown: list[str]
) -> None:
    relay = rewriter(files)
    given = listing(["EVENTS/HR_1.CFG", "EVENTS/HR_1.DAT"])
    for invoke_id in (b"\x07", b"\x01\x00"):
        rewritten = relay.response(answer(given, invoke_id)).user_data
        assert names_in(rewritten) == shown
        assert encode(Element(b"\x02", invoke_id)) in rewritten
    assert names_in(relay.response(answer(listing(["EVENTS/HR_2.CFG"]))).user_data)[0].endswith("HR_2.CFG")


@given(st.binary(max_size=70_000))
def test_file_data_pass_unchanged_and_are_counted(data: bytes) -> None:
    read = answer(Element(FILE_READ, parts=[Element(b"\x80", data), Element(b"\x81", b"\xff")]))
    rewritten = rewriter(Files()).response(read)
    assert rewritten.user_data == read
    assert rewritten.file_bytes == len(data)


@given(st.integers(0, 200), st.integers(0, 255))
def test_what_is_spoilt_ends_nothing(place: int, octet: int) -> None:
    spoilt = bytearray(answer(listing(["EVENTS/HR_1.CFG"])))
    spoilt[len(SESSION) + place % (len(spoilt) - len(SESSION))] = octet
    assert rewriter(Files(separator="\\")).response(bytes(spoilt)).user_data.startswith(SESSION)


@given(st.binary(max_size=80), st.sampled_from([b"", SESSION]))
def test_what_is_no_message_passes_unchanged(octets: bytes, before: bytes) -> None:
    assert rewriter(Files()).response(before + octets).user_data == before + octets
    assert rewriter(Files()).request(before + octets) == before + octets

"""Browsing a relay and reading its data."""

from collections.abc import Iterator

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mms import (
    GOOD,
    AccessDenied,
    BitString,
    Client,
    DataAccessError,
    FunctionalConstraint,
    MmsError,
    NotFound,
    Quality,
    Server,
    Timestamp,
    Validity,
    Value,
)
from testing.ports import LOOPBACK
from testing.relays.serving import start_relay

ST, MX = FunctionalConstraint.ST, FunctionalConstraint.MX


def test_the_relay_is_browsed_from_device_to_object(client: Client) -> None:
    assert client.logical_devices() == ["T1CON", "T1PRO"]
    assert client.logical_nodes("T1PRO") == ["GGIO1", "LLN0"]
    assert set(client.data_objects("T1PRO/GGIO1")) == {
        "AnIn1", "Ind01", "Ind02", "Ind03", "Ind04", "NamPlt", "Setting", "Types",
    }  # fmt: skip
    assert client.data_sets("T1PRO/LLN0") == ["DSet01", "DSet02"]
    assert client.buffered_reports("T1PRO/LLN0") == ["BRep01", "BRep02"]
    assert client.unbuffered_reports("T1PRO/LLN0") == ["Twin01", "Twin02", "URep01"]


def test_unknown_names_are_not_found(client: Client) -> None:
    with pytest.raises(NotFound):
        client.logical_nodes("T1NONE")
    with pytest.raises(NotFound, match=r"read T1PRO/GGIO1\.Ind99\[ST\]"):
        client.read("T1PRO/GGIO1.Ind99", ST)
    with pytest.raises(NotFound):
        client.read("T1NONE/GGIO1.Ind01", ST)
    with pytest.raises(MmsError):
        client.read_data_set("T1PRO/LLN0.DSet99")


@pytest.mark.parametrize(
    "reference",
    ["", "garbage", "T1PRO", "T1PRO/", "/GGIO1", "T1PRO/GGIO1..x", "T1PRO/GGIO1.\0", "T1PRO/" + "x" * 500,
     "x" * 65 + "/LLN0", "T1PRO/GGIO1.Ind01;", "T1PRO/GGIO1.é"],
)  # fmt: skip
def test_a_malformed_reference_never_reaches_the_wire(client: Client, reference: str) -> None:
    with pytest.raises(ValueError, match="reference"):
        client.read(reference, ST)


def test_a_structure_is_a_tuple_with_time_and_quality(relay: Server, client: Client) -> None:
    now = Timestamp(1_700_000_000_250_000_000, quality=0x2A)
    relay.update_many({
        "T1PRO/GGIO1.AnIn1.mag.f": 12.5,
        "T1PRO/GGIO1.AnIn1.q": Quality(Validity.QUESTIONABLE, old_data=True),
        "T1PRO/GGIO1.AnIn1.t": now,
    })  # fmt: skip
    measured = client.read("T1PRO/GGIO1.AnIn1", MX)
    assert isinstance(measured, tuple)
    magnitude, quality, time = measured
    assert magnitude == (12.5,)
    assert isinstance(quality, BitString)
    assert Quality.of(quality) == Quality(Validity.QUESTIONABLE, old_data=True)
    assert time == now
    assert now.clock_not_synchronised
    assert not now.clock_failure
    assert not now.leap_seconds_known


def test_a_data_set_is_read_in_one_request_with_its_members_named(relay: Server, client: Client) -> None:
    assert client.data_set_directory("T1PRO/LLN0.DSet02") == (
        "T1PRO/GGIO1.Ind01.stVal[ST]",
        "T1PRO/GGIO1.AnIn1[MX]",
    )
    relay.update("T1PRO/GGIO1.Ind01.stVal", value=True)
    first, second = client.read_data_set("T1PRO/LLN0.DSet02")
    assert (first.reference, first.value) == ("T1PRO/GGIO1.Ind01.stVal[ST]", True)
    assert second.reference == "T1PRO/GGIO1.AnIn1[MX]"
    assert second.value == ((0.0,), GOOD.bits, Timestamp(0, 0))


def test_the_name_plate_keeps_its_initial_text(client: Client) -> None:
    assert client.read("T1PRO/GGIO1.NamPlt.d", FunctionalConstraint.DC) == "Feeder 1"


@pytest.fixture(scope="module")
def shared() -> Iterator[tuple[Server, Client]]:
    with start_relay() as server, Client.connect(LOOPBACK, server.port, request_timeout_s=10.0) as client:
        yield server, client


def _integers(bits: int, *, signed: bool = True) -> st.SearchStrategy[int]:
    return st.integers(-(1 << bits - 1), (1 << bits - 1) - 1) if signed else st.integers(0, (1 << bits) - 1)


def _visible(octets: int) -> st.SearchStrategy[str]:
    return st.text(st.characters(min_codepoint=32, max_codepoint=126), max_size=octets)


_UNICODE = st.text(st.characters(codec="utf-8", exclude_characters="\0"), max_size=255).filter(
    lambda text: len(text.encode()) <= 255
)
_TIMES = st.builds(
    lambda seconds, fraction, quality: Timestamp.of(
        seconds.to_bytes(4, "big") + fraction.to_bytes(3, "big") + bytes([quality])
    ),
    st.integers(0, (1 << 32) - 1),
    st.integers(0, (1 << 24) - 1),
    st.integers(0, 255),
)
_QUALITIES = st.builds(BitString, st.tuples(*[st.booleans()] * 13))
_FLOATS_32 = st.floats(width=32, allow_nan=False)

ROUND_TRIPS: dict[str, st.SearchStrategy[Value]] = {
    "bool": st.booleans(),
    "int8": _integers(8),
    "int16": _integers(16),
    "int32": _integers(32),
    "int64": _integers(64),
    "uint8": _integers(8, signed=False),
    "uint16": _integers(16, signed=False),
    "uint24": _integers(24, signed=False),
    "uint32": _integers(32, signed=False),
    "float32": _FLOATS_32,
    "float64": st.floats(allow_nan=False),
    "enum": _integers(8),
    "octets64": st.binary(max_size=64),
    "octets6": st.binary(min_size=6, max_size=6),
    "octets8": st.binary(min_size=8, max_size=8),
    "visible32": _visible(32),
    "visible64": _visible(64),
    "visible65": _visible(65),
    "visible129": _visible(129),
    "visible255": _visible(255),
    "unicode255": _UNICODE,
    "time": _TIMES,
    "quality": _QUALITIES,
    "dbpos": st.builds(BitString, st.tuples(st.booleans(), st.booleans())),
    "entryTime": st.integers(441_763_200_000, 4_000_000_000_000).map(lambda ms: Timestamp(ms * 1_000_000, 0)),
}


@pytest.mark.parametrize("name", ROUND_TRIPS)
def test_every_value_survives_from_server_to_client(shared: tuple[Server, Client], name: str) -> None:
    server, client = shared
    reference = f"T1PRO/GGIO1.Types.{name}"

    @settings(max_examples=25, deadline=None)
    @given(value=ROUND_TRIPS[name])
    def survives(value: Value) -> None:
        server.update(reference, value)
        assert client.read(reference, ST) == value
        assert server.read(reference) == value

    survives()


def test_all_types_are_read_at_once(shared: tuple[Server, Client]) -> None:
    _, client = shared
    values = client.read("T1PRO/GGIO1.Types", ST)
    assert isinstance(values, tuple)
    assert len(values) == len(ROUND_TRIPS)
    assert DataAccessError.UNKNOWN not in values


def test_access_to_what_is_no_data_is_refused_in_words(client: Client) -> None:
    with pytest.raises((AccessDenied, NotFound)):
        client.read("T1PRO/GGIO1.Ind01.stVal", FunctionalConstraint.SP)


def test_several_values_come_with_one_request(client: Client) -> None:
    references = ["T1PRO/GGIO1.Ind01.stVal", "T1PRO/GGIO1.Ind99.stVal", "T1PRO/GGIO1.Ind02.stVal"]
    first, missing, last = client.read_together(references, ST)
    assert [first, last] == [client.read(one, ST) for one in (references[0], references[2])]
    assert isinstance(missing, NotFound)
    assert "read T1PRO/GGIO1.Ind99.stVal[ST]" in str(missing)
    assert client.read_together(references[:1], ST) == (first,)
    (alone,) = client.read_together(references[1:2], ST)
    assert isinstance(alone, NotFound)


def test_values_of_several_devices_none_or_too_many_are_no_request(client: Client) -> None:
    for references in ([], ["T1PRO/GGIO1.Ind01.stVal", "T1CON/GGIO1.Ind01.stVal"]):
        with pytest.raises(ValueError, match="one logical device"):
            client.read_together(references, ST)
    with pytest.raises(ValueError, match="at most 64"):
        client.read_together(["T1PRO/GGIO1.Ind01.stVal"] * 65, ST)

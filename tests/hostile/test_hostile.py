"""A short campaign; the long one is python -m tests.hostile."""

import asyncio
import io
import time
from pathlib import Path
from random import Random

import pytest

from mms import AssociationBroken, Client, ClientLimits, FileSizeMismatch, ProtocolError, Timeout
from testing.ports import LOOPBACK
from tests.hostile import bulk, crafted, spoiling
from tests.hostile.dialogue import CON, PRO, Dialogue, overheard, tlv
from tests.hostile.relay import HostileRelay, lying
from tests.hostile.surroundings import Snapshot, strangers

CASES = 300
MOST_MEMORY_MB = 400.0

pytestmark = pytest.mark.timeout(300)


@pytest.fixture(scope="module")
def dialogue() -> Dialogue:
    return overheard()


def test_a_dialogue_has_every_service(dialogue: Dialogue) -> None:
    services = {
        b"\xa1",
        b"\xa4",
        b"\xa5",
        b"\xa6",
        b"\xac",
        b"\xbf\x4d",
        b"\xbf\x48",
        b"\x9f\x49",
        b"\x9f\x4a",
    }
    assert services <= dialogue.latest.keys()
    assert len(dialogue.handshake) == 2
    assert dialogue.reports


def test_nothing_a_relay_answers_is_more_than_an_error(dialogue: Dialogue, tmp_path: Path) -> None:
    (tmp_path / "x.CFG").write_text("canary")
    before = Snapshot.of(tmp_path, without=tmp_path / "clients")

    async def campaign() -> bulk.Outcome:
        relay = HostileRelay(dialogue, seed=1)
        await relay.start()
        outcome = await bulk.run(relay, CASES, processes=3, directory=tmp_path / "clients")
        await relay.stop()
        assert relay.cases >= CASES
        return outcome

    outcome = asyncio.run(campaign())
    assert outcome.untyped == {}
    assert not outcome.stalled
    assert 0 < outcome.most_memory_MB < MOST_MEMORY_MB
    assert before.changed(Snapshot.of(tmp_path, without=tmp_path / "clients")) == []
    for client in (tmp_path / "clients").iterdir():
        assert strangers(client) == []


def test_a_million_files_are_too_many(dialogue: Dialogue) -> None:
    def endless(number: int) -> bytes:
        entries = b"".join(
            tlv(
                0x30,
                tlv(0xA0, tlv(0x19, b"HR_%09d.CFG" % (number * 500 + k))) + tlv(0xA1, tlv(0x80, b"\x01")),
            )
            for k in range(500)
        )
        content = tlv(0xA0, tlv(0x30, entries)) + tlv(0x81, b"\xff")
        return crafted.FILE_DIRECTORY + tlv(0x30, content)[1:]

    with (
        lying(dialogue, {crafted.FILE_DIRECTORY: endless}) as port,
        Client.connect(LOOPBACK, port, limits=ClientLimits(listed_files=5_000)) as client,
    ):
        with pytest.raises(ProtocolError, match="never ends"):
            client.files("EVENTS")
        assert client.logical_devices(), "the association stands"


def test_a_file_without_end_is_left_at_its_listed_size(dialogue: Dialogue) -> None:
    def endless(_number: int) -> bytes:
        content = tlv(0x80, bytes(50_000)) + tlv(0x81, b"\xff")
        return b"\xbf\x49" + tlv(0x30, content)[1:]

    with lying(dialogue, {crafted.FILE_READ: endless}) as port, Client.connect(LOOPBACK, port) as client:
        with pytest.raises(FileSizeMismatch) as caught:
            client.download("EVENTS/HR_10001.DAT", io.BytesIO(), expected_size=120_000)
        assert caught.value.received <= 170_000


def test_a_member_that_is_none_is_an_error(dialogue: Dialogue) -> None:
    """The library's own function for it follows a null pointer."""
    good = dialogue.latest[b"\xac"]
    assert b"GGIO1$ST$Ind" in good
    spoilt = good.replace(b"GGIO1$ST$Ind", b"GGIO1_ST_Ind")
    with (
        lying(dialogue, {b"\xac": lambda _: spoilt}) as port,
        Client.connect(LOOPBACK, port) as client,
        pytest.raises(ProtocolError, match="not a member of a data set: b'GGIO1_ST_Ind"),
    ):
        client.data_set_directory(f"{PRO}/LLN0.DSet01")


def test_a_control_is_operated_though_its_description_came_too_late_at_first(dialogue: Dialogue) -> None:
    asked = 0

    def late(_number: int) -> bytes:
        nonlocal asked
        asked += 1
        if asked == 1:
            time.sleep(1.2)
        return dialogue.latest[b"\xa6"]

    with (
        lying(dialogue, {b"\xa6": late}) as port,
        Client.connect(LOOPBACK, port, request_timeout_s=1.0) as client,
    ):
        client.operate(f"{CON}/RBGGIO1.SPCSO02", value=True)
    assert asked == 2


def test_a_control_whose_description_never_comes_in_time_is_late_not_missing(dialogue: Dialogue) -> None:
    def late(_number: int) -> bytes:
        time.sleep(0.8)
        return dialogue.latest[b"\xa6"]

    with (
        lying(dialogue, {b"\xa6": late}) as port,
        Client.connect(LOOPBACK, port, request_timeout_s=0.5) as client,
        pytest.raises(Timeout),
    ):
        client.operate(f"{CON}/RBGGIO1.SPCSO02", value=True)


@pytest.mark.parametrize("lie", [b"\xa1\x00", b"\xa1\x02\x05\x00", b"\xa1\x02\x30\x00"])
def test_who_answers_the_first_request_with_nonsense_broke_the_protocol(
    dialogue: Dialogue, lie: bytes
) -> None:
    with (
        lying(dialogue, {b"\xa1": lambda _: lie}) as port,
        pytest.raises(AssociationBroken, match="malformed"),
    ):
        Client.connect(LOOPBACK, port)


def test_a_spoilt_answer_can_be_made_again(dialogue: Dialogue) -> None:
    good = dialogue.latest[b"\xa4"]
    for spoiler in spoiling.OF_MESSAGES:
        assert spoiler(Random(3), good) == spoiler(Random(3), good)
    assert crafted.listing(Random(5)) == crafted.listing(Random(5))

"""What messages of a relay mean, without a network."""

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree
from structlog.testing import capture_logs

import scl
from mms import BitString, Quality, Timestamp, Validity, Value
from mms.goose import GooseFrame, GooseMessage, encode_frame
from mms.goose.subscription import LONGEST_CAP_S
from service.configuration.gateways.goose import GooseSettings, GooseTrigger
from service.gateways.goose.listener import GooseListener
from service.gateways.goose.signals import Meaning, SignalError, WatchedBlock, watched_blocks
from tests.service.gateways.goose.plant import SCD, changed_scd, relays_of_motors

SclAndRelays = tuple[scl.Scl, dict[str, str]]
"""And the relay of each motor."""

NOW_NS = 1_760_000_000 * 10**9
TRIP = "A1_SEL710PRO/TRIPPTRC1.Tr"
JAM = "A1_SEL710PRO/JAMPTOC1.Op.general"
GOOD, BAD = Quality().bits, Quality(validity=Validity.INVALID).bits
MESSAGE = GooseMessage(
    control_block="A1_SEL710CFG/LLN0$GO$GPub01",
    time_allowed_to_live_ms=2000,
    data_set="A1_SEL710CFG/LLN0$DSet04",
    goose_id="A1_SEL710",
    time=Timestamp(NOW_NS),
    state_number=1,
    sequence_number=0,
    simulation=False,
    configuration_revision=1,
    needs_commissioning=False,
    values=(),
)


@pytest.fixture(scope="module")
def plant(tmp_path_factory: pytest.TempPathFactory) -> SclAndRelays:
    return scl.read(SCD), relays_of_motors(tmp_path_factory.mktemp("plant"))


def blocks(plant: SclAndRelays, *triggers: GooseTrigger, trips: bool = True) -> tuple[WatchedBlock, ...]:
    return watched_blocks(GooseSettings(interface="eth1", triggers=triggers, trips=trips), *plant)


def frame(*, trip: bool = False, jam: bool = False, quality: BitString = GOOD, **changes: object) -> bytes:
    off: Value = (False, GOOD, Timestamp(NOW_NS))
    values = ((trip, quality, Timestamp(NOW_NS)), off, off, (jam, GOOD, Timestamp(NOW_NS)), *(off,) * 5)
    message = replace(MESSAGE, **{"values": values} | changes)  # type: ignore[arg-type] # fields by name
    return encode_frame(GooseFrame(bytes.fromhex("010ccd010000"), bytes(6), 1, message))


def test_every_relay_of_a_motor_is_watched_for_its_trip(plant: SclAndRelays) -> None:
    found = blocks(plant)
    assert len(found) == 6
    (signal,) = found[0].signals
    assert (signal.reference, signal.meaning, signal.motors) == (
        f"{TRIP}.general",
        Meaning.TRIP,
        ("PUMP-A1",),
    )
    assert found[0].subscribed.destination == bytes.fromhex("010ccd010000")


def test_a_trip_is_told_once_and_its_end_too(plant: SclAndRelays) -> None:
    listener = GooseListener(blocks(plant))
    told = [
        [(change.signal.meaning, change.is_on, change.time_ns) for change in listener.receive(octets, now_s)]
        for now_s, octets in (
            (0.0, frame()),
            (0.1, frame(trip=True, state_number=2)),
            (0.2, frame(trip=True, state_number=2, sequence_number=1)),
            (0.3, frame(state_number=3)),
        )
    ]
    trip = Meaning.TRIP
    assert told == [[(trip, False, NOW_NS)], [(trip, True, NOW_NS)], [], [(trip, False, NOW_NS)]]


def test_what_is_not_of_the_relay_as_configured_changes_nothing(plant: SclAndRelays) -> None:
    listener = GooseListener(blocks(plant))
    assert listener.receive(frame(state_number=5), 0.0)
    questionable = Quality(validity=Validity.QUESTIONABLE).bits
    for octets in (
        frame(trip=True, state_number=4),  # replayed
        frame(trip=True, state_number=6, configuration_revision=4),
        frame(trip=True, state_number=6, simulation=True),
        frame(trip=True, state_number=6, needs_commissioning=True),
        frame(trip=True, state_number=6, quality=questionable),
        frame(trip=True, state_number=7, quality=Quality(test=True).bits),
        frame(trip=True, state_number=8, quality=BitString(())),
    ):
        assert listener.receive(octets, 0.1) == []
    assert [change.is_on for change in listener.receive(frame(trip=True, state_number=9), 0.2)] == [True]


def test_a_trip_that_stands_when_it_begins_to_listen_is_told_and_an_old_trigger_is_not(
    plant: SclAndRelays,
) -> None:
    listener = GooseListener(blocks(plant, GooseTrigger(signal=JAM)))
    told = listener.receive(frame(trip=True, jam=True, state_number=7, sequence_number=40), 0.0)
    assert [change.signal.meaning for change in told] == [Meaning.TRIP]
    told = listener.receive(frame(trip=True, state_number=8), 0.1)
    told += listener.receive(frame(trip=True, jam=True, state_number=9), 0.2)
    assert [(change.signal.meaning, change.is_on) for change in told] == [
        (Meaning.TRIGGER, False),
        (Meaning.TRIGGER, True),
    ]


def test_a_block_that_falls_silent_is_named_with_the_reason(plant: SclAndRelays) -> None:
    listener = GooseListener(blocks(plant)[:1])
    told = [listener.problem]
    listener.receive(frame(), 0.0)
    told.append(listener.problem)
    listener.expire(2.1)
    listener.receive(frame(configuration_revision=9), 2.2)
    told.append(listener.problem)
    silent = f"1 of 1 GOOSE control blocks are not heard: {MESSAGE.control_block}"
    assert told == [silent, None, f"{silent} (another confRev than configured)"]


def test_a_forged_frame_silences_a_trip_for_a_few_seconds_and_is_told_meanwhile(plant: SclAndRelays) -> None:
    """The SCD says MaxTime 1 s: no state lives for more than 4 s."""
    listener = GooseListener(blocks(plant)[:1])
    listener.receive(frame(), 0.0)
    listener.receive(frame(state_number=10**9, time_allowed_to_live_ms=600_000), 0.1)
    told_s, problems = [], []
    for number in range(12):
        now_s = 0.5 + number
        told = listener.receive(frame(trip=True, state_number=2, sequence_number=number), now_s)
        told_s += [now_s for change in told if change.is_on]
        listener.expire(now_s)
        problems.append(listener.problem)
    assert told_s == [4.5]
    named = (
        "1 of 1 GOOSE control blocks are told in two states at once, and one of them is ignored as a replay: "
        f"{MESSAGE.control_block}"
    )
    assert problems == [None, *[named] * 6, *[None] * 5]


def test_missed_states_are_logged_once_a_minute(plant: SclAndRelays) -> None:
    listener = GooseListener(blocks(plant)[:1])
    with capture_logs() as logged:
        for number in range(100):
            listener.receive(frame(state_number=1 + 3 * number), number)
    assert [one["states"] for one in logged if one["event"] == "GOOSE states were missed"] == [2, 120]


def test_a_trigger_of_a_relay_without_motors_names_them(plant: SclAndRelays) -> None:
    document, relays = plant
    alone = {motor: relay for motor, relay in relays.items() if relay != "A1_SEL710"}
    with pytest.raises(SignalError, match="expected motors, found none"):
        blocks((document, alone), GooseTrigger(signal=JAM))
    (watched,) = blocks((document, alone), GooseTrigger(signal=JAM, motors=("FAN-A2",)), trips=False)
    assert [signal.motors for signal in watched.signals] == [("FAN-A2",)]


def test_an_scd_without_goose_is_refused(tmp_path: Path) -> None:
    def without(element: etree._Element, parent: etree._Element) -> None:
        if etree.QName(element).localname == "GSEControl":
            parent.remove(element)

    document = changed_scd(tmp_path / "plant.scd", without)
    with pytest.raises(SignalError, match=r"expected GOOSE control blocks \(GSEControl\)"):
        watched_blocks(GooseSettings(interface="eth1"), document, {"P": "A1_SEL710"})


def test_the_quality_may_be_a_member_of_its_own(tmp_path: Path) -> None:
    attributes = iter(("general", "t", "q"))

    def apart(element: etree._Element, parent: etree._Element) -> None:
        """Let the first three members be parts of the first, and drop the others."""
        if etree.QName(element).localname == "FCDA" and parent.get("name") == "DSet04":
            attribute = next(attributes, None)
            if attribute is None:
                parent.remove(element)
            else:
                element.attrib.update(
                    {"prefix": "TRIP", "lnClass": "PTRC", "lnInst": "1", "doName": "Tr", "daName": attribute}
                )

    document = changed_scd(tmp_path / "plant.scd", apart)
    listener = GooseListener(watched_blocks(GooseSettings(interface="eth1"), document, {"P": "A1_SEL710"}))
    told = []
    for number, (trip, quality) in enumerate(((False, GOOD), (True, BAD), (True, GOOD)), start=1):
        values = (trip, Timestamp(NOW_NS), quality)
        changes = listener.receive(frame(values=values, state_number=number), 0.0)
        told.append([(change.signal.reference, change.is_on) for change in changes])
    assert told == [[(f"{TRIP}.general", False)], [], [(f"{TRIP}.general", True)]]


def test_a_trip_is_told_by_the_class_of_its_node_and_not_by_its_name(tmp_path: Path) -> None:
    def renamed(element: etree._Element, _parent: etree._Element) -> None:
        """Let another class have the letters of a trip's in its prefix."""
        if element.get("lnClass") == "PTRC":
            element.attrib.update({"prefix": "PTRC", "lnClass": "PTOC", "lnInst": "9"})

    document = changed_scd(tmp_path / "plant.scd", renamed)
    with pytest.raises(SignalError, match=r"with the trip \(PTRC.Tr\) of a motor's relay"):
        watched_blocks(GooseSettings(interface="eth1"), document, {"P": "A1_SEL710"})


@given(place=st.integers(0, 200), octet=st.integers(0, 255), cut=st.integers(0, 300))
def test_garbled_frames_raise_nothing(plant: SclAndRelays, place: int, octet: int, cut: int) -> None:
    listener = GooseListener(blocks(plant)[:1])
    octets = bytearray(frame(trip=True))
    octets[place % len(octets)] = octet
    listener.receive(bytes(octets[: cut or None]), 0.0)
    # It goes on to hear the relay, once what the frame promised is over.
    listener.receive(frame(state_number=1), LONGEST_CAP_S + 1)
    told = listener.receive(frame(trip=True, state_number=2), LONGEST_CAP_S + 1)
    assert [change.is_on for change in told] == [True]

"""Which GOOSE control blocks of the SCL tell of trips, or of what is to be recorded, and where in them."""

from collections.abc import Container, Iterable, Iterator, Mapping
from dataclasses import dataclass
from enum import Enum

from mms import BitString, Quality, Validity, Value
from mms.goose import SubscribedBlock
from scl import Scl
from scl.data_model import DataAttribute, DataObject
from scl.goose_blocks import GooseBlock, GooseMember, goose_blocks
from service.configuration.gateways.goose import GooseSettings

TRIP_CLASS, TRIP_OBJECT = "PTRC", "Tr"
_STATES = ("general", "stVal")
"""What of a data object tells whether it is on."""
_QUALITY_BITS = 13


class Meaning(Enum):
    """What it means that a signal rises."""

    TRIP = "trip"
    TRIGGER = "trigger"


Place = tuple[int, ...]
"""Where a value stands in a message: the member's number, and what it has below that."""


@dataclass(frozen=True, slots=True)
class Signal:
    """A Boolean in the messages of a control block.

    motors: those it is about.  state: its place.  quality: that of its quality; None where none is sent.
    """

    reference: str
    meaning: Meaning
    motors: tuple[str, ...]
    state: Place
    quality: Place | None = None

    def value(self, values: tuple[Value, ...]) -> bool | None:
        """Return whether it is on; None where the message does not tell, or its quality is bad."""
        state = _at(values, self.state)
        if self.quality is not None and not _is_usable(_at(values, self.quality)):
            return None
        return state if isinstance(state, bool) else None


@dataclass(frozen=True, slots=True)
class WatchedBlock:
    """A control block with the signals that are looked for in it."""

    subscribed: SubscribedBlock
    signals: tuple[Signal, ...]


class SignalError(Exception):
    """The settings or the SCL do not fit what is asked; the message says what to do."""


def watched_blocks(
    settings: GooseSettings, document: Scl, relays: Mapping[str, str]
) -> tuple[WatchedBlock, ...]:
    """Return the control blocks to subscribe to. relays: that of each motor.

    Raises SignalError: a trigger's signal is in no block, a motor is not known, or there is no block at all.
    """
    motors_of: dict[str, tuple[str, ...]] = {}
    for motor, relay in relays.items():
        motors_of[relay] = (*motors_of.get(relay, ()), motor)
    wanted = _triggers(settings, relays)
    found, seen = [], set[str]()
    for ied in document.ieds:
        own = motors_of.get(ied.name, ())
        for block in goose_blocks(ied):
            signals = tuple(_signals(block, own, wanted, trips=settings.trips))
            if signals and block.control.address is None:
                raise SignalError(
                    f"{block.reference}: expected its MAC-Address in the SCD's Communication section (GSE), "
                    "found none"
                )
            if signals:
                found.append(WatchedBlock(_subscribed(block), signals))
                seen |= {signal.reference for signal in signals if signal.meaning is Meaning.TRIGGER}
    missing = sorted(wanted.keys() - seen)
    if missing:
        raise SignalError(
            f"gateways.goose.triggers: expected Booleans that the GOOSE control blocks (GSEControl) of the "
            f"SCD send, found {', '.join(missing)} in none"
        )
    if not found:
        raise SignalError(
            "gateways.goose: expected GOOSE control blocks (GSEControl) with the trip (PTRC.Tr) of a motor's "
            "relay in the SCD, found none"
        )
    return tuple(found)


def _triggers(settings: GooseSettings, motors: Container[str]) -> Mapping[str, tuple[str, ...]]:
    for trigger in settings.triggers:
        unknown = [name for name in trigger.motors if name not in motors]
        if unknown:
            raise SignalError(
                f"gateways.goose.triggers {trigger.signal}: expected motors of the plant, found "
                f"{', '.join(unknown)}"
            )
    return {trigger.signal: trigger.motors for trigger in settings.triggers}


def _signals(
    block: GooseBlock, own: tuple[str, ...], wanted: Mapping[str, tuple[str, ...]], *, trips: bool
) -> Iterator[Signal]:
    """Yield what is looked for in a block. own: motors of the relay that sends it."""
    for number, member in enumerate(block.members):
        located = _located(block, number)
        if located is None:
            continue
        reference, state, quality = located
        names = {reference, member.member.reference}
        for name in sorted(names & wanted.keys()):
            motors = wanted[name] or own
            if not motors:
                raise SignalError(
                    f"gateways.goose.triggers {name}: expected motors, found none, and its relay has none"
                )
            yield Signal(name, Meaning.TRIGGER, motors, state, quality)
        if trips and own and _is_trip(member):
            yield Signal(reference, Meaning.TRIP, own, state, quality)


def _located(block: GooseBlock, number: int) -> tuple[str, Place, Place | None] | None:
    """Return the reference of a member's Boolean, and the places of it and of its quality."""
    member = block.members[number]
    if isinstance(member.data, DataAttribute):
        is_boolean = member.data.basic_type == "BOOLEAN" and not member.data.count
        return (member.member.reference, (number,), _quality_beside(block, member)) if is_boolean else None
    # Sub-objects stand among the attributes in an order that the model does not keep.
    if member.data is None or member.data.objects or member.data.count:
        return None
    return _located_in(member.data, member, number)


def _located_in(data: DataObject, member: GooseMember, number: int) -> tuple[str, Place, Place | None] | None:
    sent = [attribute for attribute in data.attributes if attribute.fc is member.member.fc]
    names = [attribute.name for attribute in sent]
    for name in _STATES:
        if name in names and sent[names.index(name)].basic_type == "BOOLEAN":
            quality = (number, names.index("q")) if "q" in names else None
            return f"{member.member.reference}.{name}", (number, names.index(name)), quality
    return None


def _quality_beside(block: GooseBlock, member: GooseMember) -> Place | None:
    """Return the place of the quality of an attribute, which is a member of its own."""
    wanted = f"{member.member.reference.rpartition('.')[0]}.q"
    numbers = (number for number, one in enumerate(block.members) if one.member.reference == wanted)
    found = next(numbers, None)
    return None if found is None else (found,)


def _is_trip(member: GooseMember) -> bool:
    path = member.member.path.split(".")
    return member.ln_class == TRIP_CLASS and path[0] == TRIP_OBJECT and path[1:] in ([], ["general"])


def _at(values: tuple[Value, ...], place: Place) -> Value | None:
    """Return the value at a place; None where the message has none there."""
    found: Value = values
    for number in place:
        if not isinstance(found, tuple) or len(found) <= number:
            return None
        found = found[number]
    return found


def _is_usable(quality: Value | None) -> bool:
    """Tell whether a quality is good, and not that of a test."""
    if not isinstance(quality, BitString) or len(quality.bits) != _QUALITY_BITS:
        return False
    told = Quality.of(quality)
    return told.validity is Validity.GOOD and not told.test


def _subscribed(block: GooseBlock) -> SubscribedBlock:
    address = block.control.address
    assert address is not None  # noqa: S101 - it was looked for
    return SubscribedBlock(
        reference=block.reference,
        data_set=block.data_set,
        goose_id=block.control.application_id,
        configuration_revision=block.control.configuration_revision,
        entries=len(block.members),
        destination=address.mac,
        application_id=address.application_id,
        maximum_time_ms=address.maximum_time_ms,
    )


def destinations(blocks: Iterable[WatchedBlock]) -> list[bytes]:
    """Return the multicast addresses of the blocks."""
    return sorted({block.subscribed.destination for block in blocks})

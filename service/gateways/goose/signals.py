"""Which GOOSE control blocks of the SCL tell of trips, or of what is to be recorded, and where in them."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum

from mms import BitString, Quality, Validity, Value
from mms.goose import SubscribedBlock
from scl import Scl
from scl.data_model import DataAttribute, DataObject
from scl.goose_blocks import GooseBlock, GooseMember, goose_blocks
from service.configuration.gateways.goose import GooseSettings
from service.plant import Plant

TRIP_CLASS, TRIP_OBJECT = "PTRC", "Tr"
_STATES = ("general", "stVal")
"""What of a data object tells whether it is on."""
_QUALITY_BITS = 13


class Meaning(Enum):
    """What it means that a signal rises."""

    TRIP = "trip"
    TRIGGER = "trigger"


@dataclass(frozen=True, slots=True)
class Signal:
    """A Boolean in the messages of a control block.

    place: of its member in the data set.  state, quality: their places in the member's structure; state is
    None where the member is the Boolean itself, and quality where it has none.
    """

    reference: str
    meaning: Meaning
    motors: tuple[str, ...]
    place: int
    state: int | None = None
    quality: int | None = None

    def value(self, values: Sequence[Value]) -> bool | None:
        """Return whether it is on; None where the message does not tell, or its quality is bad."""
        member = values[self.place]
        if self.state is None:
            return member if isinstance(member, bool) else None
        if not isinstance(member, tuple) or len(member) <= max(self.state, self.quality or 0):
            return None
        state = member[self.state]
        if self.quality is not None and not _is_usable(member[self.quality]):
            return None
        return state if isinstance(state, bool) else None


@dataclass(frozen=True, slots=True)
class WatchedBlock:
    """A control block with the signals that are looked for in it."""

    subscribed: SubscribedBlock
    signals: tuple[Signal, ...]


class SignalError(Exception):
    """The settings or the SCL do not fit what is asked; the message says what to do."""


def watched_blocks(settings: GooseSettings, document: Scl, plant: Plant) -> tuple[WatchedBlock, ...]:
    """Return the control blocks to subscribe to.

    Raises SignalError: a trigger's signal is in no block, a motor is not known, or there is no block at all.
    """
    motors_of = _motors_of_relays(plant)
    wanted = _triggers(settings, plant)
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


def _motors_of_relays(plant: Plant) -> Mapping[str, tuple[str, ...]]:
    found: dict[str, tuple[str, ...]] = {}
    for motor in plant.motors:
        found[motor.relay] = (*found.get(motor.relay, ()), motor.name)
    return found


def _triggers(settings: GooseSettings, plant: Plant) -> Mapping[str, tuple[str, ...]]:
    known = {motor.name for motor in plant.motors}
    for trigger in settings.triggers:
        unknown = [name for name in trigger.motors if name not in known]
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
    for place, member in enumerate(block.members):
        located = _located(member)
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
            yield Signal(name, Meaning.TRIGGER, motors, place, state, quality)
        if trips and own and _is_trip(member):
            yield Signal(reference, Meaning.TRIP, own, place, state, quality)


def _located(member: GooseMember) -> tuple[str, int | None, int | None] | None:
    """Return the reference of a member's Boolean, and the places of it and of its quality."""
    data, reference = member.data, member.member.reference
    if isinstance(data, DataAttribute):
        return (reference, None, None) if data.basic_type == "BOOLEAN" and not data.count else None
    # Sub-objects stand among the attributes in an order that the model does not keep.
    if data is None or data.objects or data.count:
        return None
    return _located_in(data, reference, member)


def _located_in(
    data: DataObject, reference: str, member: GooseMember
) -> tuple[str, int | None, int | None] | None:
    sent = [attribute for attribute in data.attributes if attribute.fc is member.member.fc]
    names = [attribute.name for attribute in sent]
    for name in _STATES:
        if name in names and sent[names.index(name)].basic_type == "BOOLEAN":
            quality = names.index("q") if "q" in names else None
            return f"{reference}.{name}", names.index(name), quality
    return None


def _is_trip(member: GooseMember) -> bool:
    node, path = member.member.logical_node, member.member.path.split(".")
    return TRIP_CLASS in node and path[0] == TRIP_OBJECT and path[1:] in ([], ["general"])


def _is_usable(quality: Value) -> bool:
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
    )


def destinations(blocks: Iterable[WatchedBlock]) -> list[bytes]:
    """Return the multicast addresses of the blocks."""
    return sorted({block.subscribed.destination for block in blocks})

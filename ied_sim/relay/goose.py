"""GOOSE messages of a simulated relay: the data sets of its control blocks, told at each change.

An event such as a trip is a change of a value or a quality in a data set. A new time alone is none.
"""

import logging
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from mms import BitString, Quality, Timestamp, Value
from mms.goose import PublishedBlock, Publisher, PublisherThread
from scl.data_model import DataAttribute, DataObject
from scl.goose_blocks import GooseBlock, GooseMember, goose_blocks
from scl.ied_model import Ied

log = logging.getLogger(__name__)

Held = Value | Quality

_ZEROS: Mapping[str, Value] = {
    "BOOLEAN": False,
    "FLOAT32": 0.0,
    "Quality": Quality().bits,
    "Timestamp": Timestamp(0),
    "Dbpos": BitString((False, False)),
    "Tcmd": BitString((False, False)),
    "Check": BitString((False, False)),
}
"""By basic type, where the relay has published nothing yet."""


@dataclass(frozen=True, slots=True)
class GooseOutlet:
    """Where GOOSE messages go: a thread that sends them, and the interface's address of six octets."""

    thread: PublisherThread
    source: bytes


class UnsupportedDataError(Exception):
    """A data set has data that the simulator does not send."""


@dataclass(frozen=True, slots=True)
class _Leaf:
    """A value of a data set: its reference, and what it is where the relay has published nothing yet."""

    reference: str
    zero: Value


_Layout = _Leaf | tuple["_Layout", ...]
"""How the values of a data set are nested."""


@dataclass(frozen=True, slots=True)
class _Sent:
    """A control block that is sent. states: references of its values whose change is a new state."""

    publisher: Publisher
    layout: tuple[_Layout, ...]
    states: frozenset[str]


class RelayGoose:
    """Publishes the control blocks of one relay that have an address, from the beginning.

    Parameters
    ----------
    ied : Ied
        The relay's IED.
    outlet : GooseOutlet
        Where the messages go.
    values : mapping of str to Value or Quality
        Values that the relay has published, by reference.
    time_ns : int
        Since when they are so [ns, UTC].
    """

    def __init__(self, ied: Ied, outlet: GooseOutlet, values: Mapping[str, Held], time_ns: int) -> None:
        self._thread = outlet.thread
        self._values: dict[str, Held] = dict(values)
        self._blocks: list[_Sent] = []
        for block in goose_blocks(ied):
            try:
                published, layout = _published(block), tuple(_of_member(member) for member in block.members)
            except UnsupportedDataError as error:
                log.warning("%s: not published: %s", block.reference, error)
                continue
            leaves = list(_leaves(layout))
            for leaf in leaves:
                self._values.setdefault(leaf.reference, leaf.zero)
            states = frozenset(leaf.reference for leaf in leaves if not isinstance(leaf.zero, Timestamp))
            publisher = Publisher(published, outlet.source, _filled(layout, self._values), time_ns)
            self._blocks.append(_Sent(publisher, layout, states))
            self._thread.add(publisher)

    def update(self, changes: Mapping[str, Held], time_ns: int) -> None:
        """Take published values, and tell the data sets that they change. One thread at a time may call."""
        changed = [reference for reference, value in changes.items() if self._values.get(reference) != value]
        self._values |= changes
        for block in self._blocks:
            if not block.states.isdisjoint(changed):
                self._thread.change(block.publisher, _filled(block.layout, self._values), time_ns)


def _published(block: GooseBlock) -> PublishedBlock:
    control, address = block.control, block.control.address
    if address is None:
        raise UnsupportedDataError("the SCD's Communication section gives it no MAC-Address (GSE)")
    times = {
        name: value
        for name, value in (
            ("minimum_time_ms", address.minimum_time_ms),
            ("maximum_time_ms", address.maximum_time_ms),
        )
        if value
    }
    return PublishedBlock(
        reference=block.reference,
        data_set=block.data_set,
        goose_id=control.application_id,
        configuration_revision=control.configuration_revision,
        destination=address.mac,
        application_id=address.application_id,
        vlan_id=address.vlan_id,
        vlan_priority=address.vlan_priority,
        **times,
    )


def _of_member(member: GooseMember) -> _Layout:
    data, reference = member.data, member.member.reference
    if data is None:
        raise UnsupportedDataError(f"{reference}: the relay has no such data")
    if isinstance(data, DataAttribute):
        return _of_attribute(data, reference)
    return _of_object(data, reference, member.member.fc)


def _of_object(data: DataObject, reference: str, constraint: str) -> _Layout:
    if data.objects or data.count:
        raise UnsupportedDataError(f"{reference}: expected data without sub-objects and arrays")
    return tuple(
        _of_attribute(attribute, f"{reference}.{attribute.name}")
        for attribute in data.attributes
        if attribute.fc == constraint
    )


def _of_attribute(attribute: DataAttribute, reference: str) -> _Layout:
    if attribute.count:
        raise UnsupportedDataError(f"{reference}: expected data without arrays")
    if attribute.basic_type == "Struct":
        return tuple(_of_attribute(part, f"{reference}.{part.name}") for part in attribute.attributes)
    return _Leaf(reference, _zero(attribute))


def _zero(attribute: DataAttribute) -> Value:
    if attribute.basic_type.startswith(("VisString", "Unicode")):
        return ""
    if attribute.basic_type.startswith("Octet"):
        return b""
    return _ZEROS.get(attribute.basic_type, attribute.ordinal or 0)


def _leaves(layout: tuple[_Layout, ...]) -> Iterator[_Leaf]:
    for part in layout:
        if isinstance(part, _Leaf):
            yield part
        else:
            yield from _leaves(part)


def _filled(layout: tuple[_Layout, ...], values: Mapping[str, Held]) -> tuple[Value, ...]:
    return tuple(
        _bits(values[part.reference]) if isinstance(part, _Leaf) else _filled(part, values) for part in layout
    )


def _bits(held: Held) -> Value:
    return held.bits if isinstance(held, Quality) else held

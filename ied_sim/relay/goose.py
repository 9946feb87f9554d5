"""GOOSE messages of a simulated relay: the data sets of its control blocks, told at each change.

An event such as a trip is a change of a value in a data set. A new quality or time alone is none.
"""

import logging
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

from mms import BitString, Quality, Timestamp, Value
from mms.goose import PublishedBlock, Publisher, PublisherThread
from scl.data_model import DataAttribute, DataObject
from scl.goose_blocks import GooseBlock, goose_blocks
from scl.ied_model import Ied

log = logging.getLogger(__name__)

Held = Value | Quality
_Reader = Callable[[Mapping[str, Held], bool], Value]
"""Gives the value of a member, from those of the relay by reference; with or without quality and time."""

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


class RelayGoose:
    """Publishes the control blocks of one relay that have an address.

    Parameters
    ----------
    ied : Ied
        The relay's IED.
    outlet : GooseOutlet
        Where the messages go.
    """

    def __init__(self, ied: Ied, outlet: GooseOutlet) -> None:
        self._outlet = outlet
        self._values: dict[str, Held] = {}
        self._blocks: list[tuple[PublishedBlock, Sequence[_Reader]]] = []
        self._publishers: list[Publisher] = []
        self._told: list[tuple[Value, ...]] = []
        for block in goose_blocks(ied):
            try:
                self._blocks.append((_published(block), _readers(block)))
            except UnsupportedDataError as error:
                log.warning("%s: not published: %s", block.reference, error)

    def begin(self, time_ns: int) -> None:
        """Publish the values as they are, from now on."""
        for block, readers in self._blocks:
            publisher = Publisher(block, self._outlet.source, self._all(readers), time_ns)
            self._told.append(self._all(readers, stamped=False))
            self._publishers.append(publisher)
            self._outlet.thread.add(publisher)

    def update(self, changes: Mapping[str, Held], time_ns: int) -> None:
        """Take published values, and tell the data sets that they change. One thread at a time may call."""
        self._values |= changes
        for place, publisher in enumerate(self._publishers):
            _, readers = self._blocks[place]
            values = self._all(readers, stamped=False)
            if values != self._told[place]:
                self._told[place] = values
                self._outlet.thread.change(publisher, self._all(readers), time_ns)

    def _all(self, readers: Sequence[_Reader], *, stamped: bool = True) -> tuple[Value, ...]:
        return tuple(read(self._values, stamped) for read in readers)


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
        vlan_id=address.vlan_id or None,
        vlan_priority=address.vlan_priority,
        **times,
    )


def _readers(block: GooseBlock) -> Sequence[_Reader]:
    found = []
    for member in block.members:
        data, reference = member.data, member.member.reference
        if data is None:
            raise UnsupportedDataError(f"{reference}: the relay has no such data")
        if isinstance(data, DataAttribute):
            found.append(_of_attribute(data, reference))
        else:
            found.append(_of_object(data, reference, member.member.fc))
    return found


def _of_object(data: DataObject, reference: str, constraint: str) -> _Reader:
    if data.objects or data.count:
        raise UnsupportedDataError(f"{reference}: expected data without sub-objects and arrays")
    return partial(
        _structure,
        tuple(
            _of_attribute(attribute, f"{reference}.{attribute.name}")
            for attribute in data.attributes
            if attribute.fc == constraint
        ),
    )


def _of_attribute(attribute: DataAttribute, reference: str) -> _Reader:
    if attribute.count:
        raise UnsupportedDataError(f"{reference}: expected data without arrays")
    if attribute.basic_type == "Struct":
        parts = (_of_attribute(part, f"{reference}.{part.name}") for part in attribute.attributes)
        return partial(_structure, tuple(parts))
    return partial(_leaf, reference, _zero(attribute), attribute.basic_type in ("Quality", "Timestamp"))


def _structure(parts: Sequence[_Reader], values: Mapping[str, Held], stamped: bool) -> Value:
    return tuple(part(values, stamped) for part in parts)


def _leaf(reference: str, zero: Value, is_stamp: bool, values: Mapping[str, Held], stamped: bool) -> Value:
    if is_stamp and not stamped:
        return zero
    held = values.get(reference, zero)
    return held.bits if isinstance(held, Quality) else held


def _zero(attribute: DataAttribute) -> Value:
    if attribute.basic_type.startswith(("VisString", "Unicode")):
        return ""
    if attribute.basic_type.startswith("Octet"):
        return b""
    return _ZEROS.get(attribute.basic_type, attribute.ordinal or 0)

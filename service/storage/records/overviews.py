"""Relays and motors of the plant, each with what belongs to it: a row of a list."""

from collections.abc import Mapping
from dataclasses import dataclass

from service.storage.records.plant import IedEntry, MotorEntry
from service.storage.records.relays import Quarantine


@dataclass(frozen=True, slots=True)
class RelayOverview:
    """A relay and what is known of it.

    motors: names of those that it protects.  last_record_ns: time of the latest record that the service has
    of it, by the relay's own clock where that is known.  quarantine: what is held against it, over or not.
    differences, ignored_files: how many; None before the first visit.  standing_alarms: how many stand at it
    and its motors.
    """

    relay: IedEntry
    motors: tuple[str, ...]
    last_record_ns: int | None
    quarantine: Quarantine | None
    differences: int | None
    ignored_files: int | None
    standing_alarms: int


@dataclass(frozen=True, slots=True)
class MotorOverview:
    """A motor and what the motors file says of it now.

    bus: with whose other motors it is compared.  document: its figures, by table and name; None before the
    service has read them.  since_ns: since when the file says so; None where it always did.
    """

    motor: MotorEntry
    bus: str | None
    document: Mapping[str, object] | None
    since_ns: int | None

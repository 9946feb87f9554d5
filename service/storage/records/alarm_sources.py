"""What alarms are raised from: links, clocks and records of a whole plant, and what was found of them."""

from dataclasses import dataclass

from service.audit.actions import AuditAction
from service.storage.records.alarms import AlarmPlace, AlarmSpec
from service.storage.states import AlarmKind, ClockQuality, LinkState


@dataclass(frozen=True, slots=True)
class LinkOutlook:
    """A relay in service, and its link. changed_ns: None before anybody looked."""

    relay: str
    site: str
    state: LinkState
    reason: str | None
    changed_ns: int | None


@dataclass(frozen=True, slots=True)
class ClockOutlook:
    """The latest comparison of a relay's clock with the service's."""

    relay: str
    offset_ns: int
    uncertainty_ns: int
    quality: ClockQuality
    measured_ns: int


@dataclass(frozen=True, slots=True)
class RecordOutlook:
    """A motor in service, its latest valid record, and whether another one can come.

    schedule: None where nothing promises records.  as_of_ns: time of the latest valid record.  stood_ns: when
    it was last seen to stand.  requested_ns: when a record of it was first requested, as far as is known.
    link, link_changed_ns: of its relay.  recording_id: of the latest valid record.
    """

    motor: str
    schedule: str | None
    as_of_ns: int | None
    stood_ns: int | None
    requested_ns: int | None
    link: LinkState
    link_changed_ns: int | None
    recording_id: str | None


@dataclass(frozen=True, slots=True)
class NotedRefusal:
    """What an entry of the audit trail tells of requests or logins that were refused.

    requests: how many it stands for.
    """

    action: AuditAction
    actor: str
    origin: str
    subject: str
    requests: int


@dataclass(frozen=True, slots=True)
class AlarmFinding:
    """That an alarm is to be raised, or told in other words; without `spec`, that it is to be cleared.

    again: whether it calls again, though somebody has acknowledged it, because it has become worse.
    """

    place: AlarmPlace
    kind: AlarmKind
    subject: str
    spec: AlarmSpec | None
    why: str | None = None
    again: bool = False

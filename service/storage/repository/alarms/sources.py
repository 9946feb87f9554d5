"""What the periodic look at the plant needs, in one query each, and what it found, in short transactions."""

from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import TypeVar

from sqlalchemy import func, select
from sqlalchemy.orm import Session, aliased

from service.alarms.kinds import AlarmKind
from service.alarms.outages import LinkPeriod
from service.storage.models import (
    AlarmRow,
    BackupRow,
    ConditionRow,
    IedRow,
    LinkChangeRow,
    MotorRow,
    ObservationRow,
    RecordingRequestRow,
)
from service.storage.records import Alarm
from service.storage.records.alarm_sources import AlarmFinding, ClockOutlook, LinkOutlook, RecordOutlook
from service.storage.repository.alarms.causes import (
    at_place,
    clear,
    forget_cleared,
    locked_place,
    raised_at,
    reopen,
)
from service.storage.repository.sessions import Sessions, columns_of
from service.storage.states import LinkState

Item = TypeVar("Item")

AT_A_TIME = 20
"""So many alarms are raised or cleared in one transaction, so that nobody waits for long."""


class AlarmSourceRows(Sessions):
    def link_outlooks(self) -> tuple[LinkOutlook, ...]:
        """Return the links of all relays in service, by the relays' names."""
        query = (
            select(IedRow.name, IedRow.site, IedRow.link_state, IedRow.link_reason, IedRow.link_changed_ns)
            .where(IedRow.in_service)
            .order_by(IedRow.name)
        )
        with self._read() as session:
            return tuple(LinkOutlook(*row) for row in session.execute(query))

    def link_periods(self, relays: Collection[str], *, since_ns: int) -> Mapping[str, Sequence[LinkPeriod]]:
        """Return how the links of relays were from a time on, oldest first, with the period before it."""
        earlier = aliased(LinkChangeRow)
        before_ns = (
            select(func.max(earlier.changed_ns))
            .where(earlier.ied == LinkChangeRow.ied, earlier.changed_ns < since_ns)
            .scalar_subquery()
        )
        order = (LinkChangeRow.ied, LinkChangeRow.changed_ns, LinkChangeRow.id)
        found: dict[str, list[LinkPeriod]] = defaultdict(list)
        with self._read() as session:
            for some in _in_parts(sorted(relays), 500):
                query = select(LinkChangeRow.ied, LinkChangeRow.changed_ns, LinkChangeRow.state).where(
                    LinkChangeRow.ied.in_(some),
                    LinkChangeRow.changed_ns >= func.coalesce(before_ns, since_ns),
                )
                for relay, changed_ns, state in session.execute(query.order_by(*order)):
                    found[relay].append(LinkPeriod(changed_ns, is_up=state is LinkState.UP))
        return found

    def clock_outlooks(self) -> tuple[ClockOutlook, ...]:
        """Return the latest comparison of each clock of a relay in service, by the relays' names."""
        query = (
            select(
                IedRow.name,
                IedRow.clock_offset_ns,
                IedRow.clock_uncertainty_ns,
                IedRow.clock_quality,
                IedRow.clock_measured_ns,
            )
            .where(IedRow.in_service, IedRow.clock_measured_ns.is_not(None))
            .order_by(IedRow.name)
        )
        with self._read() as session:
            return tuple(
                ClockOutlook(relay, offset_ns or 0, uncertainty_ns or 0, quality, measured_ns)
                for relay, offset_ns, uncertainty_ns, quality, measured_ns in session.execute(query)
                if quality is not None and measured_ns is not None
            )

    def record_outlooks(self) -> tuple[RecordOutlook, ...]:
        """Return the latest valid records of all motors in service, by the motors' names."""
        requested_ns = (
            select(func.min(RecordingRequestRow.requested_ns))
            .where(RecordingRequestRow.motor == MotorRow.name)
            .scalar_subquery()
        )
        recording_id = (
            select(ObservationRow.recording_id)
            .where(ObservationRow.motor == MotorRow.name, ObservationRow.time_ns == ConditionRow.as_of_ns)
            .limit(1)
            .scalar_subquery()
        )
        query = (
            select(
                MotorRow.name,
                MotorRow.schedule,
                ConditionRow.as_of_ns,
                ConditionRow.stood_ns,
                requested_ns,
                IedRow.link_state,
                IedRow.link_changed_ns,
                recording_id,
            )
            .join(IedRow, IedRow.name == MotorRow.ied)
            .join(ConditionRow, ConditionRow.motor == MotorRow.name)
            .where(MotorRow.in_service)
            .order_by(MotorRow.name)
        )
        with self._read() as session:
            return tuple(RecordOutlook(*row) for row in session.execute(query))

    def first_backup_ns(self) -> int | None:
        """Return when the first back-up that is known of began; None where there was none."""
        with self._read() as session:
            return session.scalar(select(func.min(BackupRow.began_ns)))

    def standing_alarms_of(self, *kinds: AlarmKind) -> tuple[Alarm, ...]:
        """Return all alarms of these kinds whose cause stands."""
        query = select(*columns_of(Alarm, AlarmRow)).where(
            AlarmRow.kind.in_(kinds), AlarmRow.cleared_ns.is_(None)
        )
        with self._read() as session:
            return tuple(Alarm(*row) for row in session.execute(query))

    def settle_findings(self, findings: Sequence[AlarmFinding], *, now_ns: int) -> None:
        """Raise and clear what was found, in this order, some at a time.

        What another service did meanwhile is not done again. Raises NotFoundError.
        """
        for some in _in_parts(findings, AT_A_TIME):
            with self._write() as session:
                for finding in some:
                    _settle(session, finding, now_ns)


def _settle(session: Session, finding: AlarmFinding, now_ns: int) -> None:
    place = locked_place(session, finding.place)
    if finding.spec is not None:
        row = raised_at(session, place, finding.spec, now_ns=now_ns)
        if finding.again:
            reopen(session, row, row.reason, now_ns=now_ns)
        return
    which = (AlarmRow.kind == finding.kind, AlarmRow.subject == finding.subject, *at_place(place))
    if clear(session, now_ns, *which, why=finding.why):
        forget_cleared(session, *at_place(place))


def _in_parts(items: Sequence[Item], number: int) -> Iterator[Sequence[Item]]:
    for first in range(0, len(items), number):
        yield items[first : first + number]

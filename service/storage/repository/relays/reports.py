"""What text reports of relays tell: statistics of a motor, its starts, stops and trips."""

from collections.abc import Sequence
from typing import Final

from sqlalchemy import and_, case, func, or_, select

from core.relay_reports import MotorStatistics
from service.audit.actions import AuditAction
from service.plant import AveragingStep, MeteredQuantity
from service.storage.models import MeasurementRow, MotorRow, RelayEventRow, RelayStatisticsRow
from service.storage.records import Cursor, MeteredHours, Page, RelayEvent
from service.storage.records.actors import Actor
from service.storage.repository.audit.entries import note_change
from service.storage.repository.sessions import Sessions, found
from service.storage.states import RelayEventKind

_QUARTERS_OF_AN_HOUR: Final = 3600 / AveragingStep.QUARTER_HOUR.value
_CURRENTS: Final = [
    MeasurementRow.__table__.c[quantity.value]
    for quantity in (MeteredQuantity.IA, MeteredQuantity.IB, MeteredQuantity.IC)
]


class RelayReportRows(Sessions):
    def add_relay_statistics(
        self, motor: str, statistics: MotorStatistics, *, by: Actor | None, now_ns: int
    ) -> bool:
        """Keep the statistics of a report, and tell whether they were not known. Raises NotFoundError."""
        with self._write() as session:
            found(session, MotorRow, motor, "motor", lock=True)
            if session.get(RelayStatisticsRow, (motor, statistics.time_ns)) is not None:
                return False
            session.add(
                RelayStatisticsRow(
                    motor=motor,
                    time_ns=statistics.time_ns,
                    since_ns=statistics.since_ns,
                    running_s=statistics.running_s,
                    stopped_s=statistics.stopped_s,
                    starts=statistics.starts,
                    mean_current_A=statistics.mean_current_A,
                    peak_current_A=statistics.peak_current_A,
                    peak_start_current_A=statistics.peak_start_current_A,
                    longest_start_s=statistics.longest_start_s,
                    trips=dict(statistics.trips),
                )
            )
            if by is not None:
                after = {"report": "MOT", "time_ns": statistics.time_ns}
                note_change(
                    session, by, AuditAction.REPORT_IMPORTED, ("motor", motor), now_ns=now_ns, after=after
                )
            return True

    def latest_relay_statistics(self, motor: str) -> MotorStatistics | None:
        """Return the latest statistics of a motor's relay; None where none were brought."""
        query = (
            select(RelayStatisticsRow)
            .where(RelayStatisticsRow.motor == motor)
            .order_by(RelayStatisticsRow.time_ns.desc())
            .limit(1)
        )
        with self._read() as session:
            row = session.scalar(query)
            return None if row is None else _statistics(row)

    def metered_hours(self, motor: str, *, least_current_A: float, from_ns: int, to_ns: int) -> MeteredHours:
        """Return how long a motor ran, and how long that is known, by quarters of an hour.

        least_current_A: with less in each phase it stands.
        """
        is_known = and_(*(current.is_not(None) for current in _CURRENTS))
        runs = and_(is_known, or_(*(current >= least_current_A for current in _CURRENTS)))
        query = select(
            func.sum(case((runs, 1), else_=0)),
            func.sum(case((is_known, 1), else_=0)),
            func.min(MeasurementRow.time_ns),
        ).where(
            MeasurementRow.motor == motor,
            MeasurementRow.step_s == AveragingStep.QUARTER_HOUR.value,
            MeasurementRow.time_ns >= from_ns,
            MeasurementRow.time_ns < to_ns,
        )
        with self._read() as session:
            running, known, first_ns = session.execute(query).one()
        return MeteredHours(
            (running or 0) / _QUARTERS_OF_AN_HOUR, (known or 0) / _QUARTERS_OF_AN_HOUR, first_ns
        )

    def add_relay_events(
        self, motor: str, events: Sequence[RelayEvent], *, by: Actor | None, now_ns: int
    ) -> int:
        """Keep starts, stops and trips, and return how many of them were not known. Raises NotFoundError."""
        with self._write() as session:
            found(session, MotorRow, motor, "motor", lock=True)
            if not events:
                return 0
            times = [event.time_ns for event in events]
            query = select(RelayEventRow.kind, RelayEventRow.time_ns).where(
                RelayEventRow.motor == motor,
                RelayEventRow.time_ns >= min(times),
                RelayEventRow.time_ns <= max(times),
            )
            known = {(kind, time_ns) for kind, time_ns in session.execute(query)}
            added = {(event.kind, event.time_ns) for event in events} - known
            session.add_all(RelayEventRow(motor=motor, kind=kind, time_ns=time_ns) for kind, time_ns in added)
            if added and by is not None:
                after = {"report": "SER", "events": len(added)}
                note_change(
                    session, by, AuditAction.REPORT_IMPORTED, ("motor", motor), now_ns=now_ns, after=after
                )
            return len(added)

    def relay_events(
        self, motor: str, kind: RelayEventKind, *, limit: int, from_ns: int, to_ns: int
    ) -> tuple[RelayEvent, ...]:
        """Return the latest events of a kind, from_ns <= time < to_ns, the latest first."""
        query = (
            select(RelayEventRow.kind, RelayEventRow.time_ns)
            .where(RelayEventRow.motor == motor, RelayEventRow.kind == kind)
            .where(RelayEventRow.time_ns >= from_ns, RelayEventRow.time_ns < to_ns)
            .order_by(RelayEventRow.time_ns.desc())
            .limit(limit)
        )
        with self._read() as session:
            return tuple(RelayEvent(*row) for row in session.execute(query))

    def relay_event_page(self, motor: str, *, limit: int, after: Cursor | None = None) -> Page[RelayEvent]:
        """Return a page of a motor's events of all kinds, the latest first. Raises NotFoundError.

        Each kind is read by its key, which holds the time, and no more of it than the page may need.
        """
        events: list[RelayEvent] = []
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            for kind in RelayEventKind:
                query = (
                    select(RelayEventRow.kind, RelayEventRow.time_ns)
                    .where(RelayEventRow.motor == motor, RelayEventRow.kind == kind)
                    .order_by(RelayEventRow.time_ns.desc())
                    .limit(limit + 1)
                )
                if after is not None:
                    time_ns, last_kind = after
                    is_earlier = RelayEventRow.time_ns < time_ns
                    is_same = RelayEventRow.time_ns == time_ns
                    query = query.where(
                        or_(is_earlier, is_same) if kind.value < str(last_kind) else is_earlier
                    )
                events += [RelayEvent(*row) for row in session.execute(query)]
        events.sort(key=_key, reverse=True)
        return Page(tuple(events[:limit]), _key(events[limit - 1]) if len(events) > limit else None)


def _key(event: RelayEvent) -> tuple[int, str]:
    return event.time_ns, event.kind.value


def _statistics(row: RelayStatisticsRow) -> MotorStatistics:
    return MotorStatistics(
        time_ns=row.time_ns,
        since_ns=row.since_ns,
        running_s=row.running_s,
        stopped_s=row.stopped_s,
        starts=row.starts,
        mean_current_A=row.mean_current_A,
        peak_current_A=row.peak_current_A,
        peak_start_current_A=row.peak_start_current_A,
        longest_start_s=row.longest_start_s,
        trips={cause: number for cause, number in row.trips.items() if isinstance(number, int)},
    )

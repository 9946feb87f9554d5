"""What the plant's design suppresses: alarms of motors that left it, and of relays that are set aside."""

from collections.abc import Sequence

from sqlalchemy import ColumnElement, or_, select
from sqlalchemy.orm import Session

from service.alarms.kinds import FOLLOW_FROM_QUARANTINE, FOLLOW_FROM_SITE_LOST
from service.storage.models import AlarmRow, IedRow, MotorRow, QuarantineRow
from service.storage.models.alarms import in_state
from service.storage.repository.alarms.changes import change, locked
from service.storage.repository.sessions import Sessions
from service.storage.states import AlarmEvent, AlarmKind, AlarmState

AT_A_TIME = 100
"""So many alarms are changed in one transaction, so that nobody waits for long."""

IDS_A_STATEMENT = 500

CALLING = (AlarmState.UNACKNOWLEDGED, AlarmState.RETURNED_UNACKNOWLEDGED)


class AlarmSuppressionRows(Sessions):
    def end_shelvings(self, *, now_ns: int) -> int:
        """End the shelvings whose time has come; return how many, at most 100 at a time."""
        due = select(AlarmRow.id).where(in_state(AlarmState.SHELVED), AlarmRow.shelved_until_ns <= now_ns)
        with self._read() as session:
            ids = session.scalars(due.order_by(AlarmRow.shelved_until_ns).limit(AT_A_TIME)).all()
        if not ids:
            return 0
        with self._write() as session:
            # Somebody may have shelved one for longer meanwhile, or another service been here.
            rows = locked(session, AlarmRow.id.in_(ids), AlarmRow.id.in_(due))
            for row in rows:
                change(session, row, AlarmEvent.SHELVING_ENDED, now_ns=now_ns)
                suppress_by_design(session, row, now_ns=now_ns)
            return len(rows)

    def begin_suppressions(self, *, now_ns: int) -> int:
        """Suppress what calls for somebody at motors and relays that left the plant.

        Returns how many, at most 100 at a time.
        """
        motors = select(MotorRow.name).where(MotorRow.in_service.is_(False))
        relays = select(IedRow.name).where(IedRow.in_service.is_(False))
        left = or_(AlarmRow.motor.in_(motors), AlarmRow.motor.is_(None) & AlarmRow.ied.in_(relays))
        with self._read() as session:
            ids = session.scalars(select(AlarmRow.id).where(_calling(), left).limit(AT_A_TIME)).all()
        if not ids:
            return 0
        with self._write() as session:
            rows = locked(session, AlarmRow.id.in_(ids), _calling())
            for row in rows:
                suppress_by_design(session, row, now_ns=now_ns)
            return sum(row.state is AlarmState.SUPPRESSED for row in rows)

    def end_suppressions(self, *, now_ns: int) -> int:
        """End the suppressions whose reason is gone; return how many, at most 100 at a time."""
        with self._read() as session:
            suppressed = session.scalars(select(AlarmRow).where(in_state(AlarmState.SUPPRESSED))).all()
            design = _Design(session, now_ns, suppressed)
            over = [row.id for row in suppressed if design.why(row) is None]
        if not over:
            return 0
        with self._write() as session:
            return unsuppress(session, AlarmRow.id.in_(over[:AT_A_TIME]), now_ns=now_ns)


def suppress_by_design(session: Session, row: AlarmRow, *, now_ns: int) -> None:
    """Suppress an alarm that calls for somebody, where the plant's design says so."""
    reason = why_suppressed(session, row, now_ns=now_ns) if row.state in CALLING else None
    if reason is not None:
        suppress(session, row, reason, now_ns=now_ns)


def suppress_all_by_design(session: Session, rows: Sequence[AlarmRow], *, now_ns: int) -> None:
    """Suppress those of some locked alarms that call for somebody, where the plant's design says so."""
    calling = [row for row in rows if row.state in CALLING]
    design = _Design(session, now_ns, calling)
    for row in calling:
        reason = design.why(row)
        if reason is not None:
            suppress(session, row, reason, now_ns=now_ns)


def suppress(session: Session, row: AlarmRow, reason: str, *, now_ns: int) -> None:
    """Suppress an alarm for a reason."""
    change(session, row, AlarmEvent.SUPPRESSED, now_ns=now_ns, comment=reason)
    row.suppressed_because = reason


def suppress_those_of_quarantine(session: Session, relay: str, *, now_ns: int) -> None:
    """Suppress the alarms that follow from the quarantine of their relay."""
    of_quarantine = AlarmRow.kind.in_(FOLLOW_FROM_QUARANTINE)
    for row in locked(session, AlarmRow.ied == relay, of_quarantine, _calling()):
        suppress(session, row, _in_quarantine(relay), now_ns=now_ns)


def unsuppress_those_of_relay(session: Session, relay: str, *, now_ns: int) -> None:
    """Have those alarms of a relay call again that nothing suppresses any more."""
    unsuppress(session, AlarmRow.ied == relay, now_ns=now_ns)


def why_suppressed(session: Session, row: AlarmRow, *, now_ns: int) -> str | None:
    """Return why the plant's design suppresses an alarm; None where it does not."""
    return _Design(session, now_ns).why(row)


class _Design:
    """The plant's design as it is at a time, asked about many alarms of one transaction."""

    def __init__(self, session: Session, now_ns: int, rows: Sequence[AlarmRow] = ()) -> None:
        """rows: alarms that it will be asked about; what it needs of them is read at once."""
        self._session = session
        self._now_ns = now_ns
        self._quarantined: dict[str, bool] = {}
        self._lost: dict[str, bool] = {}
        relays = sorted({row.ied for row in rows if row.ied is not None})
        # The session finds what it has read before, as long as somebody holds it.
        self._held: list[object] = []
        for first in range(0, len(relays), IDS_A_STATEMENT):
            some = relays[first : first + IDS_A_STATEMENT]
            self._held += session.scalars(select(IedRow).where(IedRow.name.in_(some)))
            self._held += session.scalars(select(MotorRow).where(MotorRow.ied.in_(some)))
            quarantines = session.scalars(select(QuarantineRow).where(QuarantineRow.ied.in_(some)))
            self._quarantined |= dict.fromkeys(some, False)
            self._quarantined |= {one.ied: one.until_ns > now_ns for one in quarantines}

    def why(self, row: AlarmRow) -> str | None:
        """Return why an alarm is suppressed; None where it is not."""
        if row.motor is not None:
            motor = self._session.get(MotorRow, row.motor)
            if motor is None or not motor.in_service:
                return f"motor {row.motor} is out of service"
        elif row.ied is not None:
            relay = self._session.get(IedRow, row.ied)
            if relay is None or not relay.in_service:
                return f"relay {row.ied} is out of service"
        if row.ied is not None and row.kind in FOLLOW_FROM_QUARANTINE and self._is_quarantined(row.ied):
            return _in_quarantine(row.ied)
        if row.part_of is not None:
            group = self._session.get(AlarmRow, row.part_of)
            if group is not None and group.cleared_ns is None:
                return f"one of {group.subject}, alarm {group.id}"
        if row.site is not None and row.kind in FOLLOW_FROM_SITE_LOST and self._is_lost(row.site):
            return f"site {row.site} is lost"
        return None

    def _is_quarantined(self, relay: str) -> bool:
        if relay not in self._quarantined:
            quarantine = self._session.get(QuarantineRow, relay)
            self._quarantined[relay] = quarantine is not None and quarantine.until_ns > self._now_ns
        return self._quarantined[relay]

    def _is_lost(self, site: str) -> bool:
        if site not in self._lost:
            lost = select(AlarmRow.id).where(
                AlarmRow.site == site, AlarmRow.kind == AlarmKind.SITE_LOST, AlarmRow.cleared_ns.is_(None)
            )
            self._lost[site] = self._session.scalar(lost.limit(1)) is not None
        return self._lost[site]


def unsuppress(session: Session, *which: ColumnElement[bool], now_ns: int) -> int:
    """Have those alarms call again, of these, that nothing suppresses any more; return how many."""
    rows = locked(session, in_state(AlarmState.SUPPRESSED), *which)
    design = _Design(session, now_ns, rows)
    over = [row for row in rows if design.why(row) is None]
    for row in over:
        change(session, row, AlarmEvent.UNSUPPRESSED, now_ns=now_ns)
    return len(over)


def _calling() -> ColumnElement[bool]:
    return or_(*(in_state(state) for state in CALLING))


def _in_quarantine(relay: str) -> str:
    return f"relay {relay} is in quarantine"

"""Relays that are set aside, or suspected: until when, why and how often."""

from collections.abc import Collection
from datetime import UTC, datetime

from sqlalchemy import select
from sqlalchemy.orm import Session

from core.units import NANOSECONDS_PER_SECOND
from service.storage.models import IedRow, QuarantineRow
from service.storage.records import Quarantine
from service.storage.repository.alarms import clear_standing, raised
from service.storage.repository.links import change_link
from service.storage.repository.sessions import Sessions, found, record_of
from service.storage.states import AlarmKind, LinkState
from service.timing.backoff import Backoff

RELEASED = "released from quarantine"


class QuarantineRows(Sessions):
    def set_aside(self, ied: str, reason: str, *, backoff: Backoff, now_ns: int) -> Quarantine:
        """Set a relay aside, for longer each time; its link and an alarm say so.

        backoff: the pause after so many quarantines in a row. Raises NotFoundError.
        """
        with self._write() as session:
            found(session, IedRow, ied, "IED", lock=True)
            times = _times(session, ied) + 1
            row = _put(session, ied, reason, times, now_ns, backoff.pause_s(times))
            raised(session, ied, AlarmKind.QUARANTINED, "", reason, now_ns)
            return record_of(Quarantine, row)

    def suspect(self, ieds: Collection[str], reason: str, *, pause_s: float, now_ns: int) -> None:
        """Note relays of which one did harm. Raises NotFoundError."""
        with self._write() as session:
            for ied in sorted(ieds):  # in one order, for two who lock them
                found(session, IedRow, ied, "IED", lock=True)
                _put(session, ied, reason, _times(session, ied), now_ns, pause_s)

    def release(self, ied: str, *, now_ns: int) -> None:
        """Forget whatever was held against a relay; harmless where nothing was. Raises NotFoundError."""
        with self._write() as session:
            relay = found(session, IedRow, ied, "IED", lock=True)
            row = session.get(QuarantineRow, ied)
            if row is not None:
                session.delete(row)
            if relay.link_state is LinkState.QUARANTINED:
                change_link(session, relay, LinkState.UNKNOWN, RELEASED, now_ns)
            clear_standing(session, ied, AlarmKind.QUARANTINED, now_ns)

    def quarantine(self, ied: str) -> Quarantine | None:
        """Return what is held against a relay, over or not; None where nothing is."""
        with self._read() as session:
            row = session.get(QuarantineRow, ied)
            return None if row is None else record_of(Quarantine, row)

    def quarantines(self) -> tuple[Quarantine, ...]:
        """Return all quarantines, ordered by relay."""
        with self._read() as session:
            rows = session.scalars(select(QuarantineRow).order_by(QuarantineRow.ied))
            return tuple(record_of(Quarantine, row) for row in rows)


def _times(session: Session, ied: str) -> int:
    row = session.get(QuarantineRow, ied)
    return 0 if row is None else row.times


def _put(session: Session, ied: str, reason: str, times: int, now_ns: int, pause_s: float) -> QuarantineRow:
    relay = found(session, IedRow, ied, "IED")
    row = session.get(QuarantineRow, ied)
    if row is None:
        row = QuarantineRow(ied=ied)
        session.add(row)
    row.reason, row.times, row.since_ns = reason, times, now_ns
    row.until_ns = now_ns + round(pause_s * NANOSECONDS_PER_SECOND)
    if pause_s > 0:
        until = f"{datetime.fromtimestamp(row.until_ns // NANOSECONDS_PER_SECOND, UTC):%Y-%m-%dT%H:%M:%SZ}"
        change_link(session, relay, LinkState.QUARANTINED, f"set aside until {until}: {reason}", now_ns)
    session.flush()
    return row

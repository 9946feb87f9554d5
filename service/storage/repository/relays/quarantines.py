"""Relays that are set aside, or suspected: until when, why and how often."""

from collections.abc import Collection

from sqlalchemy import select
from sqlalchemy.orm import Session

from core.time_stamps import rfc3339
from core.units import NANOSECONDS_PER_SECOND
from service.audit.actions import AuditAction
from service.storage.models import IedRow, QuarantineRow
from service.storage.records import Quarantine
from service.storage.records.actors import SERVICE, Actor
from service.storage.repository.alarms.causes import clear_standing, raised
from service.storage.repository.alarms.suppression import (
    suppress_those_of_quarantine,
    unsuppress_those_of_relay,
)
from service.storage.repository.audit.entries import note_change
from service.storage.repository.relays.links import change_links
from service.storage.repository.sessions import Sessions, found, record_of
from service.storage.states import AlarmKind, LinkState
from service.timing.backoff import Backoff

RELEASED = "released from quarantine"


class QuarantineRows(Sessions):
    def set_aside(self, relay: str, reason: str, *, backoff: Backoff, now_ns: int) -> Quarantine:
        """Set a relay aside, for longer each time; its link and an alarm say so.

        backoff: the pause after so many quarantines in a row. Raises NotFoundError.
        """
        with self._write() as session:
            found(session, IedRow, relay, "relay", lock=True)
            times = _times(session, relay) + 1
            row = _put(session, relay, reason, times, now_ns, backoff.pause_s(times))
            raised(session, relay, AlarmKind.QUARANTINED, "", reason, now_ns)
            suppress_those_of_quarantine(session, relay, now_ns=now_ns)
            return record_of(Quarantine, row)

    def suspect(self, relays: Collection[str], reason: str, *, pause_s: float, now_ns: int) -> None:
        """Note relays of which one did harm. Raises NotFoundError."""
        with self._write() as session:
            for relay in sorted(relays):  # in one order, for two who lock them
                found(session, IedRow, relay, "relay", lock=True)
                _put(session, relay, reason, _times(session, relay), now_ns, pause_s)
                if pause_s > 0:
                    suppress_those_of_quarantine(session, relay, now_ns=now_ns)

    def release(self, relay: str, *, by: Actor = SERVICE, now_ns: int) -> None:
        """Forget whatever was held against a relay; harmless where nothing was. Raises NotFoundError."""
        with self._write() as session:
            relay_row = found(session, IedRow, relay, "relay", lock=True)
            row = session.get(QuarantineRow, relay)
            if row is not None:
                before = {"reason": row.reason, "times": row.times, "until": rfc3339(row.until_ns)}
                action = AuditAction.QUARANTINE_RELEASED
                note_change(session, by, action, ("relay", relay), now_ns=now_ns, before=before)
                session.delete(row)
                session.flush()
            if relay_row.link_state is LinkState.QUARANTINED:
                change_links(session, [relay_row], LinkState.UNKNOWN, RELEASED, now_ns)
            clear_standing(session, relay, AlarmKind.QUARANTINED, now_ns)
            unsuppress_those_of_relay(session, relay, now_ns=now_ns)

    def quarantine(self, relay: str) -> Quarantine | None:
        """Return what is held against a relay, over or not; None where nothing is."""
        with self._read() as session:
            row = session.get(QuarantineRow, relay)
            return None if row is None else record_of(Quarantine, row)

    def quarantines(self) -> tuple[Quarantine, ...]:
        """Return all quarantines, ordered by relay."""
        with self._read() as session:
            rows = session.scalars(select(QuarantineRow).order_by(QuarantineRow.ied))
            return tuple(record_of(Quarantine, row) for row in rows)


def _times(session: Session, relay: str) -> int:
    row = session.get(QuarantineRow, relay)
    return 0 if row is None else row.times


def _put(session: Session, relay: str, reason: str, times: int, now_ns: int, pause_s: float) -> QuarantineRow:
    relay_row = found(session, IedRow, relay, "relay")
    row = session.get(QuarantineRow, relay)
    if row is None:
        row = QuarantineRow(ied=relay)
        session.add(row)
    row.reason, row.times, row.since_ns = reason, times, now_ns
    row.until_ns = now_ns + round(pause_s * NANOSECONDS_PER_SECOND)
    if pause_s > 0:
        why = record_of(Quarantine, row).link_reason
        change_links(session, [relay_row], LinkState.QUARANTINED, why, now_ns)
    session.flush()
    return row

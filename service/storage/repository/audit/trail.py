"""Reads the audit trail: pages of it for people, all of it for who verifies or exports it."""

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass

from sqlalchemy import select, update
from sqlalchemy.orm import Session

from service.audit.actions import AuditAction
from service.audit.entries import Anchor, AuditEntry
from service.storage.models import AuditEntryRow, AuditForwardingRow, AuditHeadRow
from service.storage.records import Cursor, Page
from service.storage.records.actors import SERVICE, Actor
from service.storage.records.alarm_sources import NotedRefusal
from service.storage.repository.audit.entries import note_change
from service.storage.repository.audit.values import changed, kept
from service.storage.repository.sessions import Sessions, columns_of, page_of, within

REFUSALS = (
    AuditAction.LOGIN_FAILED,
    AuditAction.LOGIN_LOCKED,
    AuditAction.LOGIN_REFUSED,
    AuditAction.REQUEST_REFUSED,
    AuditAction.TOKEN_REFUSED,
)
"""The entries that alarms of security are raised for."""
MOST_REFUSALS = 500
READ_AT_ONCE = 1000
"""So many entries are in memory when all are read."""


@dataclass(frozen=True, slots=True)
class AuditTrail:
    """The trail as it is at one time, whatever is added meanwhile. head: the last entry that was written."""

    head: Anchor
    _session: Session

    def entries(self, *, first: int = 1) -> Iterator[AuditEntry]:
        """Read the entries from a number on, one by one."""
        query = select(*columns_of(AuditEntry, AuditEntryRow)).order_by(AuditEntryRow.number)
        while rows := self._session.execute(
            query.where(AuditEntryRow.number >= first).limit(READ_AT_ONCE)
        ).all():
            for row in rows:
                yield AuditEntry(*row)
            first = rows[-1].number + 1


class AuditRows(Sessions):
    @contextmanager
    def audit_trail(self) -> Iterator[AuditTrail]:
        """Give the whole trail to read, as it is now."""
        with self._read() as session:
            if session.get_bind().dialect.name == "postgresql":
                # Each statement would else see what was added since the one before.
                session.connection(execution_options={"isolation_level": "REPEATABLE READ"})
            head = session.scalars(select(AuditHeadRow)).one()
            yield AuditTrail(Anchor(head.number, head.hash), session)

    def audit_entries_from(self, first: int, last: int) -> tuple[AuditEntry, ...]:
        """Return some of the entries from one number to another, oldest first; none where there are none."""
        query = (
            select(*columns_of(AuditEntry, AuditEntryRow))
            .where(AuditEntryRow.number.between(first, last))
            .order_by(AuditEntryRow.number)
            .limit(READ_AT_ONCE)
        )
        with self._read() as session:
            return tuple(AuditEntry(*row) for row in session.execute(query))

    def first_audit_entry_ns(self) -> int | None:
        """Return when the first entry was written: about when the service first started; None before that."""
        with self._read() as session:
            return session.scalar(select(AuditEntryRow.time_ns).order_by(AuditEntryRow.number).limit(1))

    def audit_entries(
        self,
        *,
        limit: int,
        after: Cursor | None = None,
        actor: str | None = None,
        action: AuditAction | None = None,
        subject: str | None = None,
        from_ns: int | None = None,
        to_ns: int | None = None,
    ) -> Page[AuditEntry]:
        """Return a page of entries, latest first, those that meet all conditions; None for any."""
        query = select(*columns_of(AuditEntry, AuditEntryRow))
        if actor is not None:
            query = query.where(AuditEntryRow.actor == actor)
        if action is not None:
            query = query.where(AuditEntryRow.action == action)
        if subject is not None:
            query = query.where(AuditEntryRow.subject == subject)
        query = query.where(*within(AuditEntryRow.time_ns, from_ns, to_ns))
        with self._read() as session:
            order = [AuditEntryRow.number]
            return page_of(session, query, order, AuditEntry, limit=limit, after=after, descending=True)

    def refusals_since(self, since_ns: int) -> tuple[NotedRefusal, ...]:
        """Return what was refused since a time; of each kind the latest MOST_REFUSALS entries."""
        found = []
        with self._read() as session:
            for action in REFUSALS:
                latest = (
                    select(AuditEntryRow)
                    .where(AuditEntryRow.action == action)
                    .order_by(AuditEntryRow.number.desc())
                    .limit(MOST_REFUSALS)
                )
                for row in session.scalars(latest):
                    if row.time_ns >= since_ns:
                        requests = json.loads(row.after or "{}").get("requests", 1)
                        found.append(NotedRefusal(action, row.actor, row.origin, row.subject, requests))
        return tuple(found)

    def note_settings(self, settings: Mapping[str, object], installation: str, *, now_ns: int) -> None:
        """Note where the settings of an installation differ from those that it started with before.

        settings: those that have not their default; what is left out has it.
        """
        mine = (AuditEntryRow.action == AuditAction.SETTINGS_CHANGED, AuditEntryRow.subject == installation)
        with self._write() as session:
            before: dict[str, object] = {}
            for after in session.scalars(
                select(AuditEntryRow.after).where(*mine).order_by(AuditEntryRow.number)
            ):
                before |= json.loads(after or "{}")
            now = json.loads(kept(settings) or "{}")
            was, becomes = changed({name: value for name, value in before.items() if value is not None}, now)
            if becomes:
                note_change(
                    session,
                    SERVICE,
                    AuditAction.SETTINGS_CHANGED,
                    ("service", installation),
                    now_ns=now_ns,
                    before=was,
                    after=becomes,
                )

    def forwarded_audit_entry(self) -> int:
        """Return the number of the last entry that the syslog server has; 0 before the first."""
        with self._read() as session:
            return session.scalars(select(AuditForwardingRow.number)).one()

    def note_forwarded_audit_entries(self, before: int, last: int) -> None:
        """Note that the syslog server has the entries up to `last`.

        before: what it had when they were sent. Where another service has sent them meanwhile, nothing
        changes.
        """
        row = update(AuditForwardingRow).where(AuditForwardingRow.number == before)
        with self._write() as session:
            session.execute(row.values(number=last))

    def note_by(
        self,
        by: Actor,
        action: AuditAction,
        subject: tuple[str, str],
        *,
        now_ns: int,
        after: Mapping[str, object] | None = None,
    ) -> None:
        """Write an entry on what changes nothing in the database, such as an export."""
        with self._write() as session:
            note_change(session, by, action, subject, now_ns=now_ns, after=after)

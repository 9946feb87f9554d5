"""Writes the entries of a transaction into the audit trail, last of all before it is committed.

Every entry follows the one before it, so writers wait for each other at the head of the chain. Because
entries come last, others wait for the commit alone; because all writers lock in one order, no two wait for
each other. A transaction that is taken back leaves none.
"""

from collections.abc import Mapping
from dataclasses import asdict

from sqlalchemy import event, insert, select
from sqlalchemy.orm import Session

from service.audit.actions import AuditAction
from service.audit.entries import AuditEntry, sealed
from service.storage.models import AuditEntryRow, AuditHeadRow
from service.storage.records.actors import Actor
from service.storage.repository.audit.values import kept
from service.storage.repository.counting_session import CountingSession
from service.storage.texts import storable

_ENTRIES = "entries of the audit trail"


def note_change(
    session: Session,
    by: Actor,
    action: AuditAction,
    subject: tuple[str, str],
    *,
    now_ns: int,
    before: Mapping[str, object] | None = None,
    after: Mapping[str, object] | None = None,
) -> None:
    """Have an entry written when the session's transaction is committed.

    subject: what was changed, as its kind and its name or id: ("motor", "PUMP-A1"). before, after: the values
    that were changed, as they were and as they are. What has the name of a secret is not kept, but give none.
    """
    kind, name = subject
    entry = AuditEntry(
        number=0,
        time_ns=now_ns,
        actor=storable(by.name),
        origin=storable(by.origin),
        roles=" ".join(sorted(by.roles)),
        action=action,
        subject_kind=kind,
        subject=storable(name),
        before=kept(before),
        after=kept(after),
        previous="",
        hash="",
    )
    session.info.setdefault(_ENTRIES, []).append(entry)


@event.listens_for(CountingSession, "before_commit")
def _write_entries(session: Session) -> None:
    """Write what was noted. It comes behind the state counts, whose listener is older."""
    noted: list[AuditEntry] = session.info.pop(_ENTRIES, [])
    if not noted:
        return
    session.flush()
    head = session.scalars(select(AuditHeadRow).with_for_update()).one()
    rows = []
    for entry in noted:
        chained = sealed(entry.following(head.number + 1, head.hash))
        head.number, head.hash = chained.number, chained.hash
        rows.append(asdict(chained))
    session.execute(insert(AuditEntryRow), rows)
    session.flush()

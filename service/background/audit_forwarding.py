"""Sends every entry of the audit trail to a syslog server, which so has what nobody here can change.

What was sent is noted afterwards: entries are sent at least once, and one that comes twice has its number.
"""

import asyncio
from collections.abc import Sequence
from threading import Event

import structlog

from service.audit.entries import AuditEntry
from service.configuration.audit import AuditSyslog
from service.configuration.channels import FACILITIES
from service.senders.errors import SendError
from service.senders.syslog import send_records
from service.senders.syslog_record import SEVERITIES, SyslogRecord
from service.storage import Repository

log = structlog.get_logger(__name__)

PERIOD_S = 5.0
LONGEST_BACKLOG_S = 3600.0
"""A trail of years may be sent when a server is set for the first time."""

SENT_AT_ONCE = 100
"""So many entries go over one connection, and are sent again if it breaks."""


class AuditForwarding:
    """Sends the entries that the server does not have, in their order, round by round."""

    def __init__(self, repository: Repository, syslog: AuditSyslog, stopping: Event | None = None) -> None:
        """stopping: set when sending should end, though there is more to send."""
        self._repository = repository
        self._syslog = syslog
        self._stopping = stopping or Event()
        self._failure: str | None = None

    def forward(self) -> None:
        """Send what there is to send. A server that does not answer is asked again in the next round."""
        while not self._stopping.is_set():
            sent = self._repository.forwarded_audit_entry()
            entries = self._repository.audit_entries_from(sent + 1, sent + SENT_AT_ONCE)
            if not entries:
                return
            try:
                asyncio.run(self._send(entries))
            except (SendError, TimeoutError) as error:
                self._tell(str(error) or f"no answer within {self._syslog.timeout_s:g} s")
                return
            self._tell(None)
            self._repository.note_forwarded_audit_entries(sent, entries[-1].number)

    async def _send(self, entries: Sequence[AuditEntry]) -> None:
        async with asyncio.timeout(self._syslog.timeout_s):
            facility = FACILITIES[self._syslog.facility]
            await send_records(self._syslog, [_record(entry, facility) for entry in entries])

    def _tell(self, failure: str | None) -> None:
        """Log when sending begins to fail, or works again."""
        if failure is not None and self._failure is None:
            log.error("the audit trail does not reach its syslog server, trying again", error=failure)
        if failure is None and self._failure is not None:
            log.info("the audit trail reaches its syslog server again")
        self._failure = failure


def _record(entry: AuditEntry, facility: int) -> bytes:
    """Return an entry as a record; what belongs to the chain stands first, where nothing cuts it off."""
    data = {
        "number": str(entry.number),
        "hash": entry.hash,
        "actor": entry.actor,
        "origin": entry.origin,
        "action": entry.action,
        "subject": f"{entry.subject_kind} {entry.subject}",
    }
    values = " -> ".join(text for text in (entry.before, entry.after) if text is not None)
    text = f"{entry.actor} from {entry.origin}: {entry.action}, {entry.subject_kind} {entry.subject} {values}"
    return SyslogRecord(entry.time_ns, facility, SEVERITIES["low"], "audit", text, data).octets()

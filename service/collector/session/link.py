"""The state, the figures and the history of the link to one relay, kept in the database and the log."""

import time
from dataclasses import replace

import structlog
from sqlalchemy.exc import SQLAlchemyError

from service.collector.records.pull import DailyAllowance
from service.collector.session.notes import Notes
from service.collector.session.session_policy import SESSION_POLICY
from service.storage.records import LinkNote, LinkTraffic, Quarantine
from service.storage.states import LinkState

log = structlog.get_logger(__name__)

NOTE_PERIOD_S = 1.0
"""The figures of a link that stays up are written this often at most."""


STATE_PERIOD_S = 60.0
"""A link that stays up says so again: another host may have said late that its gateway is gone."""


class Link:
    """State, figures and history of the link to one relay. Used by that relay's session alone."""

    def __init__(
        self,
        relay: str,
        notes: Notes,
        allowance: DailyAllowance,
        *,
        reminder_s: float = SESSION_POLICY.reminder_s,
    ) -> None:
        """Begin with a link of which nothing is known yet.

        notes: takes what goes over the link and how it is.
        reminder_s: a link that stays down for the same reason is logged this often.
        """
        self._relay = relay
        self._allowance = allowance
        self._unwritten = LinkTraffic()
        self._notes = notes
        self._reminder_s = reminder_s
        self._written_s: float | None = None
        self._stated_s = 0.0
        self._told_ns = 0
        self._remark: str | None = None
        self._failure_logged: tuple[str, float] | None = None

    def connected(self) -> None:
        """Note a new connection: the next answer is written at once."""
        self._unwritten = replace(self._unwritten, connections=self._unwritten.connections + 1)
        self._written_s = None
        self._failure_logged = None

    def reported(self, *, gap: bool) -> None:
        """Note that a report came. gap: others before it were lost."""
        self._unwritten = replace(
            self._unwritten,
            reports=self._unwritten.reports + 1,
            report_gaps=self._unwritten.report_gaps + gap,
        )

    def lost_reports(self) -> None:
        """Note that reports were lost without another report to say so."""
        self._unwritten = replace(self._unwritten, report_gaps=self._unwritten.report_gaps + 1)

    def received(self, number_of_bytes: int) -> None:
        """Note that bytes of a file came."""
        self._unwritten = replace(
            self._unwritten, received_bytes=self._unwritten.received_bytes + number_of_bytes
        )

    def answered(self, round_trip_s: float | None, remark: str | None = None) -> None:
        """Note that the relay answered. remark: what it cannot give at present. Raises SQLAlchemyError."""
        now_s, self._told_ns = time.monotonic(), time.time_ns()
        is_new = self._written_s is None or remark != self._remark
        if is_new or now_s - self._stated_s >= STATE_PERIOD_S:
            self._note(round_trip_s, LinkState.UP, remark)
            self._stated_s = now_s
        elif self._written_s is not None and now_s - self._written_s >= NOTE_PERIOD_S:
            self._note(round_trip_s)
        else:
            return
        self._written_s, self._remark = now_s, remark

    def visit_ended(self) -> None:
        """Write what is left at the end of a visit that went well."""
        if self._written_s is None:
            return  # the relay has not answered yet
        try:
            self._note(None)
        except SQLAlchemyError:
            log.exception("figures of a link are lost", relay=self._relay)

    def failed(self, reason: str) -> None:
        """Note that the link is down, and why."""
        self._log_failure(reason)
        self._ended(LinkState.DOWN, reason, time.time_ns())

    def set_aside(self, quarantine: Quarantine) -> None:
        """Have the last word on the link, which is down and set aside: notes of this visit may still wait."""
        self._ended(LinkState.QUARANTINED, quarantine.link_reason, quarantine.since_ns)

    def _ended(self, state: LinkState, reason: str, now_ns: int) -> None:
        self._told_ns = now_ns
        try:
            self._note(None, state, reason)
        except SQLAlchemyError:
            log.exception("database does not answer, trying again")

    def _note(
        self, round_trip_s: float | None, state: LinkState | None = None, reason: str | None = None
    ) -> None:
        """Write the figures, and the state where there is a new one. Raises SQLAlchemyError."""
        self._notes.add_note(
            LinkNote(
                self._relay,
                self._told_ns,
                self._unwritten,
                round_trip_s,
                day=self._allowance.day,
                day_bytes=self._allowance.used_bytes,
                state=state,
                reason=reason,
            )
        )
        self._unwritten = LinkTraffic()

    def _log_failure(self, reason: str) -> None:
        """Log a failure once, and then now and then: a relay may be off for a month."""
        now_s = time.monotonic()
        if self._failure_logged is not None:
            logged, logged_s = self._failure_logged
            if reason == logged and now_s - logged_s < self._reminder_s:
                return
        self._failure_logged = (reason, now_s)
        log.warning("link down", relay=self._relay, reason=reason)

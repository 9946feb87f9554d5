"""What one relay's link does, told to the database and the log without wearing either."""

import time
from collections.abc import Callable
from dataclasses import replace

import structlog
from sqlalchemy.exc import SQLAlchemyError

from service.collector.records.allowance import DailyAllowance
from service.storage import Repository
from service.storage.records import LinkNote, LinkTraffic
from service.storage.states import LinkState

log = structlog.get_logger(__name__)

NOTE_PERIOD_S = 1.0
"""A relay that goes on answering is written down this often at most."""

REMIND_AFTER_S = 600.0
"""A link that stays down for the same reason is logged this often."""


class Link:
    """State, figures and history of one link. Used by that relay's session alone."""

    def __init__(
        self,
        relay: str,
        repository: Repository,
        allowance: DailyAllowance,
        *,
        on_note: Callable[[LinkNote], None] | None = None,
    ) -> None:
        """on_note: takes what goes over a link that stays up; None where it is written at once."""
        self._relay = relay
        self._repository = repository
        self._allowance = allowance
        self._untold = LinkTraffic()
        self._on_note = on_note or (lambda note: repository.note_links((note,)))
        self._told_s: float | None = None
        self._answered_ns = 0
        self._remark: str | None = None
        self._failure_logged: tuple[str, float] | None = None

    def connected(self) -> None:
        """A new connection: the next answer is written down at once."""
        self._untold = replace(self._untold, connections=self._untold.connections + 1)
        self._told_s = None
        self._failure_logged = None

    def reported(self, *, gap: bool) -> None:
        """A report came; with a gap, others before it were lost."""
        self._untold = replace(
            self._untold, reports=self._untold.reports + 1, report_gaps=self._untold.report_gaps + gap
        )

    def lost_reports(self) -> None:
        """Reports were lost, and none came to tell it."""
        self._untold = replace(self._untold, report_gaps=self._untold.report_gaps + 1)

    def received(self, number_of_bytes: int) -> None:
        """Bytes of a file came."""
        self._untold = replace(self._untold, received_bytes=self._untold.received_bytes + number_of_bytes)

    def answered(self, round_trip_s: float | None, remark: str | None = None) -> None:
        """The relay answered; its latest answer took that long. remark: what it cannot give at present."""
        now_s, self._answered_ns = time.monotonic(), time.time_ns()
        if self._told_s is None or remark != self._remark:
            self._tell(LinkState.UP, remark, round_trip_s)
        elif now_s - self._told_s >= NOTE_PERIOD_S:
            self._note(round_trip_s)
        else:
            return
        self._told_s, self._remark = now_s, remark

    def left(self) -> None:
        """The visit ends in good order: what is not written down yet is."""
        if self._told_s is None:
            return  # the relay has not answered yet
        try:
            self._note(None)
        except SQLAlchemyError:
            log.exception("figures of a link are lost", relay=self._relay)

    def failed(self, reason: str) -> None:
        """The link is down; tried again later."""
        self._log_failure(reason)
        try:
            self._tell(LinkState.DOWN, reason, None)
        except SQLAlchemyError:
            log.exception("database does not answer, trying again")

    def _tell(self, state: LinkState, reason: str | None, round_trip_s: float | None) -> None:
        self._repository.set_link_state(
            self._relay,
            state,
            reason,
            now_ns=time.time_ns(),
            traffic=self._untold,
            round_trip_s=round_trip_s,
            day_bytes=(self._allowance.day, self._allowance.used_bytes),
        )
        self._untold = LinkTraffic()

    def _note(self, round_trip_s: float | None) -> None:
        self._on_note(
            LinkNote(
                self._relay,
                self._answered_ns,
                self._untold,
                round_trip_s,
                day=self._allowance.day,
                day_bytes=self._allowance.used_bytes,
            )
        )
        self._untold = LinkTraffic()

    def _log_failure(self, reason: str) -> None:
        """A relay that is off for a month is one line at first and one now and then, not one each retry."""
        now_s = time.monotonic()
        if self._failure_logged is not None:
            logged, logged_s = self._failure_logged
            if reason == logged and now_s - logged_s < REMIND_AFTER_S:
                return
        self._failure_logged = (reason, now_s)
        log.warning("link down", relay=self._relay, reason=reason)

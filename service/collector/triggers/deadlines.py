"""How long event reports of one relay have waited: for it to answer and, while it answers, for a record."""

from service.storage.records import RecordingRequest
from service.storage.states import RecordingRequestState


class RequestDeadlines:
    """Neither time runs while the relay gives one record after another: with many, a scan takes minutes.

    Times are monotonic [s]: a wall clock that is set must end no report's time. After a restart every report
    gets its time limit again: its record may wait in the relay.
    """

    def __init__(self, timeout_s: float) -> None:
        self.timeout_s = timeout_s
        self._unanswered_since_s: dict[str, float] = {}
        self._down_since_s: float | None = None
        self._watched: tuple[str, RecordingRequestState] | None = None
        self._watched_since_s = 0.0

    def gave_a_record(self) -> None:
        """The relay: one that was stored, or refused for good."""
        self._unanswered_since_s.clear()
        self._down_since_s = None
        self._watched = None

    def answered(self, now_s: float) -> None:
        """The relay was looked through. What it did while it could not be counts against no report."""
        self._unanswered_since_s.clear()
        if self._down_since_s is not None:
            self._watched_since_s += now_s - self._down_since_s
            self._down_since_s = None

    def ends_without_answer(self, report: RecordingRequest, now_s: float) -> bool:
        """The relay does not answer: whether for too long, since this report first met with that."""
        if self._down_since_s is None:
            self._down_since_s = now_s
        return now_s > self._unanswered_since_s.setdefault(report.id, now_s) + self.timeout_s

    def ends_without_record(self, report: RecordingRequest, now_s: float) -> bool:
        """Whether it has been in its state for too long, while the relay answered."""
        watched = (report.id, report.state)
        if watched != self._watched:
            self._watched, self._watched_since_s = watched, now_s
        return now_s > self._watched_since_s + self.timeout_s

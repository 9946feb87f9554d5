"""How long recording requests of one relay have waited: for it to answer and, while it answers, for a record.

Neither time runs while the relay gives one record after another, because a scan of many takes minutes.
"""

from service.storage.records import RecordingRequest
from service.storage.states import RecordingRequestState


class RequestDeadlines:
    """The time limits of one relay's requests.

    Times are monotonic [s]: a wall clock that is set must not end a request. After a restart every request
    gets its time limit again, because its record may wait in the relay.
    """

    def __init__(self, timeout_s: float) -> None:
        self.timeout_s = timeout_s
        self._unanswered_since_s: dict[str, float] = {}
        self._down_since_s: float | None = None
        self._watched: tuple[str, RecordingRequestState] | None = None
        self._watched_since_s = 0.0

    def gave_a_record(self) -> None:
        """The relay gave a record that was stored, or refused for good."""
        self._unanswered_since_s.clear()
        self._down_since_s = None
        self._watched = None

    def answered(self, now_s: float) -> None:
        """The relay was looked through. The time before, in which it could not be, counts for no request."""
        self._unanswered_since_s.clear()
        if self._down_since_s is not None:
            self._watched_since_s += now_s - self._down_since_s
            self._down_since_s = None

    def ends_without_answer(self, request: RecordingRequest, now_s: float) -> bool:
        """Whether the relay has not answered for too long, counted from the first time for this request."""
        if self._down_since_s is None:
            self._down_since_s = now_s
        return now_s > self._unanswered_since_s.setdefault(request.id, now_s) + self.timeout_s

    def ends_without_record(self, request: RecordingRequest, now_s: float) -> bool:
        """Whether the request has been in its state for too long, while the relay answered."""
        watched = (request.id, request.state)
        if watched != self._watched:
            self._watched, self._watched_since_s = watched, now_s
        return now_s > self._watched_since_s + self.timeout_s

"""The time limits of one relay's recording requests: for its answer and, while it answers, for a record.

Neither time runs while the relay gives one record after another, because a scan of many takes minutes. The
requests of a relay that does not answer, or is not visited, fail here too.
"""

import time

import structlog

from service.storage import Repository
from service.storage.records import RecordingRequest
from service.storage.states import RecordingRequestState

log = structlog.get_logger(__name__)


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
        """Note that the relay gave a record that was stored, or refused for good."""
        self._unanswered_since_s.clear()
        self._down_since_s = None
        self._watched = None

    def answered(self, now_s: float) -> None:
        """Note that the relay was looked through.

        The time before, in which it could not be, counts for no request.
        """
        self._unanswered_since_s.clear()
        if self._down_since_s is not None:
            self._watched_since_s += now_s - self._down_since_s
            self._down_since_s = None

    def ends_without_answer(self, request: RecordingRequest, now_s: float) -> bool:
        """Return whether the relay has not answered for too long, from the first call for this request on."""
        if self._down_since_s is None:
            self._down_since_s = now_s
        return now_s > self._unanswered_since_s.setdefault(request.id, now_s) + self.timeout_s

    def ends_without_record(self, request: RecordingRequest, now_s: float) -> bool:
        """Return whether the request has been in its state for too long, while the relay answered."""
        watched = (request.id, request.state)
        if watched != self._watched:
            self._watched, self._watched_since_s = watched, now_s
        return now_s > self._watched_since_s + self.timeout_s


class UnansweredRequests:
    """The open recording requests of one relay, while the relay cannot be asked."""

    def __init__(self, relay: str, repository: Repository, deadlines: RequestDeadlines) -> None:
        self._relay = relay
        self._repository = repository
        self._deadlines = deadlines

    def fail_overdue(self, reason: str) -> None:
        """Fail the requests that have waited long enough. `reason` says why the relay cannot be asked."""
        now_s = time.monotonic()
        for request in self._repository.open_recording_requests(self._relay):
            if self._deadlines.ends_without_answer(request, now_s):
                text = f"{self._relay} {reason}"
                self._repository.fail_recording_request(request.id, text, now_ns=time.time_ns())
                log.warning(
                    "recording request failed", relay=self._relay, recording_request=request.id, reason=text
                )

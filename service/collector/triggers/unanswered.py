"""Recording requests of a relay that does not answer, or is not visited: they fail in time."""

import time

import structlog

from service.collector.triggers.deadlines import RequestDeadlines
from service.storage import Repository

log = structlog.get_logger(__name__)


class UnansweredRequests:
    """The open recording requests of one relay, as long as the relay cannot be asked."""

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

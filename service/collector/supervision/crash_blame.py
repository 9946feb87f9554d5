"""Find which relay brought a gateway process down: the one it was busy with when it crashed.

Where the gateway was busy with several relays, each is a suspect: one half is visited again at once, the
other half a probation time later. The next crash has at most half the suspects, until one is left, which
caused it.
"""

import signal
import time
from collections.abc import Collection
from contextlib import suppress

import structlog

from service.collector.session.quarantine import QuarantinePolicy, quarantine_relay
from service.collector.session.visit_marks import VisitMarks
from service.storage import NotFoundError, Repository

log = structlog.get_logger(__name__)

CRASHES = frozenset({signal.SIGSEGV, signal.SIGABRT, signal.SIGBUS, signal.SIGFPE, signal.SIGILL})
"""What a fault inside the C library ends a process with. SIGKILL comes from outside."""


def blame_after_end(
    marks: VisitMarks, exit_code: int | None, repository: Repository, policy: QuarantinePolicy
) -> None:
    """Quarantine or suspect the relays that an ended gateway process was busy with, if it crashed.

    exit_code: of the process; None where it did not start. A mark that names no relay of the plant is passed
    over. Raises SQLAlchemyError, OSError.
    """
    marked = marks.suspects()
    marks.clear()
    suspects = _known(marked, repository)
    if suspects != marked:
        log.warning("marks of visits that name no relay are passed over", names=sorted(marked - suspects))
    if exit_code is None or -exit_code not in CRASHES or not suspects:
        return
    crash = signal.Signals(-exit_code).name
    # A relay that was suspected before, or has just come back, is the likelier cause.
    suspected_before = suspects.intersection(each.ied for each in repository.quarantines())
    suspects = suspected_before or suspects
    if len(suspects) == 1:
        (culprit,) = suspects
        quarantine_relay(repository, culprit, f"its answers crashed the gateway ({crash})", policy)
        return
    log.warning("the gateway crashed while busy with several relays", relays=sorted(suspects), crash=crash)
    reason = f"one of {len(suspects)} relays the gateway was busy with when it crashed ({crash})"
    for relays, pause_s in zip(_halves(suspects), (0.0, policy.probation_s), strict=True):
        repository.suspect(relays, reason, pause_s=pause_s, now_ns=time.time_ns())


def _known(relays: frozenset[str], repository: Repository) -> frozenset[str]:
    """Return those of the names that are relays of the plant. Raises SQLAlchemyError."""
    known = set()
    for relay in relays:
        with suppress(NotFoundError):
            known.add(repository.relay(relay).name)
    return frozenset(known)


def _halves(relays: Collection[str]) -> tuple[list[str], list[str]]:
    """Return the relays in two halves, the first of which has one more where their number is odd."""
    ordered = sorted(relays)
    middle = (len(ordered) + 1) // 2
    return ordered[:middle], ordered[middle:]

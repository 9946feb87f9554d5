"""Relays that harm the gateway are set aside: who is to blame for a crash, for how long, and until when.

A relay is set aside when its answers crash the gateway process, or break the protocol again and again. The
first pause is the setting `quarantine_s`; each further one is twice as long, up to a day. A relay that then
works for as long as it was set aside, or is released by a command, begins with a clean sheet.

Where a gateway crashed while it was busy with several relays, each is a suspect: one half comes back at once,
the other PROBATION_S later. The next crash has at most half the suspects, until one is left, which it was.
"""

import signal
import time
from collections.abc import Collection
from contextlib import suppress

import structlog

from service.collector.session.visit_marks import VisitMarks
from service.storage import NotFoundError, Repository
from service.storage.records import Quarantine

log = structlog.get_logger(__name__)

PROBATION_S = 10.0
LONGEST_PAUSE_S = 86_400.0

FAULTS_IN_A_ROW = 5
"""VisitMarks that ended by a broken protocol, with no good one between them."""

GOOD_VISIT_S = 10.0
"""A visit that goes well for so long is a good one; one good answer is not."""

CRASHES = frozenset({signal.SIGSEGV, signal.SIGABRT, signal.SIGBUS, signal.SIGFPE, signal.SIGILL})
"""What a fault inside the C library ends a process with. SIGKILL is somebody's wish."""


def blame_after_end(
    visits: VisitMarks, exit_code: int | None, repository: Repository, *, first_pause_s: float
) -> None:
    """A gateway process has ended: if it crashed, blame whom it was busy with.

    A mark of what is no relay, which nobody here has made, is passed over. Raises SQLAlchemyError, OSError.
    """
    marked = visits.suspects()
    visits.forget()
    suspects = _known(marked, repository)
    if suspects != marked:
        log.warning("marks of visits that name no relay are passed over", names=sorted(marked - suspects))
    if exit_code is None or -exit_code not in CRASHES or not suspects:
        return
    crash = signal.Signals(-exit_code).name
    # One that was suspected before, or has just come back, is the likelier one.
    again = suspects.intersection(each.ied for each in repository.quarantines())
    suspects = again or suspects
    if len(suspects) == 1:
        (culprit,) = suspects
        set_aside(
            repository, culprit, f"its answers crashed the gateway ({crash})", first_pause_s=first_pause_s
        )
        return
    log.warning("the gateway crashed while busy with several relays", relays=sorted(suspects), crash=crash)
    reason = f"one of {len(suspects)} relays the gateway was busy with when it crashed ({crash})"
    for relays, pause_s in zip(_halves(suspects), (0.0, PROBATION_S), strict=True):
        repository.suspect(relays, reason, pause_s=pause_s, now_ns=time.time_ns())


def set_aside(repository: Repository, relay: str, reason: str, *, first_pause_s: float) -> None:
    """Leave a relay alone for a while. Raises SQLAlchemyError."""
    quarantine = repository.set_aside(
        relay, reason, first_pause_s=first_pause_s, longest_pause_s=LONGEST_PAUSE_S, now_ns=time.time_ns()
    )
    pause_s = (quarantine.until_ns - quarantine.since_ns) / 1e9
    log.error("relay set aside", relay=relay, reason=reason, times=quarantine.times, pause_s=pause_s)


class ProtocolFaultCounter:
    """How a relay behaves towards its session: whether it is to be set aside, or is trusted again."""

    def __init__(self, relay: str, repository: Repository, *, first_pause_s: float) -> None:
        self._relay = relay
        self._repository = repository
        self._first_pause_s = first_pause_s
        self._faults = 0
        self._visited_s = time.monotonic()
        self._probation_s = _probation_s(repository.quarantine(relay))

    def visited(self) -> None:
        """A visit begins."""
        self._visited_s = time.monotonic()

    def answered(self) -> None:
        """A round went well."""
        well_s = time.monotonic() - self._visited_s
        if well_s > GOOD_VISIT_S:
            self._faults = 0
        if self._probation_s is not None and well_s > self._probation_s:
            self._repository.release(self._relay, now_ns=time.time_ns())
            self._probation_s = None
            log.info("relay trusted again", relay=self._relay)

    def broke_the_protocol(self, reason: str) -> bool:
        """A visit ended by what no relay may answer. Returns whether the relay is set aside now."""
        self._faults += 1
        if self._faults < FAULTS_IN_A_ROW:
            return False
        told = f"it broke the protocol {self._faults} times in a row, at last: {reason}"
        set_aside(self._repository, self._relay, told, first_pause_s=self._first_pause_s)
        return True


def _probation_s(quarantine: Quarantine | None) -> float | None:
    if quarantine is None:
        return None
    return max(PROBATION_S, (quarantine.until_ns - quarantine.since_ns) / 1e9)


def _known(relays: frozenset[str], repository: Repository) -> frozenset[str]:
    known = set()
    for relay in relays:
        with suppress(NotFoundError):
            known.add(repository.ied(relay).name)
    return frozenset(known)


def _halves(relays: Collection[str]) -> tuple[list[str], list[str]]:
    ordered = sorted(relays)
    middle = (len(ordered) + 1) // 2
    return ordered[:middle], ordered[middle:]

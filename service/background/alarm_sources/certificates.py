"""Certificates that are about to end: `certificate-end`. The service's own, and those of the relays."""

import socket
from collections.abc import Iterator, Sequence
from datetime import UTC
from pathlib import Path

from core.units import NANOSECONDS_PER_SECOND, SECONDS_PER_DAY
from mms import CredentialFileError, read_certificates
from service.alarms.confirmation import DeadBand, Decision
from service.alarms.kinds import AlarmKind, AlarmPriority
from service.background.alarm_sources.standing import StandingAlarms
from service.configuration.certificate_files import certificate_files
from service.configuration.settings import Settings
from service.storage import Repository
from service.storage.records import AlarmPlace, AlarmSpec
from service.storage.records.alarm_sources import AlarmFinding

URGENT_DAYS = 7.0
"""From then on the alarm has a higher priority, and calls again."""

MOST_USERS = 3
"""So many relays, or others, are named that use a file."""


class CertificateSource:
    """Reads the certificates of the settings now and then."""

    def __init__(self, settings: Settings, repository: Repository) -> None:
        days = settings.alarms.certificate_days
        self._repository = repository
        self._files = certificate_files(settings)
        self._band = DeadBand(days, days + 1.0)
        self._host = socket.gethostname()

    def findings(self, now_ns: int) -> Iterator[AlarmFinding]:
        """Yield what has changed. Raises SQLAlchemyError."""
        standing = StandingAlarms(self._repository, AlarmKind.CERTIFICATE_END)
        subjects = set()
        for path, users in self._files.items():
            subject = f"{self._host}: {path}"
            subjects.add(subject)
            stands = standing.of(AlarmKind.CERTIFICATE_END, subject) is not None
            finding = self._finding(path, subject, users, standing, now_ns, stands=stands)
            if finding is not None:
                yield finding
        yield from standing.gone(
            AlarmKind.CERTIFICATE_END,
            subjects,
            "the settings do not name the file any more",
            of=f"{self._host}: ",
        )

    def _finding(
        self,
        path: Path,
        subject: str,
        users: Sequence[str],
        standing: StandingAlarms,
        now_ns: int,
        *,
        stands: bool,
    ) -> AlarmFinding | None:
        used = _used_by(users)
        try:
            ends = min(one.not_valid_after_utc for one in read_certificates(path))
        except (CredentialFileError, ValueError) as error:
            spec = _spec(subject, f"{error} ({used})", AlarmPriority.HIGH)
            decision = Decision.KEEP if stands else Decision.RAISE
            return standing.finding(subject, AlarmPlace(), spec, decision, "")
        left_days = (ends.timestamp() - now_ns / NANOSECONDS_PER_SECOND) / SECONDS_PER_DAY
        decision = self._band.decide(left_days, stands=stands)
        if decision is Decision.KEEP and not stands:
            return None
        verb = "ended" if left_days < 0.0 else "ends"
        reason = f"{verb} {ends.astimezone(UTC):%Y-%m-%dT%H:%M:%S}Z ({used})"
        spec = _spec(subject, reason, AlarmPriority.HIGH if left_days <= URGENT_DAYS else None)
        return standing.finding(subject, AlarmPlace(), spec, decision, f"it {reason}")


def _spec(subject: str, reason: str, priority: AlarmPriority | None) -> AlarmSpec:
    return AlarmSpec(AlarmKind.CERTIFICATE_END, reason, subject, priority=priority)


def _used_by(users: Sequence[str]) -> str:
    named = ", ".join(users[:MOST_USERS])
    more = len(users) - MOST_USERS
    return f"for {named}" + (f" and {more} others" if more > 0 else "")

"""How a relay's records are treated: what is waited for, and what each kind of failure leads to.

The module also says which errors are failures of which kind, and words them for people.
docs/reference/record-life.md shows the figures as tables.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from types import MappingProxyType

from mms import (
    AccessDenied,
    ConnectionLost,
    FileSizeMismatch,
    NotFound,
    ProtocolError,
    ServiceFailed,
    TemporarilyUnavailable,
    Timeout,
)
from service.collector.records.errors import RecordReplacedError, RecordTooLargeError
from service.recording_store.errors import RecordingStoreError, StoreError
from service.storage.states import AlarmKind
from service.timing.backoff import Backoff


class Failure(StrEnum):
    """Why a record could not be pulled."""

    BUSY = "busy"
    DENIED = "denied"
    NOT_AS_LISTED = "not as listed"
    LINK_LOST = "link lost"
    PROTOCOL_BROKEN = "protocol broken"
    TOO_LARGE = "too large"
    NAME_REFUSED = "name refused"
    STORE_AWAY = "store away"


_KINDS: dict[type[Exception], Failure] = {
    RecordTooLargeError: Failure.TOO_LARGE,
    RecordingStoreError: Failure.NAME_REFUSED,
    StoreError: Failure.STORE_AWAY,
    TemporarilyUnavailable: Failure.BUSY,
    # What a relay may answer for a record that is fine: nobody may open files, or it is out of memory.
    AccessDenied: Failure.DENIED,
    ServiceFailed: Failure.DENIED,
    # What one record can do wrong while the link is fine.
    FileSizeMismatch: Failure.NOT_AS_LISTED,
    NotFound: Failure.NOT_AS_LISTED,
    RecordReplacedError: Failure.NOT_AS_LISTED,
    # What ends the visit, and may be due to the record that was asked for.
    ConnectionLost: Failure.LINK_LOST,
    Timeout: Failure.LINK_LOST,
    ProtocolError: Failure.PROTOCOL_BROKEN,
}

PULL_FAILURES = tuple(_KINDS)
"""These errors are due to a record, or may be."""

VISIT_ENDS = frozenset({Failure.LINK_LOST, Failure.PROTOCOL_BROKEN})


@dataclass(frozen=True, slots=True)
class Attempts:
    """Numbers of failed attempts at one record; as a limit, what each number must be at least.

    of_kind: those that failed in this way since the collector started.  since_start: those that failed in any
    way since then.  in_all: those counted in the database, which outlast a restart.
    """

    of_kind: int = 0
    since_start: int = 0
    in_all: int = 0

    def reach(self, limits: tuple["Attempts", ...]) -> bool:
        """Return whether these attempts reach any of the limits."""
        return any(
            self.of_kind >= limit.of_kind
            and self.since_start >= limit.since_start
            and self.in_all >= limit.in_all
            for limit in limits
        )


@dataclass(frozen=True, slots=True)
class FailureRule:
    """What one kind of failure leads to.

    pause: before the next attempt; None where there is none.  alarm_after, refuse_after: any of these limits;
    never where there is none.  is_counted: whether the database counts the attempts.  alarm: its kind.
    """

    pause: Backoff | None
    alarm_after: tuple[Attempts, ...] = ()
    refuse_after: tuple[Attempts, ...] = ()
    is_counted: bool = False
    alarm: AlarmKind = AlarmKind.FILE_UNSTEADY


ONCE = (Attempts(of_kind=1),)

DEFAULT_RULES: Mapping[Failure, FailureRule] = MappingProxyType(
    {
        Failure.BUSY: FailureRule(Backoff(0.2, 60.0)),
        # The relay opens no file for now, which says nothing about the record. 155 attempts take about a day.
        Failure.DENIED: FailureRule(
            Backoff(0.2, 600.0),
            alarm_after=(Attempts(in_all=5),),
            refuse_after=(Attempts(in_all=155),),
            is_counted=True,
        ),
        # A file may be missing, or not as long as listed, while the relay is at it; hardly for the minute
        # that nine attempts take. The count in the database holds denials too, so it is only the outer bound.
        Failure.NOT_AS_LISTED: FailureRule(
            Backoff(0.2, 60.0),
            refuse_after=(Attempts(of_kind=9), Attempts(in_all=155)),
            is_counted=True,
        ),
        Failure.LINK_LOST: FailureRule(Backoff(0.2, 60.0), alarm_after=(Attempts(since_start=5),)),
        # One record that a relay cannot give must not set aside the relay again and again.
        Failure.PROTOCOL_BROKEN: FailureRule(
            Backoff(0.2, 60.0),
            alarm_after=(Attempts(since_start=5),),
            refuse_after=(Attempts(in_all=9, since_start=2),),
            is_counted=True,
        ),
        Failure.TOO_LARGE: FailureRule(
            None, alarm_after=ONCE, refuse_after=ONCE, alarm=AlarmKind.FILE_TOO_LARGE
        ),
        Failure.NAME_REFUSED: FailureRule(None, refuse_after=ONCE),
        # The relay and its record are fine. Nothing is asked for while the store says that it is away.
        Failure.STORE_AWAY: FailureRule(Backoff(1.0, 60.0)),
    }
)


@dataclass(frozen=True, slots=True)
class RecordPolicy:
    """Everything about records that is a matter of judgement. Times are in seconds.

    rules: what each kind of failure leads to.
    expected_settle_s, settle_s: how long sizes and times of a record must stand still before it is pulled:
    where a report said that a record was made, and where none did, so that the relay may only be pausing.
    other_format_s: how long an event report must stand still at a relay that writes COMTRADE too, which may
    be on its way.
    unsteady_s: how long a record may go on changing before it is an alarm.
    wrong_listings_a_day: how often a record of one name may prove not to be as listed, of whatever size and
    time it is listed each time, before it is an alarm and waits for the next day of UTC.
    soon_s: a record whose next attempt is further away does not hurry the listings.
    folder_search_s, expected_search_s: between two searches for a folder that was not there; where a report
    said that a record was made, which the folder may have been made for.
    no_files_search_s: between two searches at a relay that seems to have no file service.
    other_folder_s: between two looks for a second folder of recordings.
    """

    rules: Mapping[Failure, FailureRule] = field(default_factory=lambda: DEFAULT_RULES)
    expected_settle_s: float = 0.2
    settle_s: float = 2.0
    other_format_s: float = 5.0
    unsteady_s: float = 600.0
    wrong_listings_a_day: int = 30
    soon_s: float = 2.0
    folder_search_s: float = 10.0
    expected_search_s: float = 0.5
    no_files_search_s: float = 60.0
    other_folder_s: float = 60.0


RECORD_POLICY = RecordPolicy()


def failure_of(error: Exception) -> Failure:
    """Return the kind of failure, by the most special class of the error that is listed."""
    return next(_KINDS[kind] for kind in type(error).__mro__ if kind in _KINDS)


def reason_of(failure: Failure, record_name: str, error: Exception) -> str:
    """Return why the record is not there yet, in words for a person who waits for it."""
    if failure in (Failure.DENIED, Failure.NOT_AS_LISTED):
        return f"{record_name}: {error}"
    return str(error)


def alarm_text(failure: Failure, record_name: str, reason: str, attempts: Attempts) -> str:
    """Return what an alarm says of a record that fails again and again."""
    if failure is Failure.DENIED:
        return f"{reason}, {attempts.in_all} times; it is asked for again, for about a day"
    if failure in VISIT_ENDS:
        return (
            f"{record_name}: not fetched in {attempts.since_start} attempts, "
            f"the latest ended the link: {reason}"
        )
    return reason

"""The kind of failure behind an error that ends a pull, and its words for people."""

from mms import (
    AccessDenied,
    ConnectionLost,
    FileServiceFailed,
    FileSizeMismatch,
    NotFound,
    ProtocolError,
    TemporarilyUnavailable,
    Timeout,
)
from service.collector.records.policy import Attempts, Failure
from service.collector.records.pull import RecordTooLargeError
from service.recording_store.store import RecordingStoreError

_KINDS: dict[type[Exception], Failure] = {
    RecordTooLargeError: Failure.TOO_LARGE,
    RecordingStoreError: Failure.NAME_REFUSED,
    TemporarilyUnavailable: Failure.BUSY,
    # What a relay may answer for a record that is fine: nobody may open files, or it is out of memory.
    AccessDenied: Failure.DENIED,
    FileServiceFailed: Failure.DENIED,
    # What one record can do wrong while the link is fine.
    FileSizeMismatch: Failure.NOT_AS_LISTED,
    NotFound: Failure.NOT_AS_LISTED,
    # What ends the visit, and may be due to the record that was asked for.
    ConnectionLost: Failure.LINK_LOST,
    Timeout: Failure.LINK_LOST,
    ProtocolError: Failure.PROTOCOL_BROKEN,
}

PULL_FAILURES = tuple(_KINDS)
"""Errors that are due to a record, or may be."""

VISIT_ENDS = frozenset({Failure.LINK_LOST, Failure.PROTOCOL_BROKEN})


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

"""A relay's event directory, brought into the recording store. The directory is the truth; reports hurry."""

import time
from collections.abc import Callable
from dataclasses import dataclass

import structlog

from mms import AccessDenied, Client, FileSizeMismatch, NotFound, TemporarilyUnavailable
from service.collector.listing import ListedRecord, understand
from service.collector.pulling import RecordTooLargeError, pull
from service.collector.settling import Settling
from service.plant import Relay
from service.recordings import RecordingStore, RecordingStoreError
from service.settings import Settings
from service.storage import Repository
from service.storage.records import RemoteRecord

log = structlog.get_logger(__name__)

SETTLE_S = 0.2
"""How long a record's sizes and times must stand still before it is pulled."""

PULL_ATTEMPTS = 3
"""A file can vanish or change between listing and pulling, when the relay makes room; hardly three times."""

REFUSALS = (AccessDenied, NotFound, FileSizeMismatch)
"""What one record can do wrong while the link is fine."""

Owner = Callable[[str], str | None]
"""Tells the event report, if any, that a new record of this name belongs to."""


@dataclass(frozen=True, slots=True)
class Scan:
    """What one scan of the directory came to, by names of records.

    listed: all there are.  taken: newly stored or refused for good.  waiting: new ones that are not ready, or
    are to be tried again.
    """

    listed: frozenset[str]
    taken: tuple[str, ...]
    waiting: tuple[str, ...]


class RecordDirectory:
    """Scans one relay's directory and stores what is new. Used by that relay's session alone."""

    def __init__(
        self, relay: Relay, motor: str, repository: Repository, store: RecordingStore, settings: Settings
    ) -> None:
        self._relay = relay.name
        self._motor = motor
        self._repository = repository
        self._store = store
        self._directory = settings.events_directory
        self._max_file_bytes = settings.max_file_bytes
        self._settling = Settling(settle_s=SETTLE_S, patience_s=settings.record_timeout_s)
        # This session alone writes the relay's records, so that it knows without asking the database again.
        self._known = set(repository.known_remote_records(relay.name))
        self._refused_names: set[str] = set()

    def scan(self, client: Client, owner: Owner) -> Scan:
        """List the directory; pull and store what is new and ready, oldest first.

        Raises MmsError when the link fails, OSError when the disk does; what was stored until then stays.
        """
        listing = understand(client.files(self._directory), self._directory)
        for refused in listing.refused:
            if refused.name not in self._refused_names:
                self._refused_names.add(refused.name)
                log.warning("file refused", relay=self._relay, file=refused.name, reason=refused.reason)
        new = [record for record in listing.records if _remote(record) not in self._known]
        new.sort(key=lambda record: (record.modified_ns, record.name))
        settled = self._settling.look(new, time.monotonic())
        for record in settled.incomplete:
            suffix = record.missing[0]
            self._refuse(
                record, f"{record.name}: expected a {suffix} file in {self._directory}, found none", owner
            )
        for record in settled.ready:
            self._take(client, record, owner)
        return Scan(
            listed=frozenset(record.name for record in listing.records),
            taken=tuple(record.name for record in new if _remote(record) in self._known),
            waiting=tuple(record.name for record in new if _remote(record) not in self._known),
        )

    def _take(self, client: Client, record: ListedRecord, owner: Owner) -> None:
        """Pull and store one record. Where that fails, refuse it or leave it for the next scan."""
        remote = _remote(record)
        self._repository.announce_recording(self._relay, self._motor, remote, now_ns=time.time_ns())
        try:
            stored = pull(client, record, self._store, max_file_bytes=self._max_file_bytes)
        except (RecordTooLargeError, RecordingStoreError) as error:
            self._refuse(record, str(error), owner)
            return
        except TemporarilyUnavailable as error:
            log.info("record busy", relay=self._relay, record=record.name, reason=str(error))
            return
        except REFUSALS as error:
            reason = f"{record.name}: {error}"
            log.warning("record not pulled", relay=self._relay, record=record.name, reason=reason)
            attempts = self._repository.note_failed_pull(
                self._relay, self._motor, remote, reason, now_ns=time.time_ns()
            )
            if attempts >= PULL_ATTEMPTS:
                self._refuse(record, reason, owner)
            return
        added = self._repository.add_recording(
            stored,
            motor=self._motor,
            now_ns=time.time_ns(),
            ied=self._relay,
            remote=remote,
            event_report_id=owner(record.name),
        )
        self._known.add(remote)
        log.info(
            "record stored" if added.created else "record known already",
            relay=self._relay,
            record=record.name,
            size_bytes=stored.size_bytes,
            recording=added.recording.id,
        )

    def _refuse(self, record: ListedRecord, reason: str, owner: Owner) -> None:
        self._repository.reject_remote_record(
            self._relay,
            self._motor,
            _remote(record),
            reason,
            now_ns=time.time_ns(),
            event_report_id=owner(record.name),
        )
        self._known.add(_remote(record))
        log.warning("record refused", relay=self._relay, record=record.name, reason=reason)


def _remote(record: ListedRecord) -> RemoteRecord:
    return RemoteRecord(record.name, record.size_bytes, record.modified_ns)

"""What became of a relay's records: stored, refused, or seen and neither yet.

The database has it. It is kept here as well, because relays list hundreds of records again and again.
"""

import time
from collections.abc import Iterable

import structlog

from service.collector.records.formats import remote_of
from service.collector.records.listing import ListedRecord
from service.recording_store.store import StoredRecording
from service.storage import Repository
from service.storage.records import RemoteRecord

log = structlog.get_logger(__name__)


class RecordLedger:
    """Of one relay's records. Used by that relay's session alone, which alone writes them.

    stored: those whose files are in the store.  refused: those that are not pulled again.  doubted: those of
    the stored ones that may be others by now.
    """

    def __init__(self, relay: str, motor: str, repository: Repository) -> None:
        self._relay = relay
        self._motor = motor
        self._repository = repository
        self._asked = False
        self.stored: set[RemoteRecord] = set()
        self.refused: set[RemoteRecord] = set()
        self.doubted: set[RemoteRecord] = set()
        self._announced: set[RemoteRecord] = set()

    def recall(self) -> None:
        """What became of the records before; years of them, so not in the thread that starts all."""
        if self._asked:
            return
        known = self._repository.known_remote_records(self._relay)
        self.refused.update(self._repository.refused_remote_records(self._relay))
        self.stored.update(known - self.refused)
        self._announced.update(self._repository.announced_remote_records(self._relay))
        self._asked = True

    def is_stored(self, record: ListedRecord) -> bool:
        return remote_of(record) in self.stored

    def is_decided(self, record: ListedRecord) -> bool:
        """Whether it is stored beyond doubt, or refused."""
        return self.is_refused(record) or (self.is_stored(record) and not self.is_doubted(record))

    def is_doubted(self, record: ListedRecord) -> bool:
        return remote_of(record) in self.doubted

    def is_refused(self, record: ListedRecord) -> bool:
        return remote_of(record) in self.refused

    def announce(self, record: ListedRecord) -> None:
        """It is seen, and about to be pulled."""
        remote = remote_of(record)
        if remote not in self._announced and remote not in self.stored:
            self._repository.announce_recording(self._relay, self._motor, remote, now_ns=time.time_ns())
            self._announced.add(remote)

    def note_failed_pull(self, record: ListedRecord, reason: str) -> int:
        """Returns how often in all, also before a restart."""
        log.warning("record not pulled", relay=self._relay, record=record.name, reason=reason)
        return self._repository.note_failed_pull(
            self._relay, self._motor, remote_of(record), reason, now_ns=time.time_ns()
        )

    def keep(self, record: ListedRecord, stored: StoredRecording, recording_request_id: str | None) -> None:
        """Its files are in the store; the event report, if any, gets it."""
        remote = remote_of(record)
        added = self._repository.add_recording(
            stored,
            motor=self._motor,
            now_ns=time.time_ns(),
            ied=self._relay,
            remote=remote,
            recording_request_id=recording_request_id,
        )
        self.stored.add(remote)
        self.doubted.discard(remote)
        self._announced.discard(remote)
        log.info(
            "record stored" if added.created else "record known already",
            relay=self._relay,
            record=record.name,
            size_bytes=stored.size_bytes,
            recording=added.recording.id,
        )

    def refuse(self, record: ListedRecord, reason: str, recording_request_id: str | None) -> None:
        """It is not pulled again; the event report, if any, fails with the reason."""
        remote = remote_of(record)
        self._repository.reject_remote_record(
            self._relay,
            self._motor,
            remote,
            reason,
            now_ns=time.time_ns(),
            recording_request_id=recording_request_id,
        )
        self.refused.add(remote)
        self.doubted.discard(remote)
        self._announced.discard(remote)

    def give_up_all_but(self, records: Iterable[ListedRecord]) -> None:
        """Records that were seen, and that the relay replaced or discarded before they could be pulled."""
        if not self._announced:
            return
        for remote in self._announced - set(map(remote_of, records)):
            reason = f"{remote.name}: the relay discarded or changed it before it could be pulled"
            self._repository.give_up_remote_record(self._relay, remote, reason)
            self._announced.discard(remote)
            log.warning("record gone", relay=self._relay, record=remote.name, reason=reason)

    def forget_the_untimed_but(self, records: Iterable[ListedRecord]) -> None:
        """Where a relay gives no times, a new record may look like one that is gone."""
        for known in (self.stored, self.refused):
            untimed = {remote for remote in known if not remote.modified_ns}
            if untimed:
                known -= untimed.difference(map(remote_of, records))
        self.doubted &= self.stored

    def doubt_the_untimed(self) -> None:
        """Where a relay gives no times, a new record of the same name and size looks like the old one."""
        self.doubted.update(remote for remote in self.stored if not remote.modified_ns)

"""The states of a relay's records: kept while the relay lists them, and written to the database.

The database knows every record the relay has ever listed. This module holds only those the relay lists at
present, so that memory does not grow with the years. A record that comes back into the listing is looked up.
Beside the records stand the listings that proved wrong today, counted by names.
"""

import time
from collections import Counter
from collections.abc import Collection, Iterable

import structlog

from core.units import NANOSECONDS_PER_DAY
from service.collector.records.life import Life, RecordState, remote_of
from service.collector.records.listing import ListedRecord
from service.recording_store.recording import StoredRecording
from service.storage import Repository
from service.storage.records import Deletion, RecordingEntry, RemoteRecord
from service.storage.states import RecordingState

log = structlog.get_logger(__name__)

MOST_NAMES = 1000
"""Where wrong listings of more names are counted, only names that are still listed are remembered."""


class RecordLedger:
    """The records of one relay. Used by that relay's session alone, which alone writes them.

    revision: grows when the listing changes, and when a record is stored, refused, given up for another
    format, or to be pulled once more. While it stays the same, the same records are waited for.
    """

    def __init__(self, relay: str, motor: str, repository: Repository) -> None:
        self._relay = relay
        self._motor = motor
        self._repository = repository
        self._states: dict[ListedRecord, RecordState] = {}
        self._announced: set[RemoteRecord] = set()
        self._has_begun = False
        self.revision = 0

    def follow(self, listed: Collection[ListedRecord]) -> list[RecordState]:
        """Return the states of all records listed now, in their order; forget all others.

        A record the relay gives no time for is looked up in the database only in the first listing: later, a
        new record may look like one that is gone.
        """
        before = {state.remote: state for state in self._states.values()}
        new = [record for record in listed if record not in self._states]
        unseen = {remote_of(record) for record in new} - before.keys()
        asked = [remote for remote in unseen if remote.modified_ns or not self._has_begun]
        known = self._repository.remote_recordings(self._relay, asked)
        deleted = self._repository.deleted_remote_records(self._relay, asked)
        if not self._has_begun:
            self._announced.update(self._repository.announced_remote_records(self._relay))
            self._has_begun = True
        begun = {record: self._begin(record, before, known, deleted) for record in new}
        waited_since_s = {
            state.name: state.first_s for state in self._states.values() if state.first_s is not None
        }
        for state in begun.values():
            state.first_s = None if state.is_decided else waited_since_s.get(state.name)
        states = [begun.get(record) or self._states[record] for record in listed]
        self._states = {state.record: state for state in states}
        self.revision += 1
        return states

    def _begin(
        self,
        record: ListedRecord,
        before: dict[RemoteRecord, RecordState],
        known: dict[RemoteRecord, RecordingEntry],
        deleted: dict[RemoteRecord, Deletion],
    ) -> RecordState:
        """Return the state of a record that is listed anew, as far as it is known from before."""
        state = RecordState(record)
        same, recording = before.get(state.remote), known.get(state.remote)
        deletion = deleted.get(state.remote)
        if same is not None:  # its files are listed in another way, for instance in another folder
            state.in_store = same.in_store
            if same.is_decided:
                state.life = same.life
        elif recording is not None and recording.state is not RecordingState.ANNOUNCED:
            state.in_store = recording.digest is not None
            state.life = Life.STORED if state.in_store else Life.REFUSED
        elif deletion is not None and recording is None:
            state.in_store = deletion.digest is not None
            state.life = Life.DELETED if state.in_store else Life.REFUSED
        return state

    def pass_over(self, states: Iterable[RecordState]) -> None:
        """Do not wait for these: another format of their event is taken."""
        for state in states:
            if not state.is_decided and state.life is not Life.INCOMPLETE:
                state.begin_anew(Life.LISTED)

    def announce(self, state: RecordState) -> None:
        """Write down that a record was seen and is about to be pulled."""
        if state.in_store or state.remote in self._announced:
            return
        self._repository.announce_recording(self._relay, self._motor, state.remote, now_ns=time.time_ns())
        self._announced.add(state.remote)

    def count_attempt(self, state: RecordState, reason: str) -> int:
        """Count a failed attempt in the database; return how many there were in all, before restarts too."""
        log.warning("record not pulled", relay=self._relay, record=state.name, reason=reason)
        return self._repository.note_failed_pull(
            self._relay, self._motor, state.remote, reason, now_ns=time.time_ns()
        )

    def keep(self, state: RecordState, stored: StoredRecording, recording_request_id: str | None) -> None:
        """Write down that its files are in the store; the recording request, if any, gets it.

        A record that was deleted here stays so, under whatever listing it comes back.
        """
        deletion = self._repository.keep_deleted(
            stored,
            motor=self._motor,
            relay=self._relay,
            remote=state.remote,
            now_ns=time.time_ns(),
            recording_request_id=recording_request_id,
        )
        if deletion is not None:
            state.in_store = True
            self._decide(state, Life.DELETED)
            log.info("record stays deleted", relay=self._relay, record=state.name, recording=deletion.id)
            return
        added = self._repository.add_recording(
            stored,
            motor=self._motor,
            now_ns=time.time_ns(),
            relay=self._relay,
            remote=state.remote,
            recording_request_id=recording_request_id,
        )
        state.in_store = True
        self._decide(state, Life.STORED)
        log.info(
            "record stored" if added.created else "record known already",
            relay=self._relay,
            record=state.name,
            size_bytes=stored.size_bytes,
            recording=added.recording.id,
        )

    def refuse(self, state: RecordState, reason: str, recording_request_id: str | None) -> None:
        """Write down that it is not pulled again; the recording request, if any, fails with the reason."""
        self._repository.reject_remote_record(
            self._relay,
            self._motor,
            state.remote,
            reason,
            now_ns=time.time_ns(),
            recording_request_id=recording_request_id,
        )
        self._decide(state, Life.REFUSED)

    def _decide(self, state: RecordState, life: Life) -> None:
        state.begin_anew(life)
        self.revision += 1
        self._announced.discard(state.remote)

    def give_up(self, state: RecordState) -> None:
        """Wait no longer for the missing files of a record whose event is there in another format."""
        state.begin_anew(Life.INCOMPLETE)
        self.revision += 1

    def give_up_all_but(self, states: Iterable[RecordState]) -> None:
        """Write down which announced records the relay replaced or discarded before they could be pulled."""
        for remote in self._announced - {state.remote for state in states}:
            reason = f"{remote.name}: the relay discarded or changed it before it could be pulled"
            self._repository.give_up_remote_record(self._relay, remote, reason)
            self._announced.discard(remote)
            log.warning("record gone", relay=self._relay, record=remote.name, reason=reason)

    def pull_untimed_again(self) -> None:
        """Pull once more what is stored, or was until somebody deleted it, and has no time.

        Where a relay gives no times, a new record of the same name and size looks like the old one.
        """
        for state in self._states.values():
            if state.life in (Life.STORED, Life.DELETED) and not state.record.modified_ns:
                state.begin_anew(Life.SETTLING)
                self.revision += 1


class WrongListings:
    """Counts by names how often a record was not as listed, for one day of UTC.

    A relay may list a file with another size and time at each look. It is then another record each time, so
    that no count of one record's attempts ever ends.
    """

    def __init__(self) -> None:
        self._day = 0
        self._numbers: Counter[str] = Counter()

    def note(self, name: str, now_ns: int) -> None:
        """Count one more."""
        self._begin_day(now_ns)
        self._numbers[name] += 1

    def number(self, name: str, now_ns: int) -> int:
        """Return how many there were today."""
        self._begin_day(now_ns)
        return self._numbers[name]

    def prune(self, listed: Iterable[str]) -> None:
        """Forget names that are gone, once there are many."""
        if len(self._numbers) > MOST_NAMES:
            self._numbers = Counter({name: self._numbers[name] for name in listed if name in self._numbers})

    def _begin_day(self, now_ns: int) -> None:
        day = now_ns // NANOSECONDS_PER_DAY
        if day != self._day:
            self._day = day
            self._numbers.clear()

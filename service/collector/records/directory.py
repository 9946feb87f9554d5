"""A relay's event directory, brought into the recording store. The directory is the truth; reports hurry.

In the end every record the relay lists is in the store, or its refusal is written down: as a rejected
recording where it is a record, as an alarm where a file's name already says that it cannot be trusted.
"""

import time
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import structlog

from core.units import NANOSECONDS_PER_DAY
from mms import (
    AccessDenied,
    Client,
    ConnectionLost,
    FileServiceFailed,
    FileSizeMismatch,
    NotFound,
    ProtocolError,
    TemporarilyUnavailable,
    Timeout,
)
from service.collector.records.alarms import RecordAlarms
from service.collector.records.allowance import DailyAllowance, beyond_its_end
from service.collector.records.event_folder import Contents, EventFolder
from service.collector.records.formats import Chosen, one_format_an_event
from service.collector.records.ledger import RecordLedger
from service.collector.records.listing import MOST_IGNORED, ListedRecord, Listing, RefusedFile, understand
from service.collector.records.pull import RecordTooLargeError, pull
from service.collector.records.retrying import LONGEST_PAUSE_OF_THE_DENIED_S, RetrySchedule
from service.collector.records.settling import Settled, Settling
from service.configuration.settings import Settings
from service.plant import Relay
from service.recording_store.store import RecordingStore, RecordingStoreError, StoredRecording
from service.storage import Repository
from service.storage.states import AlarmKind

log = structlog.get_logger(__name__)

SETTLE_S, UNTOLD_SETTLE_S = 0.2, 2.0
"""How long a record's sizes and times must stand still before it is pulled: where a report has told that it
is made, and where none has, so that the relay may be pausing while it writes."""

EARLY_S = 5.0
"""How long an event report must stand still at a relay that writes COMTRADE, too: that may be on its way."""

UNSTEADY_S = 600.0
"""How long a record may go on changing before it is an alarm."""

PULL_ATTEMPTS = 9
"""A file may be missing, or not as long as listed, while the relay is at it; hardly for the minute that so
many attempts take with their pauses."""

DENIED_ATTEMPTS = 155
"""About a day, with their pauses: a relay that opens no file for now says nothing about the record."""

ATTEMPTS_OF_A_NAME = 30
"""In all: a file that is of another size each time it is listed must not be asked for without end."""

MANY_ATTEMPTS = 5
"""A record that is denied, or ends the visit, and was not to be had this often, is an alarm."""

BREAKS_OF_THE_PROTOCOL = 2
"""By a record whose PULL_ATTEMPTS are over; the count of these holds denials too."""

DENIALS = (AccessDenied, FileServiceFailed)
"""What a relay may answer for a record that is fine: nobody may open files, it is out of memory."""

VERDICTS = (FileSizeMismatch, NotFound)
"""What one record can do wrong while the link is fine."""

LINK_FAILURES = (ConnectionLost, ProtocolError, Timeout)
"""What ends the visit, and may be due to the record that was asked for."""

Owner = Callable[[str], str | None]
"""Tells the event report, if any, that a new record of this name belongs to."""


@dataclass(frozen=True, slots=True)
class Scan:
    """What one scan of the directory came to, by names of records.

    listed: all there are.  taken: newly stored or refused for good.  waiting: new ones that are not ready, or
    are to be tried again soon, or are refused while their event is still to be had in another format.
    failing: why a pull of them failed, by names, of those that are tried again, soon or late.  held_back:
    ready ones that wait for another day.  ignored: files that are not taken, with the reason;
    `ignored_in_all` may be more.  unreachable: why no record could be had at all.  no_folder: why there is
    none at present; a relay may make it with its first record.
    """

    listed: frozenset[str]
    taken: tuple[str, ...]
    waiting: tuple[str, ...]
    held_back: tuple[str, ...]
    failing: Mapping[str, str] = field(default_factory=dict)
    ignored: tuple[RefusedFile, ...] = ()
    ignored_in_all: int = 0
    unreachable: str | None = None
    no_folder: str | None = None


@dataclass(frozen=True, slots=True)
class _View:
    """What a listing comes to, for as long as neither it nor what is known of its records changes.

    decided: how many records are stored beyond doubt, refused and hopeless; under one listing all only become
    more.  new: oldest first.  names: of all records.
    """

    contents: Contents
    decided: tuple[int, int, int]
    listing: Listing
    chosen: Chosen
    new: tuple[ListedRecord, ...]
    names: frozenset[str]


class RecordDirectory:
    """Scans one relay's directory and stores what is new. Used by that relay's session alone.

    listing_s: how long the relay took for the latest listing.
    """

    def __init__(
        self,
        relay: Relay,
        motor: str,
        repository: Repository,
        store: RecordingStore,
        settings: Settings,
        *,
        folder: EventFolder,
        alarms: RecordAlarms,
        allowance: DailyAllowance,
        on_bytes: Callable[[int], None],
    ) -> None:
        """on_bytes: is told how many bytes of a file came."""
        self._relay = relay.name
        self._store = store
        self._folder = folder
        self._max_file_bytes = settings.max_file_bytes
        self._on_bytes = on_bytes
        self._alarms = alarms
        self._allowance = allowance
        self._settling = Settling(
            settle_s=SETTLE_S,
            untold_s=UNTOLD_SETTLE_S,
            patience_s=settings.record_timeout_s,
            unsteady_s=UNSTEADY_S,
            early_s=min(EARLY_S, settings.record_timeout_s / 2),
        )
        self._retries = RetrySchedule()
        self._hopeless: set[ListedRecord] = set()
        self._view: _View | None = None
        self.listing_s = 0.0
        self._ledger = RecordLedger(relay.name, motor, repository)
        self._attempts: Counter[str] = Counter()
        self._attempts_day = 0

    def scan(self, client: Client, owner: Owner, *, told: bool) -> Scan:
        """List the directory; pull and store what is new and ready, oldest first, those that failed last.

        told: a report has just said that a record is made. Raises MmsError when the link fails, OSError when
        the disk does; what was stored until then stays.
        """
        self._ledger.recall()
        began_s = time.monotonic()
        contents = self._folder.contents(client)
        self.listing_s = time.monotonic() - began_s
        if contents.directory is None:
            unreachable = self._folder.missing if self._folder.no_files else None
            return Scan(frozenset(), (), (), (), unreachable=unreachable, no_folder=self._folder.missing)
        view = self._view = self._view_of(contents, contents.directory)
        listing, chosen, new = view.listing, view.chosen, view.new
        self._ledger.give_up_all_but(chosen.records)
        settled = self._settling.look(new, time.monotonic(), early=chosen.early, told=told)
        ready, unsteady = self._without_shape_shifters(settled)
        self._note_unsteady(unsteady, chosen)
        self._give_up_the_incomplete(settled.incomplete, chosen, contents.directory, owner)
        held_back = self._take_all(client, self._retries.due(ready, time.monotonic()), owner)
        self._retries.keep([record for record in new if not self._ledger.is_decided(record)])
        patient = {record.name for record in unsteady}.union(
            held_back, self._retries.put_off(time.monotonic())
        )
        to_come = frozenset(record for record in new if self._is_to_come(record, chosen))
        ignored = chosen.passed_over + listing.ignored
        return Scan(
            listed=view.names,
            taken=tuple(record.name for record in new if record not in to_come),
            waiting=tuple(record.name for record in new if record in to_come and record.name not in patient),
            held_back=held_back,
            failing=self._retries.reasons(),
            ignored=ignored[:MOST_IGNORED],
            ignored_in_all=len(chosen.passed_over) + listing.ignored_in_all,
        )

    def doubt_the_untimed(self) -> None:
        """A record was announced, and nothing new came: what has no time may be new, and is pulled again.

        Contents that are known make no second recording.
        """
        self._ledger.doubt_the_untimed()
        self._view = None

    def _view_of(self, contents: Contents, directory: str) -> _View:
        """Relays list hundreds of records again and again; all but a few listings are as the one before."""
        before = self._view
        if before is not None and before.contents == contents:
            listing = before.listing
        else:
            listing = understand(contents.entries, directory)
            self._note_refused_files(listing)
            self._hopeless.intersection_update(listing.records)
            self._ledger.forget_the_untimed_but(listing.records)
        sure = len(self._ledger.stored) - len(self._ledger.doubted)
        decided = (sure, len(self._ledger.refused), len(self._hopeless))
        if before is not None and before.listing is listing and before.decided == decided:
            return before
        chosen = one_format_an_event(
            listing.records, self._ledger.stored, self._ledger.refused, self._hopeless
        )
        new = [record for record in chosen.records if not self._ledger.is_decided(record)]
        new.sort(key=lambda record: (self._ledger.is_doubted(record), record.modified_ns, record.name))
        names = frozenset(record.name for record in listing.records)
        return _View(contents, decided, listing, chosen, tuple(new), names)

    def _is_to_come(self, record: ListedRecord, chosen: Chosen) -> bool:
        """Whether its event is still to be had, in another format where the record itself is refused."""
        if self._ledger.is_refused(record):
            return record in chosen.replaceable
        return not self._ledger.is_decided(record)

    def _take_all(self, client: Client, ready: tuple[ListedRecord, ...], owner: Owner) -> tuple[str, ...]:
        """Pull what is ready as far as the day's limit allows; the names of those that must wait."""
        for number, record in enumerate(ready):
            sizes = tuple(file.size for file in record.files)
            too_large = max(sizes) > self._max_file_bytes
            if not too_large and not self._allowance.allows(sizes, time.time_ns()):
                self._alarms.raise_alarm(
                    AlarmKind.DAILY_LIMIT,
                    "",
                    f"expected at most {self._allowance.limit_bytes} bytes a day (setting "
                    f"max_relay_bytes_per_day), found more; new records wait in the relay until midnight UTC",
                )
                return tuple(late.name for late in ready[number:])
            self._take(client, record, owner)
        self._alarms.keep(AlarmKind.DAILY_LIMIT, ())
        return ()

    def _note_refused_files(self, listing: Listing) -> None:
        for refused in listing.refused:
            self._alarms.raise_alarm(AlarmKind.FILE_REFUSED, refused.name, refused.reason)
        self._alarms.keep(AlarmKind.FILE_REFUSED, {refused.name for refused in listing.refused})
        self._alarms.keep(AlarmKind.FILE_TOO_LARGE, {record.name for record in listing.records})

    def _without_shape_shifters(
        self, settled: Settled
    ) -> tuple[tuple[ListedRecord, ...], tuple[ListedRecord, ...]]:
        """Ready and unsteady ones; those whose listing proved wrong too often today are not asked for."""
        today = time.time_ns() // NANOSECONDS_PER_DAY
        if self._attempts_day != today:
            self._attempts_day = today
            self._attempts.clear()
        trusted: list[ListedRecord] = []
        others = list(settled.unsteady)
        for record in settled.ready:
            (trusted if self._attempts[record.name] < ATTEMPTS_OF_A_NAME else others).append(record)
        return tuple(trusted), tuple(others)

    def _note_unsteady(self, unsteady: tuple[ListedRecord, ...], chosen: Chosen) -> None:
        for record in unsteady:
            self._alarms.raise_alarm(
                AlarmKind.FILE_UNSTEADY,
                record.name,
                f"{record.name}: expected files that stand still and are as long as listed, found others for "
                f"{UNSTEADY_S:g} s or {ATTEMPTS_OF_A_NAME} attempts",
            )
        if self._alarms.standing(AlarmKind.FILE_UNSTEADY):
            lacking = {record.name for record in chosen.records if not self._ledger.is_stored(record)}
            self._alarms.keep(AlarmKind.FILE_UNSTEADY, lacking)

    def _give_up_the_incomplete(
        self, incomplete: tuple[ListedRecord, ...], chosen: Chosen, directory: str, owner: Owner
    ) -> None:
        """Files that are not coming any more: another format is taken, or the record refused."""
        for record in incomplete:
            reason = (
                f"{record.name}: expected a {record.missing[0]} file in {directory or 'the root'}, found none"
            )
            if record in chosen.replaceable:
                self._hopeless.add(record)
                log.warning("another format is taken", relay=self._relay, record=record.name, reason=reason)
            else:
                self._refuse(record, reason, owner)

    def _take(self, client: Client, record: ListedRecord, owner: Owner) -> None:
        """Pull and store one record. Where that fails, refuse it or leave it for the next scan."""
        self._ledger.announce(record)
        try:
            stored = self._pull(client, record)
        except RecordTooLargeError as error:
            self._alarms.raise_alarm(AlarmKind.FILE_TOO_LARGE, record.name, str(error))
            self._refuse(record, str(error), owner)
            return
        except RecordingStoreError as error:
            self._refuse(record, str(error), owner)
            return
        except TemporarilyUnavailable as error:
            self._retries.failed(record, str(error), time.monotonic())
            log.info("record busy", relay=self._relay, record=record.name, reason=str(error))
            return
        except DENIALS as error:
            self._note_denial(record, f"{record.name}: {error}", owner)
            return
        except VERDICTS as error:
            self._note_verdict(record, f"{record.name}: {error}", owner)
            return
        except LINK_FAILURES as error:
            self._note_lost_link(record, str(error))
            if isinstance(error, ProtocolError):
                self._note_broken_protocol(record, f"{record.name}: {error}", owner)
            raise
        self._ledger.keep(record, stored, owner(record.name))

    def _pull(self, client: Client, record: ListedRecord) -> StoredRecording:
        stored = pull(
            client, record, self._store, max_file_bytes=self._max_file_bytes, on_bytes=self._received
        )
        for file in record.files:
            self._allowance.charge(beyond_its_end(file.size), time.time_ns())
        return stored

    def _received(self, number_of_bytes: int) -> None:
        self._on_bytes(number_of_bytes)
        self._allowance.charge(number_of_bytes, time.time_ns())

    def _note_lost_link(self, record: ListedRecord, reason: str) -> None:
        attempts = self._retries.failed(record, reason, time.monotonic())
        if attempts >= MANY_ATTEMPTS:
            told = f"{record.name}: not fetched in {attempts} attempts, the latest ended the link: {reason}"
            self._alarms.raise_alarm(AlarmKind.FILE_UNSTEADY, record.name, told)

    def _note_broken_protocol(self, record: ListedRecord, reason: str, owner: Owner) -> None:
        """One record that a relay cannot give must not set aside the relay for ever longer."""
        attempts = self._ledger.note_failed_pull(record, reason)
        if attempts >= PULL_ATTEMPTS and self._retries.number(record) >= BREAKS_OF_THE_PROTOCOL:
            self._refuse(record, reason, owner)

    def _note_denial(self, record: ListedRecord, reason: str, owner: Owner) -> None:
        self._retries.failed(record, reason, time.monotonic(), longest_s=LONGEST_PAUSE_OF_THE_DENIED_S)
        attempts = self._ledger.note_failed_pull(record, reason)
        if attempts >= MANY_ATTEMPTS:
            told = f"{reason}, {attempts} times; it is asked for again, for about a day"
            self._alarms.raise_alarm(AlarmKind.FILE_UNSTEADY, record.name, told)
        if attempts >= DENIED_ATTEMPTS:
            self._refuse(record, reason, owner)

    def _note_verdict(self, record: ListedRecord, reason: str, owner: Owner) -> None:
        """Counted since the start, because the count in the database holds denials too; that bounds it."""
        self._attempts[record.name] += 1
        self._retries.failed(record, reason, time.monotonic(), is_verdict=True)
        attempts = self._ledger.note_failed_pull(record, reason)
        if self._retries.verdicts(record) >= PULL_ATTEMPTS or attempts >= DENIED_ATTEMPTS:
            self._refuse(record, reason, owner)

    def _refuse(self, record: ListedRecord, reason: str, owner: Owner) -> None:
        """The record is not pulled again; its event report fails only where no other format is left."""
        has_another = self._view is not None and record in self._view.chosen.replaceable
        self._ledger.refuse(record, reason, None if has_another else owner(record.name))
        told = "record refused, another format is taken" if has_another else "record refused"
        log.warning(told, relay=self._relay, record=record.name, reason=reason)

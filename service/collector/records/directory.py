"""A relay's event folders, brought into the recording store.

The directory is what counts; reports only say when to look. In the end every record the relay lists is in the
store, or its refusal is written down: as a rejected recording where it is a record, as an alarm where a
file's name already says that it cannot be trusted.
"""

import time
from collections.abc import Callable, Collection
from dataclasses import dataclass
from math import inf
from typing import Protocol

import structlog

from mms import AccessDenied, Client, NotFound, ServiceFailed, TemporarilyUnavailable
from service.collector.records.batch import Batch
from service.collector.records.event_folders import Contents, EventFolders
from service.collector.records.formats import Chosen, one_format_an_event
from service.collector.records.ledger import RecordLedger, WrongListings
from service.collector.records.life import WHOLE, Life, RecordState, SettlingTimes, in_turn
from service.collector.records.listing import MOST_IGNORED, Listing, files_by_name, understand
from service.collector.records.policy import (
    PULL_FAILURES,
    RECORD_POLICY,
    VISIT_ENDS,
    Attempts,
    Failure,
    RecordPolicy,
    alarm_text,
    failure_of,
    reason_of,
)
from service.collector.records.pull import DailyAllowance
from service.collector.records.scan import Scan
from service.configuration.settings import Settings
from service.plant import Relay
from service.recording_store.errors import StoreUnreachableError
from service.recording_store.recording import StoredRecording
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.errors import FolderGoneError
from service.storage.records import RemoteRecord
from service.storage.states import AlarmKind

log = structlog.get_logger(__name__)

ANNOUNCED_S = 1.0
"""A record that is fetched within this time is not announced before: it appears as it is stored."""

PULL_MARGIN = 2.0
"""A pull may take so many times as long as the latest one lets expect."""

ClaimRequest = Callable[[RemoteRecord], str | None]
"""Returns the recording request, if any, that a new record belongs to."""


class RecordAlarms(Protocol):
    """The alarms of one relay, each raised once however often its cause is seen."""

    def standing(self, kind: AlarmKind) -> frozenset[str]:
        """Return the subjects of the alarms of this kind."""

    def raise_alarm(self, kind: AlarmKind, subject: str, reason: str) -> None:
        """Raise an alarm unless it stands already."""

    def keep(self, kind: AlarmKind, subjects: Collection[str]) -> None:
        """Clear the alarms of this kind whose subject is not among these."""


@dataclass(frozen=True, slots=True)
class _View:
    """What a listing comes to. It holds while neither the listing nor the ledger's revision changes.

    new: records that are waited for, oldest first.  records: all of them.
    """

    contents: Contents
    listing: Listing
    states: list[RecordState]
    revision: int
    chosen: Chosen
    new: tuple[RecordState, ...]
    records: frozenset[RemoteRecord]


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
        folders: EventFolders,
        alarms: RecordAlarms,
        allowance: DailyAllowance,
        on_bytes: Callable[[int], None],
        policy: RecordPolicy = RECORD_POLICY,
    ) -> None:
        """Follow the records of one relay.

        on_bytes: gets the number of bytes of every part of a file that came.
        """
        self._relay = relay.name
        self._store = store
        self._folders = folders
        self._max_file_bytes = settings.max_file_bytes
        self._record_timeout_s = settings.record_timeout_s
        self._on_bytes = on_bytes
        self._alarms = alarms
        self._allowance = allowance
        self._policy = policy
        self._ledger = RecordLedger(relay.name, motor, repository)
        self._wrong_listings = WrongListings()
        self._view: _View | None = None
        self._not_listed_since_s: float | None = None
        self._bytes_per_s = 0.0
        self.listing_s = 0.0

    def scan(self, client: Client, claim: ClaimRequest, *, expected: bool, within_s: float = inf) -> Scan:
        """List the directory; pull and store what is new and ready, oldest first, those that failed last.

        expected: a report has just said that a record was made.  within_s: what would probably take longer is
        left for a later scan [s]. Raises MmsError when the link fails, OSError
        when the disk does; what was stored until then stays.
        """
        began_s = time.monotonic()
        try:
            contents = self._folders.contents(client, expected=expected)
        except (ServiceFailed, TemporarilyUnavailable) as error:
            return self._not_listed(str(error), began_s)
        finally:
            self.listing_s = time.monotonic() - began_s
        if not contents.folders:
            unreachable = self._folders.missing if self._folders.no_files else None
            return Scan(unreachable=unreachable, no_folder=self._folders.missing)
        self._not_listed_since_s = None
        view = self._view = self._view_of(contents)
        self._ledger.give_up_all_but(view.chosen.states)
        self._settle(view, expected=expected)
        ready, unsteady = self._ready_and_unsteady(view.new)
        self._note_unsteady(unsteady, view.chosen)
        self._end_incomplete(view, claim)
        held_back = self._take_all(
            client, in_turn(ready, time.monotonic()), claim, until_s=began_s + within_s
        )
        return self._outcome(view, unsteady, held_back)

    def _not_listed(self, reason: str, now_s: float) -> Scan:
        """Note that the relay lists no files for now; it is an alarm when that lasts."""
        if self._not_listed_since_s is None:
            self._not_listed_since_s = now_s
            log.info("the relay lists no files for now", relay=self._relay, reason=reason)
        if now_s - self._not_listed_since_s > self._record_timeout_s:
            self._alarms.raise_alarm(
                AlarmKind.FILE_UNSTEADY,
                "",
                f"expected a listing of the relay's files, found none for {self._record_timeout_s:g} s: "
                f"{reason}; no recording is fetched meanwhile",
            )
        return Scan(busy=reason)

    def pull_untimed_again(self) -> None:
        """Pull once more what is stored and has no time, at the next scan.

        This is for a record that was announced where nothing new was listed: it may look like an old one.
        Contents that are known make no second recording.
        """
        self._ledger.pull_untimed_again()

    def _view_of(self, contents: Contents) -> _View:
        """Return what the listing comes to.

        Relays list hundreds of records again and again, and nearly every listing is as the one before.
        """
        before = self._view
        if before is not None and before.contents == contents:
            if before.revision == self._ledger.revision:
                return before
            listing, states = before.listing, before.states
        else:
            listing = understand(contents.folders)
            self._note_refused_files(listing)
            states = self._ledger.follow(listing.records)
            self._wrong_listings.prune(state.name for state in states)
        chosen = one_format_an_event(states)
        self._ledger.pass_over(set(states).difference(chosen.states))
        new = [state for state in chosen.states if not state.is_decided]
        new.sort(key=lambda state: (state.in_store, state.record.modified_ns, state.name))
        records = frozenset(state.remote for state in states)
        return _View(contents, listing, states, self._ledger.revision, chosen, tuple(new), records)

    def _settle(self, view: _View, *, expected: bool) -> None:
        """Judge each new record by whether it has come whole and stopped changing."""
        policy = self._policy
        still_s = policy.expected_settle_s if expected else policy.settle_s
        other_format_s = min(policy.other_format_s, self._record_timeout_s / 2)
        times, early = (
            SettlingTimes(each_s, self._record_timeout_s, policy.unsteady_s)
            for each_s in (still_s, max(still_s, other_format_s))
        )
        now_s = time.monotonic()
        for state in view.new:
            state.settle(now_s, early if state in view.chosen.early else times)

    def _ready_and_unsteady(
        self, new: tuple[RecordState, ...]
    ) -> tuple[list[RecordState], list[RecordState]]:
        """Return the records that may be pulled, and those that are not waited for in a hurry.

        Records whose listing proved wrong too often today are not asked for, though they stand still.
        """
        ready: list[RecordState] = []
        unsteady = [state for state in new if state.life is Life.UNSTEADY]
        now_ns = time.time_ns()
        for state in new:
            if state.life in WHOLE:
                wrong = self._wrong_listings.number(state.name, now_ns)
                (ready if wrong < self._policy.wrong_listings_a_day else unsteady).append(state)
        return ready, unsteady

    def _note_refused_files(self, listing: Listing) -> None:
        for refused in listing.refused:
            self._alarms.raise_alarm(AlarmKind.FILE_REFUSED, refused.name, refused.reason)
        self._alarms.keep(AlarmKind.FILE_REFUSED, {refused.name for refused in listing.refused})
        self._alarms.keep(AlarmKind.FILE_TOO_LARGE, {record.name for record in listing.records})

    def _note_unsteady(self, unsteady: list[RecordState], chosen: Chosen) -> None:
        for state in unsteady:
            self._alarms.raise_alarm(
                AlarmKind.FILE_UNSTEADY,
                state.name,
                f"{state.name}: expected files that stand still and are as long as listed, found others for "
                f"{self._policy.unsteady_s:g} s or {self._policy.wrong_listings_a_day} attempts",
            )
        if self._alarms.standing(AlarmKind.FILE_UNSTEADY):
            lacking = {state.name for state in chosen.states if not state.in_store}
            self._alarms.keep(AlarmKind.FILE_UNSTEADY, lacking)

    def _end_incomplete(self, view: _View, claim: ClaimRequest) -> None:
        """Take another format in place of a record whose files are not coming, or refuse the record."""
        for state in view.new:
            if state.life is not Life.INCOMPLETE:
                continue
            missing = state.record.missing[0]
            directory = state.record.directory or "the root"
            reason = f"{state.name}: expected a {missing} file in {directory}, found none"
            if state in view.chosen.replaceable:
                self._ledger.give_up(state)
                log.warning("another format is taken", relay=self._relay, record=state.name, reason=reason)
            else:
                self._refuse(state, reason, claim)

    def _take_all(
        self, client: Client, ready: list[RecordState], claim: ClaimRequest, *, until_s: float
    ) -> tuple[RecordState, ...]:
        """Pull what is ready as far as the day's limit allows. Return those that must wait."""
        problem = self._store.problem() if ready else None
        if problem is not None:  # what is pulled could not be kept: the relay keeps it
            for state in ready:
                self._fail(state, StoreUnreachableError(problem), claim)
            return ()
        with Batch(
            client,
            self._store,
            self._allowance,
            max_file_bytes=self._max_file_bytes,
            on_bytes=self._on_bytes,
            listing_s=self.listing_s,
        ) as batch:
            for number, state in enumerate(ready):
                sizes = tuple(file.size for file in state.record.files)
                takes_s = PULL_MARGIN * self._takes_s(sum(sizes)) + self.listing_s
                if time.monotonic() + takes_s > until_s:
                    self._keep_all(client, batch, claim)
                    return ()
                too_large = max(sizes) > self._max_file_bytes
                if not too_large and not self._allowance.allows(sizes, time.time_ns()):
                    self._keep_all(client, batch, claim)
                    self._alarms.raise_alarm(
                        AlarmKind.DAILY_LIMIT,
                        "",
                        f"expected at most {self._allowance.limit_bytes} bytes a day (setting "
                        "max_relay_bytes_per_day), found more; new records wait in the relay until midnight "
                        "UTC",
                    )
                    return tuple(ready[number:])
                # A record that failed before may end the visit: what was fetched is kept first.
                if batch.is_due() or state.attempts:
                    self._keep_all(client, batch, claim)
                self._fetch(batch, state, claim)
            self._keep_all(client, batch, claim)
        self._alarms.keep(AlarmKind.DAILY_LIMIT, ())
        return ()

    def _fetch(self, batch: Batch, state: RecordState, claim: ClaimRequest) -> None:
        """Fetch one record. Where that fails, refuse it or leave it for the next scan."""
        if self._takes_s(state.record.size_bytes) > ANNOUNCED_S:
            self._ledger.announce(state)
        began_s = time.monotonic()
        try:
            batch.fetch(state)
        except PULL_FAILURES as error:
            self._fail(state, error, claim)
        else:
            self._bytes_per_s = state.record.size_bytes / (time.monotonic() - began_s)

    def _keep_all(self, client: Client, batch: Batch, claim: ClaimRequest) -> None:
        """Keep what was fetched and is still listed as it was; the rest fails. Raises MmsError (the link)."""
        if not batch.fetched:
            return
        try:
            listed = files_by_name(self._folders.listed_now(client).folders)
        except (AccessDenied, NotFound, ServiceFailed, TemporarilyUnavailable) as error:
            for state, _ in batch.fetched:
                self._fail(state, error, claim)
        else:
            confirmed, failed = batch.checked(listed)
            for state, on_disk in batch.kept(confirmed):
                try:
                    self._keep(state, on_disk, claim)
                except PULL_FAILURES as error:
                    self._fail(state, error, claim)
            for state, reason in failed:
                self._fail(state, reason, claim)
        batch.clear()

    def _keep(self, state: RecordState, on_disk: Callable[[], StoredRecording], claim: ClaimRequest) -> None:
        try:
            self._ledger.keep(state, on_disk(), claim(state.remote))
        except FolderGoneError as error:  # somebody deleted the same content just now
            log.info("record pulled once more", relay=self._relay, record=state.name, reason=str(error))

    def _takes_s(self, size: int) -> float:
        """Return how long a pull of so many bytes takes, by the latest one; infinite where there was none."""
        return size / self._bytes_per_s if self._bytes_per_s else inf

    def _fail(self, state: RecordState, error: Exception, claim: ClaimRequest) -> None:
        """Note a failed attempt. Raises the error again where it ends the visit."""
        failure = failure_of(error)
        self._ledger.announce(state)
        self._note_failure(state, failure, error, claim)
        if failure in VISIT_ENDS:
            raise error

    def _note_failure(
        self, state: RecordState, failure: Failure, error: Exception, claim: ClaimRequest
    ) -> None:
        """Do what the policy says of this kind of failure: pause, alarm, refusal."""
        rule = self._policy.rules[failure]
        reason = reason_of(failure, state.name, error)
        final_reason = f"{state.name}: {error}" if rule.is_counted else str(error)
        state.fail(failure, reason, time.monotonic(), rule)
        if failure is Failure.NOT_AS_LISTED:
            self._wrong_listings.note(state.name, time.time_ns())
        attempts = Attempts(
            of_kind=state.failures[failure],
            since_start=state.attempts,
            in_all=self._ledger.count_attempt(state, final_reason) if rule.is_counted else 0,
        )
        if failure is Failure.BUSY:
            log.info("record busy", relay=self._relay, record=state.name, reason=reason)
        if failure is Failure.STORE_AWAY:
            log.warning("record waits in its relay", relay=self._relay, record=state.name, reason=reason)
        if attempts.reach(rule.alarm_after):
            text = alarm_text(failure, state.name, reason, attempts)
            self._alarms.raise_alarm(rule.alarm, state.name, text)
        if attempts.reach(rule.refuse_after):
            self._refuse(state, final_reason, claim)

    def _refuse(self, state: RecordState, reason: str, claim: ClaimRequest) -> None:
        """Do not pull the record again. Its request fails only where no other format is left."""
        has_another = self._view is not None and state in self._view.chosen.replaceable
        self._ledger.refuse(state, reason, None if has_another else claim(state.remote))
        outcome = "record refused, another format is taken" if has_another else "record refused"
        log.warning(outcome, relay=self._relay, record=state.name, reason=reason)

    def _outcome(self, view: _View, unsteady: list[RecordState], held_back: tuple[RecordState, ...]) -> Scan:
        now_s = time.monotonic()
        to_come = {state for state in view.new if _is_to_come(state, view.chosen)}
        not_soon = {*unsteady, *held_back}.union(
            state for state in view.new if state.pause_s(now_s) > self._policy.soon_s
        )
        ignored = view.chosen.passed_over + view.listing.ignored
        return Scan(
            listed=view.records,
            taken=tuple(state.name for state in view.new if state not in to_come),
            waiting=tuple(state.remote for state in view.new if state in to_come and state not in not_soon),
            held_back=tuple(state.remote for state in held_back),
            failing={state.remote: state.reason for state in view.new if state.reason is not None},
            ignored=ignored[:MOST_IGNORED],
            ignored_in_all=len(view.chosen.passed_over) + view.listing.ignored_in_all,
        )


def _is_to_come(state: RecordState, chosen: Chosen) -> bool:
    """Return whether its event is still to be had, in another format where the record itself is refused."""
    if state.life is Life.REFUSED:
        return state in chosen.replaceable
    return not state.is_decided

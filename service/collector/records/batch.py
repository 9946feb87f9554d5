"""Records that were fetched together and are kept together, once the relay lists them as before.

A relay whose numbering begins anew writes a new record over an old one of the same name, maybe while that is
fetched: a .CFG of one record would come with the .DAT of another. So the relay is asked for its listing once
more before anything is kept. One listing serves all records that were fetched within a short time.

To have a record on disk takes longer than to fetch a small one, nearly all of it waiting. So several threads
do it: a file system writes its journal once for all who wait for it.
"""

import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import Executor, Future, ThreadPoolExecutor, wait
from contextlib import ExitStack
from functools import cache
from hashlib import sha256
from types import TracebackType
from typing import Self

from mms import Client
from service.collector.records.errors import RecordReplacedError
from service.collector.records.life import RecordState
from service.collector.records.listing import ListedFile, ListedRecord
from service.collector.records.policy import PULL_FAILURES, VISIT_ENDS, failure_of
from service.collector.records.pull import DailyAllowance, beyond_its_end, pull
from service.recording_store.arriving import Incoming
from service.recording_store.recording import StoredRecording
from service.recording_store.store import RecordingStore

BATCH_S = 0.25
"""What was fetched waits about so long for the listing that confirms it; if the link ends, it comes anew."""

LISTINGS_A_BATCH = 4.0
"""It waits so many times as long as a listing takes, where that is longer."""

WRITTEN_AT_ONCE = 8
"""Records that a process has on disk at a time, beside those that sessions write alone."""


@cache
def _writers() -> Executor:
    """Return the threads that wait for the disk, for all sessions of this process."""
    return ThreadPoolExecutor(WRITTEN_AT_ONCE, thread_name_prefix="record-writer")


class Batch:
    """Records fetched since the last confirmation. What is not kept is removed when the block ends."""

    def __init__(
        self,
        client: Client,
        store: RecordingStore,
        allowance: DailyAllowance,
        *,
        max_file_bytes: int,
        on_bytes: Callable[[int], None],
        listing_s: float,
    ) -> None:
        """listing_s: how long the relay takes for a listing."""
        self._client = client
        self._store = store
        self._allowance = allowance
        self._max_file_bytes = max_file_bytes
        self._on_bytes = on_bytes
        self._lasts_s = max(BATCH_S, LISTINGS_A_BATCH * listing_s)
        self._places = ExitStack()
        self._fetched: list[tuple[RecordState, Incoming]] = []
        self._syncing: dict[Incoming, Future[None]] = {}
        self._keeping: list[Future[StoredRecording]] = []
        self._began_s = 0.0

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.clear()

    @property
    def fetched(self) -> tuple[tuple[RecordState, Incoming], ...]:
        """Return the records, and where their files are."""
        return tuple(self._fetched)

    def is_due(self) -> bool:
        """Return whether records wait that should be kept before more is fetched."""
        return bool(self._fetched) and time.monotonic() >= self._began_s + self._lasts_s

    def clear(self) -> None:
        """Forget the records; remove the files of those that were not kept."""
        wait(self._syncing.values())
        wait(self._keeping)
        self._fetched.clear()
        self._syncing.clear()
        self._keeping.clear()
        self._places.close()

    def fetch(self, state: RecordState) -> None:
        """Fetch the files of one record. Raises what `pull` raises."""
        if not self._fetched:
            self._began_s = time.monotonic()
        incoming = self._places.enter_context(self._store.incoming())
        pull(
            self._client,
            state.record,
            incoming,
            max_file_bytes=self._max_file_bytes,
            on_bytes=self._received,
        )
        for file in state.record.files:
            self._allowance.charge(beyond_its_end(file.size), time.time_ns())
        self._fetched.append((state, incoming))
        if len(self._fetched) > 1:  # one alone waits for nobody
            self._syncing[incoming] = _writers().submit(incoming.sync)

    def kept(
        self, records: Iterable[tuple[RecordState, Incoming]]
    ) -> Iterator[tuple[RecordState, Callable[[], StoredRecording]]]:
        """Have these of the records moved to their places, and yield each with what waits for it.

        That raises OSError, RecordingStoreError.
        """
        chosen = list(records)
        if len(chosen) == 1:
            ((state, incoming),) = chosen
            yield state, lambda: self._on_disk(incoming)
            return
        keeping = [_writers().submit(self._on_disk, incoming) for _, incoming in chosen]
        self._keeping += keeping
        for (state, _), kept in zip(chosen, keeping, strict=True):
            yield state, kept.result

    def _on_disk(self, incoming: Incoming) -> StoredRecording:
        """Keep a record whose files may be on their way to the disk."""
        if incoming in self._syncing:
            self._syncing[incoming].result()  # of its error the files themselves tell once only
        return incoming.keep()

    def checked(
        self, listed: Mapping[str, ListedFile]
    ) -> tuple[list[tuple[RecordState, Incoming]], list[tuple[RecordState, Exception]]]:
        """Return the records that the relay still has as they were fetched, and those of which it does not.

        Each of the others has its error. After one that ends the visit no more is checked.
        listed: the files that the relay lists now, by their names.
        """
        confirmed: list[tuple[RecordState, Incoming]] = []
        failed: list[tuple[RecordState, Exception]] = []
        for state, incoming in self._fetched:
            try:
                self._check(state.record, incoming, listed)
            except PULL_FAILURES as error:
                failed.append((state, error))
                if failure_of(error) in VISIT_ENDS:
                    break
            else:
                confirmed.append((state, incoming))
        return confirmed, failed

    def _check(self, record: ListedRecord, incoming: Incoming, listed: Mapping[str, ListedFile]) -> None:
        """Raise RecordReplacedError where the relay no longer has the files that were fetched; MmsError.

        A file without a time looks the same when it is replaced. The configuration is then fetched once more:
        it tells when the record began, so that of another record it differs.
        """
        for file in record.files:
            now = listed.get(file.remote_name)
            if now != file:
                found = "none" if now is None else f"one of {now.size} bytes and another time"
                raise RecordReplacedError(
                    f"{file.local_name}: expected the file of {file.size} bytes that was listed before, "
                    f"found {found} after it was fetched: the relay has replaced the record"
                )
        if len(record.files) > 1 and not all(file.modified_ns for file in record.files):
            self._compare_configuration(record, incoming)

    def _compare_configuration(self, record: ListedRecord, incoming: Incoming) -> None:
        configuration = next(file for file in record.files if file.local_name.upper().endswith(".CFG"))
        again = _Digest(self._received)
        self._client.download(configuration.remote_name, again, expected_size=configuration.size)
        if again.sha256.hexdigest() != incoming.sha256(configuration.local_name):
            raise RecordReplacedError(
                f"{configuration.local_name}: expected the content that came before the samples, found "
                "another after them: the relay has replaced the record"
            )

    def _received(self, number_of_bytes: int) -> None:
        self._on_bytes(number_of_bytes)
        self._allowance.charge(number_of_bytes, time.time_ns())


class _Digest:
    """Takes a file's bytes and keeps their digest alone."""

    def __init__(self, on_bytes: Callable[[int], None]) -> None:
        self.sha256 = sha256()
        self._on_bytes = on_bytes

    def write(self, chunk: bytes, /) -> None:
        self.sha256.update(chunk)
        self._on_bytes(len(chunk))

"""Joins the recordings of a series into one, once all of them are diagnosed.

The recordings of the series stay as they are, whatever becomes of the joined one. That is a recording of its
own: it is stored, diagnosed, listed and deleted as others are. The motor's condition does not follow from it,
because it follows from its parts already. Of the rotor it tells in their place, for it is longer.
"""

from collections.abc import Mapping
from concurrent.futures import TimeoutError as NoAnswerInTimeError
from pathlib import PurePath

import structlog

from core.units import NANOSECONDS_PER_SECOND
from service.background.joined_files import JoinedFile, JoinTask, NotJoined, join_files
from service.recording_store.store import RecordingStore, RecordingStoreError
from service.storage import Repository
from service.storage.errors import FolderGoneError
from service.storage.records import Series
from service.waveforms.computing import ANSWER_TIMEOUT_S, Compute, NoAnswerError

log = structlog.get_logger(__name__)

PERIOD_S = 2.0
PATIENCE_S = 120.0
"""A series that lacks recordings is joined from those that came, once so much time has passed."""


class SeriesJoiner:
    """Joins what is ready. Several services may share a database: what one has joined, others find joined."""

    def __init__(
        self,
        repository: Repository,
        store: RecordingStore,
        compute: Compute,
        *,
        time_zones: Mapping[str, str],
        patience_s: float = PATIENCE_S,
    ) -> None:
        """time_zones: of the clocks of relays that do not run in UTC, by motor."""
        self._repository = repository
        self._store = store
        self._compute = compute
        self._time_zones = time_zones
        self._patience_ns = round(patience_s * NANOSECONDS_PER_SECOND)
        self._first_seen_ns: dict[str, int] = {}

    def join_ready(self, now_ns: int) -> None:
        """Join the series that are complete, or have waited long enough. Raises SQLAlchemyError, OSError."""
        waiting = self._repository.series_to_join(now_ns=now_ns)
        seen = {one.request_id: self._first_seen_ns.get(one.request_id, now_ns) for one in waiting}
        self._first_seen_ns = seen
        for series in waiting:
            if series.is_complete or now_ns >= seen[series.request_id] + self._patience_ns:
                self._join(series, now_ns)

    def _join(self, series: Series, now_ns: int) -> None:
        try:
            entries = tuple(self._store.entry(digest) for digest in series.digests)
        except RecordingStoreError as error:
            self._repository.leave_unjoined(series, str(error))
            return
        task = JoinTask(entries, series.recorded_ns, self._time_zones.get(series.motor))
        try:
            joined = self._compute(join_files, task).result(ANSWER_TIMEOUT_S)
        except (NoAnswerError, NoAnswerInTimeError) as error:
            log.warning("series not joined yet", motor=series.motor, reason=str(error))
            return
        match joined:
            case NotJoined(reason):
                self._repository.leave_unjoined(series, reason)
                log.warning("series not joined", motor=series.motor, reason=reason)
            case JoinedFile():
                self._keep(series, joined, entries[joined.parts[0]], now_ns)

    def _keep(self, series: Series, joined: JoinedFile, first: PurePath, now_ns: int) -> None:
        stored = self._store.store({f"{first.stem}_{len(joined.parts)}.CFF": joined.content})
        remark = "; ".join(joined.refusals) or None
        if remark is None and not series.is_complete:
            remark = f"only {len(joined.parts)} of its recordings came"
        try:
            made = self._repository.add_joined(stored, series, joined.parts, remark, now_ns=now_ns)
        except FolderGoneError:  # a recording of the same content was deleted just now: the next round
            return
        log.info(
            "series joined",
            motor=series.motor,
            recording=made,
            parts=len(joined.parts),
            duration_s=round(joined.duration_s, 3),
        )

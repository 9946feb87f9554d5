"""Joins the recordings of a series into one, once all of them are diagnosed.

The recordings of the series stay as they are, whatever becomes of the joined one. That is a recording of its
own: it is stored, diagnosed, listed and deleted as others are. The motor's condition does not follow from it,
because it follows from its parts already. Of the rotor it tells in their place, for it is longer.
"""

from collections.abc import Collection, Mapping
from concurrent.futures import TimeoutError as NoAnswerInTimeError
from typing import Final

import structlog

from core.operation import Operation
from core.time_stamps import rfc3339
from core.units import NANOSECONDS_PER_SECOND
from service.background.joined_files import JoinedFile, JoinTask, NotJoined, join_files
from service.recording_store.errors import RecordingStoreError
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.errors import FolderGoneError
from service.storage.records import Series, SeriesEnd
from service.waveforms.computing import ANSWER_TIMEOUT_S, Compute, NoAnswerError

log = structlog.get_logger(__name__)

PERIOD_S = 2.0
PATIENCE_S = 120.0
"""A series that lacks recordings is joined from those that came, once so much time has passed."""

ENDS: Final[Mapping[Operation, str]] = {
    Operation.TRIP: "the relay trips the motor",
    Operation.STOP: "the motor is switched off",
    Operation.START: "the motor starts",
    Operation.NOT_RUNNING: "the motor stands",
}
"""What a motor does that does not run. Such a recording is left out whole: at which of its samples the motor
still runs is not kept with it, and all that is lost is a fraction of a second."""


class SeriesJoiner:
    """Joins what is ready. Several services may share a database: what one has joined, others find joined."""

    def __init__(
        self,
        repository: Repository,
        store: RecordingStore,
        compute: Compute,
        *,
        time_zones: Mapping[str, str],
        lenient: Collection[str] = (),
        patience_s: float = PATIENCE_S,
    ) -> None:
        """time_zones: of the clocks of relays that do not run in UTC, by motor.

        lenient: motors whose relays' recordings are mended where they are at fault.
        """
        self._repository = repository
        self._store = store
        self._compute = compute
        self._time_zones = time_zones
        self._lenient = lenient
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
        if series.ended_by is not None and len(series.digests) < 2:
            self._repository.leave_unjoined(series, f"not joined: {_end(series.ended_by)}")
            return
        try:
            sources = tuple(self._store.source(digest) for digest in series.digests)
        except RecordingStoreError as error:
            self._repository.leave_unjoined(series, str(error))
            return
        task = JoinTask(
            sources,
            series.recorded_ns,
            self._time_zones.get(series.motor),
            lenient=series.motor in self._lenient,
        )
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
                self._keep(series, joined, now_ns)

    def _keep(self, series: Series, joined: JoinedFile, now_ns: int) -> None:
        stored = self._store.store({f"{joined.name}_{len(joined.parts)}.CFF": joined.content})
        reasons = list(joined.refusals)
        if series.ended_by is not None:
            reasons.append(f"shorter than asked for: {_end(series.ended_by)}")
        elif not reasons and not series.is_complete:
            reasons.append(f"only {len(joined.parts)} of its recordings came")
        remark = "; ".join(reasons) or None
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


def _end(ended_by: SeriesEnd) -> str:
    return f"{ENDS[ended_by.operation]} in {ended_by.name} at {rfc3339(ended_by.recorded_ns)}"

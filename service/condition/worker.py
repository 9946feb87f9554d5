"""What worker processes do for the conditions of motors: fold what is new, observe what is stored.

A task reads from the database and writes to it itself, in short transactions, and ends soon: a diagnosis that
waits for a worker does not wait long. A worker that is killed loses the transaction under way, no more.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from time import monotonic, time_ns

import structlog

from core.condition.observation import Observation
from core.diagnosis.errors import DiagnosisError
from core.machines.parameters import Motor
from core.machines.table_layout import layout_of
from core.recordings import RecordingError, read
from service.alarms.condition_rules import AT_ONCE, ConditionRules
from service.condition.record_times import ImpossibleTimeError, require_possible_time
from service.recording_store.errors import RecordingStoreError
from service.recording_store.store import RecordingStore
from service.storage.engine import connect
from service.storage.records import ToObserve
from service.storage.repository import Repository
from service.storage.transaction_limits import USUAL, TransactionLimits

log = structlog.get_logger(__name__)

ROUND_S = 0.5
"""A task ends after about so long; the next one goes on."""

RECORDS_A_FOLD = 2000
"""Records that are folded before the database has them: a transaction takes some ten milliseconds."""

MOST_VALUES = 8_000_000
"""A longer recording tells nothing of the condition, as it is not diagnosed either."""


@dataclass(frozen=True, slots=True)
class FoldTask:
    """Name a motor to fold, as the motors file has it, the database, and when its alarms are raised."""

    database_url: str
    motor: Motor
    round_s: float = ROUND_S
    alarm_rules: ConditionRules = AT_ONCE
    limits: TransactionLimits = USUAL


@dataclass(frozen=True, slots=True)
class ObserveTask:
    """Name recordings of a motor to observe, and the store that has their files."""

    database_url: str
    store: RecordingStore
    motor: Motor
    recordings: Sequence[ToObserve]
    limits: TransactionLimits = USUAL


def fold_motor(task: FoldTask) -> int:
    """Fold what is due of a motor, for about a round; return how many records that were.

    Raises NotFoundError, RecordFoldError, SQLAlchemyError.
    """
    repository = _repository(task.database_url, task.limits)
    return fold_due(repository, task.motor, task.round_s, alarm_rules=task.alarm_rules)


def fold_due(
    repository: Repository, motor: Motor, round_s: float = ROUND_S, *, alarm_rules: ConditionRules = AT_ONCE
) -> int:
    """Fold what is due of a motor, for about a round; return how many records that were.

    Of two that fold the same motor, the slower begins again.
    Raises NotFoundError, RecordFoldError, SQLAlchemyError.
    """
    from service.condition.folding import UnreadableCheckpointError, fold

    end_s = monotonic() + round_s
    number = 0
    while (due := repository.begin_fold(motor.name, RECORDS_A_FOLD)) is not None:
        try:
            result = fold(due, motor)
        except UnreadableCheckpointError as error:
            log.info("folded from the first record on", motor=motor.name, reason=str(error))
            repository.forget_checkpoints(motor.name)
            continue
        if repository.finish_fold(due, result, now_ns=time_ns(), rules=alarm_rules):
            number += len(due.observations)
            if due.next_ns is None:  # what came meanwhile has a mark, and the next task takes it
                break
        if monotonic() >= end_s:
            break
    return number


def observe_recordings(task: ObserveTask) -> int:
    """Observe recordings that were diagnosed before there were observations; return how many.

    Raises SQLAlchemyError, OSError.
    """
    repository = _repository(task.database_url, task.limits)
    return repository.add_observations(list(_observed(task)))


def _observed(task: ObserveTask) -> Iterator[tuple[str, Observation | None]]:
    """Yield what each recording tells, for about a round."""
    from core.condition.measuring.observing import observe

    end_s = monotonic() + ROUND_S
    for one in task.recordings:
        try:
            with task.store.opened(one.digest) as entry:
                motor = task.motor
                recording = read(
                    entry, lenient=motor.reads_leniently, most_values=MOST_VALUES, layout=layout_of(motor)
                )
            observation = observe(recording, task.motor)
            if observation is not None:
                # The file may have local time; its diagnosis found out the UTC.
                observation = replace(observation, time_ns=one.recorded_ns)
                require_possible_time(observation.time_ns, time_ns())
            yield one.recording_id, observation
        except (RecordingError, DiagnosisError, RecordingStoreError, ImpossibleTimeError) as error:
            log.warning("recording tells nothing", recording=one.recording_id, reason=str(error))
            yield one.recording_id, None
        if monotonic() >= end_s:
            return


@lru_cache(maxsize=4)
def _repository(database_url: str, limits: TransactionLimits) -> Repository:
    return Repository(connect(database_url, limits=limits))

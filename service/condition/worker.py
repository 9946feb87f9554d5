"""What worker processes do for the conditions of motors: fold what is new.

A task reads from the database and writes to it itself, in short transactions, and ends soon: a diagnosis that
waits for a worker does not wait long. A worker that is killed loses the transaction under way, no more.
"""

from dataclasses import dataclass
from functools import lru_cache
from time import monotonic, time_ns

import structlog

from core.machines.parameters import Motor
from service.alarms.condition_rules import AT_ONCE, ConditionRules
from service.storage.engine import connect
from service.storage.repository import Repository
from service.storage.transaction_limits import USUAL, TransactionLimits

log = structlog.get_logger(__name__)

ROUND_S = 0.5
"""A task ends after about so long; the next one goes on."""

RECORDS_A_FOLD = 2000
"""Records that are folded before the database has them: a transaction takes some ten milliseconds."""


@dataclass(frozen=True, slots=True)
class FoldTask:
    """Name a motor to fold, as the motors file has it, the database, and when its alarms are raised."""

    database_url: str
    motor: Motor
    round_s: float = ROUND_S
    alarm_rules: ConditionRules = AT_ONCE
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


@lru_cache(maxsize=4)
def _repository(database_url: str, limits: TransactionLimits) -> Repository:
    return Repository(connect(database_url, limits=limits))

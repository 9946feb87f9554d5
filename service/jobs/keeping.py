"""Keep what a worker found in a recording, and settle the alarms and the relay's clock by it."""

import time
from dataclasses import replace

import structlog
from structlog.typing import FilteringBoundLogger

from service.condition.record_times import ImpossibleTimeError, require_possible_time
from service.jobs.relay_time import TriggeredRecord, note_relay_time
from service.jobs.task import Diagnosed
from service.storage.records import ClaimedJob
from service.storage.repository import Repository

log: FilteringBoundLogger = structlog.get_logger(__name__)


def keep_diagnosed(
    repository: Repository, claimed: ClaimedJob, made: Diagnosed, *, runner: str, time_zone: str | None
) -> None:
    """Keep what a job has made, unless its runner has lost it meanwhile.

    time_zone: of the relay's clock (IANA); None for UTC.  Raises SQLAlchemyError, UnstorableDiagnosisError.
    """
    job, now_ns = claimed.job, time.time_ns()
    findings, outline, left_out = made.findings, made.outline, None
    if claimed.is_joined:  # the recordings that it is made of tell the condition
        findings, outline = replace(findings, observation=None), None
    try:
        require_possible_time(made.recorded_ns, now_ns)
    except ImpossibleTimeError as error:
        findings, left_out = replace(findings, observation=None, start=None), str(error)
        log.warning("record left out of the condition", recording=job.recording_id, reason=left_out)
    kept = repository.finish_job(
        job.id,
        findings,
        recorded_ns=made.recorded_ns,
        now_ns=now_ns,
        runner=runner,
        left_out=left_out,
        outline=outline,
    )
    if not kept:
        log.warning("a diagnosis came after the lease was lost", recording=job.recording_id)
        return
    if findings.start is not None or claimed.is_repetition:
        repository.settle_start_alarms_of(claimed.motor, now_ns=now_ns)
    if findings.observation is None or claimed.is_repetition:
        repository.settle_motor_condition(claimed.motor, now_ns=now_ns)  # no fold will do so
    is_first = not claimed.is_repetition  # a repetition tells of the clock as it was
    if is_first and claimed.ied is not None and claimed.triggered_ns is not None:
        record = TriggeredRecord(
            claimed.ied,
            time_zone,
            made.recorded_ns,
            claimed.triggered_ns,
            made.has_time_code,
            repository.preceding_offset_ns(claimed.ied, claimed.triggered_ns),
        )
        note_relay_time(repository, record, now_ns)
    operation = findings.diagnosis.operation
    log.info(
        "recording diagnosed",
        recording=job.recording_id,
        motor=claimed.motor,
        verdict=str(findings.diagnosis.verdict),
        operation=None if operation is None else str(operation),
    )

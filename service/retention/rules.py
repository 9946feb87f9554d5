"""The rules by which the settings have something deleted: what each would delete, and how it is done."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

from core.diagnosis.verdict import Verdict
from core.units import NANOSECONDS_PER_DAY
from service.configuration.retention import RetentionSettings
from service.configuration.settings import Settings
from service.plant import AveragingStep
from service.retention.batches import Batches
from service.retention.row_sizes import ROW_BYTES
from service.storage.records import SERVICE, Actor, Amount, AppliedRule, DeletedRows, OldRecording
from service.storage.repository import Repository
from service.storage.repository.recordings.kept_recordings import Keeping
from service.storage.repository.recordings.retention import NOTHING, ExpiredRecordings
from service.storage.states import RecordingState

FIRST_RECORDINGS = 1
"""Recordings of a first batch: one has rows in many tables, and takes 50 ms where the machine is busy."""


def _no_recordings() -> Iterator[OldRecording]:
    return iter(())


@dataclass(frozen=True, slots=True)
class Rule:
    """One rule: the setting that it comes from, and after how many days something is deleted; None for never.

    amount: says what it would delete now.  forget: deletes it, and returns how many.
    listed: yields the recordings that it is for, those that it would delete and those that stay.
    """

    setting: str
    days: float | None
    amount: Callable[[], Amount]
    forget: Callable[[Batches], int]
    listed: Callable[[], Iterator[OldRecording]] = _no_recordings


def rules(settings: Settings, repository: Repository, now_ns: int, by: Actor = SERVICE) -> tuple[Rule, ...]:
    """Return the rules of the table [retention], also those that keep everything.

    by: who applies them, for the audit trail.

    The rules of the measured values are not among them: values are averaged before they are deleted.
    """
    return (
        *_recording_rules(settings, repository, now_ns, by),
        *_other_rules(settings, repository, now_ns, by),
    )


def keeping_of(kept: RetentionSettings) -> Keeping:
    """Return what stays of each motor's recordings, whatever their age."""
    return Keeping(
        newest=kept.keep_newest,
        starts=kept.keep_starts,
        first_ns=_nanoseconds(kept.keep_first_days),
        changes=kept.keep_changes,
        operations=kept.keep_operations,
        one_in_ns=_nanoseconds(kept.keep_one_in_days),
    )


def _nanoseconds(days: float | None) -> int | None:
    return None if days is None else round(days * NANOSECONDS_PER_DAY)


def _old_recordings(repository: Repository, expired: ExpiredRecordings) -> Iterator[OldRecording]:
    for motor in repository.all_motors():
        yield from repository.old_recordings(motor, expired)


def _recording_rules(settings: Settings, repository: Repository, now_ns: int, by: Actor) -> Iterator[Rule]:
    """Yield the rules of recordings, by verdict or, where there is none, by state."""
    kept = settings.retention
    keeping = keeping_of(kept)
    diagnosed, refused = RecordingState.DIAGNOSED, Verdict.UNDIAGNOSABLE
    kinds: tuple[tuple[str, float | None, RecordingState, Verdict | None, bool], ...] = (
        ("healthy_days", kept.healthy_days, diagnosed, Verdict.HEALTHY, False),
        ("watch_days", kept.watch_days, diagnosed, Verdict.WATCH, False),
        ("fault_days", kept.fault_days, diagnosed, Verdict.FAULT, False),
        ("undiagnosable_days", kept.undiagnosable_days, diagnosed, refused, False),
        ("not_running_days", kept.not_running_days, diagnosed, refused, True),
        ("rejected_days", kept.rejected_days, RecordingState.REJECTED, None, False),
        ("failed_days", kept.failed_days, RecordingState.FAILED, None, False),
    )
    for name, days, state, verdict, says_nothing in kinds:
        setting = f"retention.{name}"
        if days is None:
            yield _keeping(setting)
            continue
        expired = ExpiredRecordings(state, verdict, _before(now_ns, days), keeping, says_nothing)
        rule = AppliedRule(setting, by, now_ns)
        forget = partial(_forget_recordings, repository, expired, f"older than {setting} = {days:g}", rule)
        amount = partial(repository.expired_recordings, expired)
        yield Rule(setting, days, amount, forget, partial(_old_recordings, repository, expired))


def _other_rules(settings: Settings, repository: Repository, now_ns: int, by: Actor) -> Iterator[Rule]:
    """Yield the rules of what is no recording: diagnoses, jobs, recording requests, deletions."""
    kept = settings.retention
    kinds: tuple[tuple[str, float | None, str, Callable[..., Amount], Callable[..., DeletedRows]], ...] = (
        (
            "superseded_diagnoses_days",
            kept.superseded_diagnoses_days,
            "diagnoses",
            repository.superseded_diagnoses,
            repository.forget_superseded_diagnoses,
        ),
        (
            "failed_jobs_days",
            kept.failed_jobs_days,
            "jobs",
            repository.failed_jobs,
            repository.forget_failed_jobs,
        ),
        (
            "event_reports_days",
            kept.event_reports_days,
            "recording_requests",
            repository.ended_requests,
            repository.forget_ended_requests,
        ),
        (
            "deletions_days",
            kept.deletions_days,
            "deletions",
            repository.old_deletions,
            repository.forget_deletions,
        ),
    )
    for name, days, table, amount, forget in kinds:
        setting = f"retention.{name}"
        if days is None:
            yield _keeping(setting)
            continue
        before_ns = _before(now_ns, days)
        yield Rule(
            setting,
            days,
            partial(_sized, partial(amount, before_ns=before_ns), table),
            partial(_forget, partial(forget, before_ns=before_ns, rule=AppliedRule(setting, by, now_ns))),
        )


def measurement_rules(settings: Settings, repository: Repository, now_ns: int) -> Iterator[Rule]:
    """Yield the rules of the measured values, by averaging step; for whoever has averaged them before."""
    kinds = (
        ("metering_sample_days", settings.metering_sample_days, AveragingStep.AS_SAMPLED),
        ("metering_minute_days", settings.metering_minute_days, AveragingStep.MINUTE),
        ("metering_quarter_hour_days", settings.metering_quarter_hour_days, AveragingStep.QUARTER_HOUR),
    )
    for setting, days, step in kinds:
        before_ns = _before(now_ns, days)
        amount = partial(repository.old_measurements, step.value, before_ns=before_ns)
        forget = partial(_forget_measurements, repository, step, before_ns)
        yield Rule(setting, days, partial(_sized, amount, "measurements"), forget)


def _keeping(setting: str) -> Rule:
    return Rule(setting, None, lambda: NOTHING, lambda _batches: 0)


def _before(now_ns: int, days: float) -> int:
    return now_ns - round(days * NANOSECONDS_PER_DAY)


def _sized(amount: Callable[[], Amount], table: str) -> Amount:
    """Return the amount with the size of its rows, estimated."""
    found = amount()
    return Amount(found.rows, found.rows * ROW_BYTES[table], found.oldest_ns, found.newest_ns)


def _forget(delete: Callable[[int], DeletedRows], batches: Batches) -> int:
    return batches.run(delete)


def _forget_measurements(
    repository: Repository, step: AveragingStep, before_ns: int, batches: Batches
) -> int:
    """Drop what is old as a whole, delete what is not in partitions; return how many rows were deleted."""
    repository.drop_measurement_partitions(step.value, before_ns=before_ns)
    return batches.run(partial(repository.forget_measurements, step.value, before_ns=before_ns))


def _forget_recordings(
    repository: Repository, expired: ExpiredRecordings, reason: str, rule: AppliedRule, batches: Batches
) -> int:
    number = 0
    for motor in repository.all_motors():
        delete = partial(
            repository.forget_recordings,
            motor,
            expired=expired,
            reason=reason,
            now_ns=rule.now_ns,
            rule=rule,
        )
        number += batches.run(delete, first_rows=FIRST_RECORDINGS)
    return number

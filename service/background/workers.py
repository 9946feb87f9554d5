"""The workers of the service's periodic work, by the names that GET /readyz lists."""

import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from threading import Event

from core.units import SECONDS_PER_DAY
from service.access.refusals import PERIOD_S, Refusals
from service.background import (
    alarm_steps,
    audit_forwarding,
    backups,
    housekeeping,
    joining,
    long_records,
    orphaned_requests,
    retention,
    scheduling,
)
from service.background.alarm_sources import worker as alarm_sources
from service.background.alarm_sources.worker import AlarmSources
from service.background.alarm_steps import AlarmSteps
from service.background.audit_forwarding import AuditForwarding
from service.background.backups import DailyBackup
from service.background.housekeeping import Housekeeping
from service.background.joining import SeriesJoiner
from service.background.long_records import LongRecorder
from service.background.orphaned_requests import OrphanedRequestEnder
from service.background.retention import Retention
from service.background.scheduling import Scheduler
from service.configuration.audit import AuditSyslog
from service.configuration.settings import Settings
from service.plant import Plant
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.timing.periodic_worker import PeriodicWorker
from service.waveforms.computing import Compute


@dataclass(frozen=True, slots=True)
class Periods:
    """Pauses between two rounds of each work [s]."""

    scheduling_s: float = scheduling.PERIOD_S
    housekeeping_s: float = housekeeping.PERIOD_S
    retention_s: float = retention.PERIOD_S
    orphaned_requests_s: float = orphaned_requests.PERIOD_S
    alarm_steps_s: float = alarm_steps.PERIOD_S
    audit_forwarding_s: float = audit_forwarding.PERIOD_S
    alarm_sources_s: float = alarm_sources.PERIOD_S
    backups_s: float = backups.PERIOD_S
    joining_s: float = joining.PERIOD_S
    long_records_s: float = long_records.PERIOD_S
    refusals_s: float = PERIOD_S


PERIODS = Periods()


def background_workers(
    settings: Settings,
    plant: Plant,
    repository: Repository,
    store: RecordingStore,
    *,
    gateway_problem: Callable[[], str | None],
    restart_delay_s: float,
    compute: Compute,
    refusals: Refusals,
    directories: Iterable[Path] = (),
    settings_file: Path | None = None,
    periods: Periods = PERIODS,
) -> Mapping[str, PeriodicWorker]:
    """Return one worker for each periodic work, not started yet.

    gateway_problem: why gateways of this service do not run; None while all do.  restart_delay_s: the longest
    pause before a gateway that ended is started again.  compute: has the numbers done.  directories: those
    that the service writes to.  refusals: what the API refused.  settings_file: goes into back-ups.
    """
    scheduler = Scheduler(
        plant.motors, repository, buses=plant.buses, metering_period_s=settings.metering_period_s
    )
    housekeeping_ends, retention_ends, alarm_steps_end, backup_ends = Event(), Event(), Event(), Event()
    steps = AlarmSteps(repository, alarm_steps_end)
    sources = AlarmSources(settings, repository, directories, started_ns=time.time_ns())
    backup = DailyBackup(settings, repository, backup_ends, settings_file=settings_file)
    keeper = Housekeeping(settings, repository, housekeeping_ends)
    retained = Retention(settings, repository, store, retention_ends)
    ender = OrphanedRequestEnder(
        settings, repository, gateway_problem=gateway_problem, restart_delay_s=restart_delay_s
    )
    joiner = SeriesJoiner(
        repository,
        store,
        compute,
        time_zones=plant.time_zones(),
        lenient=[one.name for one in plant.motors if one.motor.reads_leniently],
    )
    long_recorder = LongRecorder(
        plant.motors,
        repository,
        usual_days=settings.long_record_days,
        usual_s=settings.long_record_s,
        metering_period_s=settings.metering_period_s,
    )
    workers = {
        "long_records": PeriodicWorker(
            "requests of long records",
            lambda: long_recorder.request_due(time.time_ns()),
            period_s=periods.long_records_s,
        ),
        "joining": PeriodicWorker(
            "joining of recordings",
            lambda: joiner.join_ready(time.time_ns()),
            period_s=periods.joining_s,
        ),
        "schedules": PeriodicWorker(
            "scheduling", lambda: scheduler.request_due(time.time_ns()), period_s=periods.scheduling_s
        ),
        "housekeeping": PeriodicWorker(
            "housekeeping",
            lambda: keeper.average_and_delete(time.time_ns(), time.monotonic_ns()),
            period_s=periods.housekeeping_s,
            at_once=True,
            stopping=housekeeping_ends,
        ),
        "retention": PeriodicWorker(
            "retention",
            lambda: retained.delete_old(time.time_ns(), time.monotonic_ns()),
            period_s=periods.retention_s,
            at_once=True,
            stopping=retention_ends,
        ),
        "orphaned_requests": PeriodicWorker(
            "ending of orphaned requests",
            lambda: ender.end_overdue(time.monotonic()),
            period_s=periods.orphaned_requests_s,
        ),
        "alarm_sources": PeriodicWorker(
            "looking for what raises alarms",
            lambda: sources.look(time.time_ns(), time.monotonic_ns()),
            period_s=periods.alarm_sources_s,
        ),
        "alarm_steps": PeriodicWorker(
            "shelving and suppression of alarms",
            lambda: steps.take(time.time_ns()),
            period_s=periods.alarm_steps_s,
            at_once=True,
            stopping=alarm_steps_end,
        ),
        "backups": PeriodicWorker(
            "daily back-up",
            lambda: backup.back_up_if_due(time.time_ns()),
            period_s=periods.backups_s,
            overdue_s=SECONDS_PER_DAY,
            stopping=backup_ends,
        ),
    }
    workers["refusals"] = PeriodicWorker(
        "writing of refusals into the audit trail",
        lambda: refusals.settle(repository),
        period_s=periods.refusals_s,
    )
    if settings.audit.syslog is not None:
        workers["audit_forwarding"] = _forwarding(settings.audit.syslog, repository, periods)
    return workers


def _forwarding(syslog: AuditSyslog, repository: Repository, periods: Periods) -> PeriodicWorker:
    ends = Event()
    forwarding = AuditForwarding(repository, syslog, ends)
    return PeriodicWorker(
        "sending of the audit trail",
        forwarding.forward,
        period_s=periods.audit_forwarding_s,
        at_once=True,
        stopping=ends,
        overdue_s=2 * syslog.timeout_s + audit_forwarding.LONGEST_BACKLOG_S,
    )

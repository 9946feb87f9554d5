"""The job runner as the settings say: that of a service, and of workers alone."""

from collections.abc import Callable

from service.condition.work import ConditionWork
from service.configuration.settings import Settings
from service.jobs.limits import JobLimits
from service.jobs.runner import JobRunner
from service.jobs.worker import diagnose_recording, prepare_worker
from service.plant import Plant
from service.process.installation import installation_id
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.transaction_limits import limits_of
from service.timing.backoff import Backoff

LONGEST_RETRY_S = 3600.0
"""Before another attempt of a diagnosis, however many failed."""


def job_runner(
    settings: Settings,
    plant: Plant,
    repository: Repository,
    store: RecordingStore,
    *,
    is_ending: Callable[[], bool],
) -> JobRunner:
    """What makes the diagnoses and folds the conditions, in worker processes."""
    motors = {motor.name: motor.motor for motor in plant.motors}
    conditions = ConditionWork(
        repository,
        motors,
        database_url=settings.database_url,
        alarm_rules=settings.alarms.condition_rules,
        limits=limits_of(settings),
    )
    return JobRunner(
        repository,
        store,
        motors,
        diagnose_recording,
        limits=JobLimits(
            workers=settings.workers,
            job_timeout_s=settings.job_timeout_s,
            attempts=settings.job_attempts,
            backoff=Backoff(settings.job_retry_delay_s, LONGEST_RETRY_S),
            lease_s=settings.lease_s,
        ),
        installation=installation_id(settings.data_directory),
        time_zones=plant.time_zones(),
        conditions=conditions,
        prepare_worker=prepare_worker,
        is_ending=is_ending,
    )

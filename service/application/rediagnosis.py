"""All recordings of an archive diagnosed again as one batch, on the workers of a Dask cluster.

The batch is a job runner beside the service's: it queues a few jobs at a time, and takes them as any runner
does. What it has queued or done is in the database alone, so that a batch that was killed goes on where it
ended.
"""

import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import islice

from core.machines.parameters import Motor
from service.condition.motor_data import document_of
from service.configuration.settings import Settings
from service.jobs.dask_workers import DaskWorkers, diagnose_shared_recording
from service.jobs.limits import JobLimits
from service.jobs.runner import JobRunner
from service.plant import Plant
from service.process.installation import installation_id
from service.process.single_instance import exclusive
from service.recording_store.opening import open_store_anywhere
from service.storage import Repository
from service.storage.records import Actor, Cursor, Job
from service.storage.states import JobState
from service.timing.backoff import Backoff

POLL_PERIOD_S = 0.05
LONGEST_RETRY_S = 60.0
JOBS_A_PLACE = 2
"""So many are queued for each task that the workers take: no more than a service does in a moment."""
PAGE = 64
"""So many recordings are looked for at once."""


class RediagnosisError(RuntimeError):
    """The batch cannot begin, or has ended before its end."""


@dataclass(frozen=True, slots=True)
class Wanted:
    """Say which diagnoses are to be made.

    motors: of these.  made_before_ns: also in the place of diagnoses that began before this time, UTC [ns].
    """

    motors: Sequence[str]
    method: str
    model: str
    made_before_ns: int = 0


@dataclass(slots=True)
class Progress:
    """Hold how far a batch is.

    to_do: recordings to diagnose when it began.  already: recordings that were done before.
    failed: jobs without a result.
    """

    to_do: int
    already: int
    made: int = 0
    failed: list[Job] = field(default_factory=list)


def rediagnose(
    settings: Settings,
    plant: Plant,
    repository: Repository,
    workers: DaskWorkers,
    wanted: Wanted,
    by: Actor,
    on_progress: Callable[[Progress], None],
) -> Progress:
    """Make what is to be made, and return what came of it.

    Raises RediagnosisError, AlreadyRunningError (another batch of this data directory), SQLAlchemyError.
    """
    motors = {motor.name: motor.motor for motor in plant.motors}
    _require_known(repository, motors, wanted.motors)
    store = open_store_anywhere(settings)
    with exclusive(settings.data_directory / "rediagnosis.lock", wait=False):
        runner = JobRunner(
            repository,
            store,
            motors,
            diagnose_shared_recording,
            limits=JobLimits(
                workers=workers.places,
                job_timeout_s=settings.job_timeout_s,
                attempts=settings.job_attempts,
                backoff=Backoff(settings.job_retry_delay_s, LONGEST_RETRY_S),
                lease_s=settings.lease_s,
            ),
            installation=f"{installation_id(settings.data_directory)} rediagnosis",
            time_zones=plant.time_zones(),
            workers=workers,
        )
        progress = _counted(repository, wanted)
        on_progress(progress)
        runner.start()
        try:
            problem = _follow(repository, runner, workers, wanted, by, progress, on_progress)
        finally:
            runner.stop()
    if problem is not None:
        raise RediagnosisError(
            f"{problem}: {_counted(repository, wanted).to_do} recordings are left; start the scheduler and "
            "its workers again, and the same command goes on with them"
        )
    return progress


def _require_known(repository: Repository, motors: Mapping[str, Motor], names: Sequence[str]) -> None:
    """Raise RediagnosisError where the service knows another motor than the motors file."""
    for name in names:
        if name not in motors:
            raise RediagnosisError(f"--motor {name}: expected a motor of the plant, found none of this name")
        versions = repository.motor_versions(name)
        if not versions or versions[-1].document != document_of(motors[name]):
            raise RediagnosisError(
                f"motor {name}: expected the parameters that the service noted when it started, found others "
                "in the motors file: start the service again, and then this command"
            )


def _counted(repository: Repository, wanted: Wanted) -> Progress:
    to_do = of = 0
    for motor in wanted.motors:
        some, all_of_it = repository.repetitions_to_do(
            motor, method=wanted.method, model=wanted.model, made_before_ns=wanted.made_before_ns
        )
        to_do, of = to_do + some, of + all_of_it
    return Progress(to_do, of - to_do)


def _follow(
    repository: Repository,
    runner: JobRunner,
    workers: DaskWorkers,
    wanted: Wanted,
    by: Actor,
    progress: Progress,
    on_progress: Callable[[Progress], None],
) -> str | None:
    """Queue jobs as others end, until none is left. Returns why it ends before; None where it does not."""
    to_come = _queued(repository, wanted, by)
    most_open = JOBS_A_PLACE * workers.places
    open_ids: set[str] = set()
    while True:
        if len(open_ids) <= most_open // 2:
            open_ids.update(islice(to_come, most_open - len(open_ids)))
            runner.wake()
        if not open_ids:
            return None
        if workers.problem is not None:
            return workers.problem
        time.sleep(POLL_PERIOD_S)
        ended = repository.ended_jobs(open_ids)
        open_ids.difference_update(ended)
        states = Counter(None if job is None else job.state for job in ended.values())
        progress.made += states[JobState.DONE]
        progress.failed += [job for job in ended.values() if job and job.state is JobState.FAILED]
        on_progress(progress)


def _queued(repository: Repository, wanted: Wanted, by: Actor) -> Iterator[str]:
    """Yield the jobs of all recordings, a motor after the other, and queue them by pages when asked for.

    A worker learns the motor's baseline once that way.
    """
    for motor in wanted.motors:
        after: Cursor | None = None
        while True:
            page = repository.repeat_diagnoses(
                motor,
                method=wanted.method,
                model=wanted.model,
                made_before_ns=wanted.made_before_ns,
                by=by,
                now_ns=time.time_ns(),
                limit=PAGE,
                after=after,
            )
            yield from (job.id for job in page.items)
            if page.next is None:
                break
            after = page.next

"""Takes jobs from the database, has them done in worker processes, writes the results back."""

import time
from collections import deque
from collections.abc import Callable, Mapping
from concurrent.futures import BrokenExecutor, Future
from dataclasses import dataclass
from functools import partial

import structlog
from pebble import ProcessExpired
from sqlalchemy.exc import SQLAlchemyError
from structlog.typing import FilteringBoundLogger

from core.machines.parameters import Motor
from core.units import NANOSECONDS_PER_SECOND
from service.jobs.task import Diagnosed, DiagnosisTask, Outcome, Rejected, Task
from service.jobs.worker_pool import NoWorkersError, WorkerPool
from service.jobs.worker_process import follow_service
from service.recording_store.store import RecordingStore, RecordingStoreError
from service.storage.errors import UnstorableDiagnosisError
from service.storage.records import ClaimedJob
from service.storage.repository import Repository
from service.timing.periodic_worker import PeriodicWorker

log: FilteringBoundLogger = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True)
class JobLimits:
    """How many at once, how long each [s], how often, how soon again [s]."""

    workers: int = 2
    job_timeout_s: float = 60.0
    attempts: int = 3
    retry_delay_s: float = 2.0


class JobRunner:
    """One thread feeds a pool of worker processes.

    A worker that dies or takes too long costs its own job an attempt and nothing else. Whatever was running
    when the service was killed is queued again by `start`.
    """

    def __init__(
        self,
        repository: Repository,
        store: RecordingStore,
        motors: Mapping[str, Motor],
        task: Task,
        *,
        limits: JobLimits,
        prepare_worker: Callable[[], None] = follow_service,
        poll_period_s: float = 0.2,
    ) -> None:
        self._repository = repository
        self._store = store
        self._motors = motors
        self._task = task
        self._limits = limits
        self._pool = WorkerPool(limits.workers, prepare_worker)
        self._pool_problem: str | None = None
        self._in_flight: dict[str, Future[Outcome]] = {}
        self._results: deque[tuple[ClaimedJob, Future[Outcome]]] = deque()
        self._loading = limits.workers
        self._worker = PeriodicWorker("the job runner", self._step, period_s=poll_period_s, at_once=True)

    def start(self) -> None:
        """Queue interrupted jobs again and start the thread, which starts the workers."""
        self._repository.requeue_interrupted_jobs(now_ns=time.time_ns(), max_attempts=self._limits.attempts)
        self._worker.start()

    def stop(self) -> None:
        """Stop the workers; their jobs go back to the queue as if they had not been claimed."""
        self._worker.stop()
        self._shut_down()

    def wake(self) -> None:
        """Look for jobs now instead of at the next poll."""
        self._worker.wake()

    def problem(self) -> str | None:
        """Return why jobs are not done, or not at full speed, at present; None when all is well."""
        problem = self._worker.problem() or self._pool_problem
        if problem is None and self._loading:
            return f"{self._loading} of {self._limits.workers} workers are still loading"
        return problem

    def _step(self) -> None:
        """Write results back and claim what workers are free for. Raises SQLAlchemyError: try again."""
        while self._results:
            self._settle(*self._results[0])
            self._results.popleft()
        if self._pool.has_ended():
            self._give_back()
            self._pool.renew()
        self._pool_problem = self._pool.problem
        if self._pool_problem is not None:
            return
        self._loading = self._pool.loading()
        while len(self._in_flight) < self._limits.workers and self._claim():
            pass

    def _give_back(self) -> None:
        """Jobs nobody does any more: as if they had not been claimed."""
        for job_id in list(self._in_flight):
            self._repository.release_job(job_id)
            del self._in_flight[job_id]

    def _claim(self) -> bool:
        claimed = self._repository.claim_job(now_ns=time.time_ns())
        if claimed is None:
            return False
        job = claimed.job
        motor = self._motors.get(claimed.motor)
        if motor is None:
            reason = f"motor {claimed.motor} is not in the plant: its parameters are unknown"
            self._repository.reject_recording(job.id, reason, now_ns=time.time_ns())
            return True
        try:
            entry = self._store.entry(claimed.digest)
            baseline = tuple(self._store.entry(digest) for digest in claimed.baseline)
        except RecordingStoreError as error:
            self._repository.reject_recording(job.id, str(error), now_ns=time.time_ns())
            return True
        task = DiagnosisTask(entry, motor, job.method, job.model, baseline)
        try:
            future = self._pool.schedule(self._task, task, self._limits.job_timeout_s)
        except NoWorkersError:
            self._repository.release_job(job.id)
            return False
        self._in_flight[job.id] = future
        future.add_done_callback(partial(self._done, claimed))
        return True

    def _done(self, claimed: ClaimedJob, future: "Future[Outcome]") -> None:
        """Called by a thread of the pool: hands over to ours."""
        self._results.append((claimed, future))
        self._worker.wake()

    def _settle(self, claimed: ClaimedJob, future: "Future[Outcome]") -> None:
        """Writes a result back. Raises SQLAlchemyError (the database does not answer): to be tried again."""
        job_id = claimed.job.id
        if self._in_flight.get(job_id) is not future:  # late word of workers whose jobs were given back
            return
        error = None if future.cancelled() else future.exception()
        if future.cancelled() or isinstance(error, BrokenExecutor):  # the pool's end, not the job's fault
            self._repository.release_job(job_id)
        elif error is None:
            self._keep(claimed, future.result())
        elif isinstance(error, TimeoutError):
            self._retry(claimed, f"took longer than {self._limits.job_timeout_s:g} s")
        elif isinstance(error, ProcessExpired):
            self._retry(claimed, f"the worker process died (exit code {error.exitcode})")
        else:
            self._retry(claimed, f"{type(error).__name__}: {error}")
        self._in_flight.pop(job_id, None)

    def _keep(self, claimed: ClaimedJob, outcome: Outcome) -> None:
        job = claimed.job
        match outcome:
            case Rejected(reason):
                self._repository.reject_recording(job.id, reason, now_ns=time.time_ns())
                log.warning("recording rejected", recording=job.recording_id, reason=reason)
            case Diagnosed(diagnosis, recorded_ns):
                try:
                    self._repository.finish_job(
                        job.id, diagnosis, recorded_ns=recorded_ns, now_ns=time.time_ns()
                    )
                except UnstorableDiagnosisError as error:
                    self._retry(claimed, f"the diagnosis cannot be stored: {error}")
                    return
                log.info(
                    "recording diagnosed",
                    recording=job.recording_id,
                    motor=claimed.motor,
                    verdict=str(diagnosis.verdict),
                )

    def _retry(self, claimed: ClaimedJob, error: str) -> None:
        state = self._repository.retry_or_fail_job(
            claimed.job.id,
            error,
            now_ns=time.time_ns(),
            max_attempts=self._limits.attempts,
            retry_delay_ns=round(self._limits.retry_delay_s * NANOSECONDS_PER_SECOND),
        )
        log.warning("diagnosis failed", recording=claimed.job.recording_id, error=error, job=str(state))

    def _shut_down(self) -> None:
        self._pool.stop()
        try:
            while self._results:
                self._settle(*self._results.popleft())
            for job_id in self._in_flight:
                self._repository.release_job(job_id)
        except SQLAlchemyError:
            log.exception("jobs were not put back; the next start queues them again")

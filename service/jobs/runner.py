"""Take jobs from the database, have worker processes do them, write the results back."""

import os
import socket
import sys
import time
import uuid
from collections import deque
from collections.abc import Callable, Mapping
from concurrent.futures import BrokenExecutor, Future
from contextlib import suppress
from functools import partial

import structlog
from pebble import ProcessExpired
from sqlalchemy.exc import SQLAlchemyError
from structlog.typing import FilteringBoundLogger

from core.machines.parameters import Motor
from service.condition.work import ConditionTask, ConditionWork
from service.condition.worker import fold_motor
from service.jobs.answers import Answers
from service.jobs.keeping import keep_diagnosed
from service.jobs.limits import JobLimits
from service.jobs.listening import JobListener, usual_poll_period_s
from service.jobs.task import DiagnosisTask, Outcome, Rejected, Task
from service.jobs.worker_pool import WorkerPool
from service.jobs.worker_process import follow_service
from service.jobs.workers import NoWorkersError, WorkerFailedError, Workers
from service.recording_store.errors import RecordingStoreError, StoreUnreachableError
from service.recording_store.store import RecordingStore
from service.storage.errors import NotFoundError, RunnerEndedError, UnstorableDiagnosisError
from service.storage.records import ClaimedJob, JobRunnerPlace
from service.storage.repository import Repository
from service.storage.texts import storable
from service.timing.boot_clock import boot_time_s
from service.timing.database_silence import does_not_answer
from service.timing.peer_liveness import PeerLiveness
from service.timing.periodic_worker import PeriodicWorker

log: FilteringBoundLogger = structlog.get_logger(__name__)

RENEWALS_A_LEASE = 3
CONDITION_TIMEOUT_S = 60.0
"""Tasks for conditions end after a second; one that lasts so long hangs."""


class JobRunner:
    """Feed a pool of worker processes from one thread.

    A worker that dies or takes too long costs its own job an attempt and nothing else. Services that share a
    database share its jobs: what was running when a service was killed is queued again when that installation
    starts anew, or by another's runner once the lease has run out.
    """

    def __init__(
        self,
        repository: Repository,
        store: RecordingStore,
        motors: Mapping[str, Motor],
        task: Task,
        *,
        limits: JobLimits,
        installation: str,
        time_zones: Mapping[str, str] | None = None,
        conditions: ConditionWork | None = None,
        prepare_worker: Callable[[], None] = follow_service,
        poll_period_s: float | None = None,
        is_ending: Callable[[], bool] = lambda: False,
        workers: Workers | None = None,
    ) -> None:
        """time_zones: of clocks that are not in UTC, by motor (IANA). workers: by default of this machine.

        conditions: what workers do that have nothing to diagnose. is_ending: workers are not needed.
        poll_period_s: looks for jobs so often; by default seldom where the database tells of them.
        """
        self._repository = repository
        self._store = store
        self._motors = motors
        self._time_zones = {} if time_zones is None else time_zones
        self._task = task
        self._limits = limits
        self._installation = installation
        self._id = str(uuid.uuid4())
        self._peers = PeerLiveness(limits.lease_s)
        self._renew_at_s = 0.0
        self._pool = workers or WorkerPool(limits.workers, prepare_worker, is_ending, self.wake)
        self._pool_problem: str | None = None
        self._has_no_store = False
        self._in_flight: dict[str, Future[Outcome]] = {}
        self._may_hold_unknown_jobs = False
        self._results: deque[tuple[ClaimedJob, Future[Outcome]]] = deque()
        self._conditions = conditions
        self._condition_results: deque[tuple[ConditionTask, Future[int]]] = deque()
        self._loading = limits.workers
        period_s = poll_period_s or usual_poll_period_s(repository)
        self._worker = PeriodicWorker("the job runner", self._step, period_s=period_s, at_once=True)
        self._listener = JobListener(repository, self._worker.wake)
        self._answers = Answers(self._worker.wake)
        self.compute = self._answers.ask

    def start(self) -> None:
        """Queue this installation's interrupted jobs again and start the thread, which starts the workers."""
        self._register()
        if self._conditions is not None:
            self._conditions.begin()
        self._worker.start()
        self._listener.start()

    def stop(self) -> None:
        """Stop the workers; their jobs go back to the queue as if they had not been claimed."""
        self._listener.stop()
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
        self._renew_when_due()
        while self._results:
            self._settle(*self._results[0])
            self._results.popleft()
            self._renew_when_due()  # each may have waited for a lock
        while self._conditions is not None and self._condition_results:
            self._conditions.ended(*self._condition_results.popleft())
        if self._pool.has_ended():
            self._give_back()
            self._pool.renew()
        self._pool_problem = self._pool.problem or self._store_problem()
        if self._pool_problem is not None:
            self._answers.refuse(self._pool_problem)
            return
        self._loading = self._pool.loading()
        if self._loading:
            return
        while self._has_free_worker() and self._answers.begin(self._pool):
            pass
        self._claim_jobs()
        while self._has_free_worker() and self._begin_condition_task():
            pass

    def _store_problem(self) -> str | None:
        """Return why no recording can be read. Jobs wait meanwhile; none of their recordings is at fault."""
        problem = self._store.problem()
        had_none, self._has_no_store = self._has_no_store, problem is not None
        if problem is not None and not had_none:
            log.warning("jobs wait for the recordings", reason=problem)
        return problem

    def _has_free_worker(self) -> bool:
        others = 0 if self._conditions is None else self._conditions.tasks_under_way
        return len(self._in_flight) + others + self._answers.under_way < self._limits.workers

    def _begin_condition_task(self) -> bool:
        """Give a worker something to do for a condition. Returns False where there is nothing to do."""
        if self._conditions is None or (task := self._conditions.next_task()) is None:
            return False
        try:
            future = self._pool.schedule(fold_motor, task.fold, CONDITION_TIMEOUT_S)
        except NoWorkersError:
            self._conditions.give_back()
            return False
        future.add_done_callback(partial(self._condition_task_done, task))
        return True

    def _condition_task_done(self, task: ConditionTask, future: "Future[int]") -> None:
        """Hand a result over to the runner's thread; a thread of the pool calls this."""
        self._condition_results.append((task, future))
        self._worker.wake()

    def _register(self) -> None:
        """Begin as a new runner, which holds no job."""
        self._in_flight.clear()
        self._id = str(uuid.uuid4())
        self._repository.register_runner(
            self._id,
            installation=self._installation,
            now_ns=time.time_ns(),
            max_attempts=self._limits.attempts,
            place=JobRunnerPlace(socket.gethostname(), os.getpid(), self._limits.workers),
        )

    def _renew_when_due(self) -> None:
        if boot_time_s() >= self._renew_at_s:
            self._renew()

    def _renew(self) -> None:
        """Renew the lease, and take the jobs from runners that have not renewed theirs."""
        try:
            renewals = self._repository.renew_runner(self._id)
        except RunnerEndedError as error:
            log.warning("begins anew without its jobs", error=str(error))
            self._register()
            return
        self._renew_at_s = boot_time_s() + self._limits.lease_s / RENEWALS_A_LEASE
        del renewals[self._id]
        for runner, count in self._peers.dead(renewals, time.monotonic()).items():
            if self._repository.end_runner(
                runner, renewals=count, now_ns=time.time_ns(), max_attempts=self._limits.attempts
            ):
                log.warning("another job runner is gone: its jobs are queued again", runner=runner)

    def _give_back(self) -> None:
        """Put the jobs under way back into the queue as if they had not been claimed."""
        for job_id in list(self._in_flight):
            self._release(job_id)
            del self._in_flight[job_id]
        if self._conditions is not None:
            self._conditions.give_back()

    def _release(self, job_id: str) -> None:
        with suppress(NotFoundError):  # its recording was deleted meanwhile
            self._repository.release_job(job_id, runner=self._id)

    def _claim_jobs(self) -> None:
        """Claim as many jobs as workers are free. Raises SQLAlchemyError.

        A claim may have been kept though the database's answer was lost. Such jobs go back first: nobody
        else takes them from a runner that lives.
        """
        if self._may_hold_unknown_jobs:
            released = self._repository.release_unknown_jobs(self._id, self._in_flight)
            if released:
                log.info("jobs whose claim was cut off are queued again", number=released)
        self._may_hold_unknown_jobs = True
        while self._has_free_worker() and self._claim():
            pass
        self._may_hold_unknown_jobs = False

    def _claim(self) -> bool:
        """Claim the next job and give it to a worker. Returns False where there is none to do."""
        claimed = self._repository.claim_job(now_ns=time.time_ns(), runner=self._id)
        if claimed is None:
            return False
        job = claimed.job
        motor = self._motors.get(claimed.motor)
        if motor is None:
            reason = f"motor {claimed.motor} is not in the plant: its parameters are unknown"
            self._repository.reject_recording(job.id, reason, now_ns=time.time_ns(), runner=self._id)
            return True
        try:
            recording = self._store.source(claimed.digest)
            baseline = tuple(self._store.source(digest) for digest in claimed.baseline)
        except (RecordingStoreError, OSError) as error:
            if self._store_problem() is not None:  # it was there before this claim
                self._release(job.id)
                return False
            if isinstance(error, RecordingStoreError):
                self._repository.reject_recording(job.id, str(error), now_ns=time.time_ns(), runner=self._id)
            else:  # the store's disk or its permissions, which somebody may mend
                self._retry(claimed, str(error))
            return True
        task = DiagnosisTask(
            recording,
            motor,
            job.method,
            job.model,
            baseline,
            time_zone=self._time_zones.get(claimed.motor),
            near_ns=claimed.announced_ns if claimed.triggered_ns is None else claimed.triggered_ns,
        )
        try:
            future = self._pool.schedule(self._task, task, self._limits.job_timeout_s)
        except NoWorkersError:
            self._release(job.id)
            return False
        self._in_flight[job.id] = future
        future.add_done_callback(partial(self._done, claimed))
        return True

    def _done(self, claimed: ClaimedJob, future: "Future[Outcome]") -> None:
        """Hand a result over to the runner's thread; a thread of the pool calls this."""
        self._results.append((claimed, future))
        self._worker.wake()

    def _settle(self, claimed: ClaimedJob, future: "Future[Outcome]") -> None:
        """Write a result back, whatever it holds. Raises SQLAlchemyError: the caller tries again.

        A result that the database refuses costs its own job an attempt, and holds up none of the others.
        """
        job_id = claimed.job.id
        if self._in_flight.get(job_id) is not future:
            return  # the job went back to the queue before its worker ended: another attempt counts now
        try:
            self._write_back(claimed, future)
        except NotFoundError:
            log.warning("a diagnosis came whose recording is gone", recording=claimed.job.recording_id)
        except Exception as error:
            if does_not_answer(error):
                raise
            log.exception("a result cannot be stored", recording=claimed.job.recording_id)
            self._retry(claimed, f"the result cannot be stored: {type(error).__name__}: {error}")
        self._in_flight.pop(job_id, None)

    def _write_back(self, claimed: ClaimedJob, future: "Future[Outcome]") -> None:
        """Write back what became of a job. Raises SQLAlchemyError, NotFoundError."""
        error = None if future.cancelled() else future.exception()
        if future.cancelled() or self._is_not_its_fault(future):
            self._repository.release_job(claimed.job.id, runner=self._id)
        elif error is None:
            self._keep(claimed, future.result())
        elif isinstance(error, StoreUnreachableError):  # the place of all recordings, only now and then
            self._retry(claimed, str(error), max_attempts=sys.maxsize)
        elif isinstance(error, TimeoutError):
            self._retry(claimed, f"took longer than {self._limits.job_timeout_s:g} s")
        elif isinstance(error, ProcessExpired):
            self._retry(claimed, f"the worker process died (exit code {error.exitcode})")
        elif isinstance(error, WorkerFailedError):
            self._retry(claimed, str(error))
        else:
            self._retry(claimed, f"{type(error).__name__}: {error}")

    def _is_not_its_fault(self, future: "Future[Outcome]") -> bool:
        """Return whether a job came to nothing by the pool's end, or as no recording can be read here."""
        error = future.exception()
        if error is None and not isinstance(future.result(), Rejected):
            return False
        return isinstance(error, BrokenExecutor) or self._store_problem() is not None

    def _keep(self, claimed: ClaimedJob, outcome: Outcome) -> None:
        """Write back what a worker returned. Raises SQLAlchemyError."""
        job = claimed.job
        if isinstance(outcome, Rejected):
            self._repository.reject_recording(job.id, outcome.reason, now_ns=time.time_ns(), runner=self._id)
            log.warning("recording rejected", recording=job.recording_id, reason=storable(outcome.reason))
            return
        zone = self._time_zones.get(claimed.motor)
        try:
            keep_diagnosed(self._repository, claimed, outcome, runner=self._id, time_zone=zone)
        except UnstorableDiagnosisError as error:
            self._retry(claimed, f"the diagnosis cannot be stored: {error}")

    def _retry(self, claimed: ClaimedJob, error: str, *, max_attempts: int | None = None) -> None:
        """Queue a job again, or give it up after its last attempt. Raises SQLAlchemyError.

        max_attempts: by default as the limits say.
        """
        error = storable(error)
        state = self._repository.retry_or_fail_job(
            claimed.job.id,
            error,
            now_ns=time.time_ns(),
            max_attempts=max_attempts or self._limits.attempts,
            backoff=self._limits.backoff,
            runner=self._id,
        )
        log.warning("diagnosis failed", recording=claimed.job.recording_id, error=error, job=str(state))

    def _shut_down(self) -> None:
        """Stop the workers, write the results that are there, and put the other jobs back."""
        self._answers.refuse("the service ends")
        self._pool.stop()
        try:
            while self._results:
                self._settle(*self._results.popleft())
            for job_id in self._in_flight:
                self._release(job_id)
            self._repository.end_runner(self._id, now_ns=time.time_ns(), max_attempts=self._limits.attempts)
        except SQLAlchemyError:
            log.exception("jobs were not put back; the next start queues them again")

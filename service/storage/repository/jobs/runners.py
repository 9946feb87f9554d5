"""Which job runner does which job: its jobs are its own for as long as it renews its lease.

As with gateways (leases.py), no clock is compared with another. A runner counts its renewals; whoever has
seen the count stand still for the time of a lease, by a clock of its own that only goes forward, may declare
that runner dead and have its jobs queued again. What a dead runner still brings is not written.
"""

from collections.abc import Collection

from sqlalchemy import and_, func, select
from sqlalchemy.orm import Session

from service.storage.errors import RunnerEndedError
from service.storage.models import JobRow, JobRunnerRow
from service.storage.records import JobRunnerEntry, JobRunnerPlace
from service.storage.repository.jobs.steps import release, retry_or_give_up
from service.storage.repository.sessions import Sessions
from service.storage.states import JobState

INTERRUPTED = "the service ended during the diagnosis"
NOWHERE = JobRunnerPlace("", 0, 0)


class JobRunnerRows(Sessions):
    def register_runner(
        self,
        runner: str,
        *,
        installation: str,
        now_ns: int,
        max_attempts: int,
        place: JobRunnerPlace = NOWHERE,
    ) -> int:
        """Add a runner that starts, and return how many interrupted jobs are queued again.

        Those are the jobs of earlier runners of this installation, which its exclusive data directory proves
        dead, and jobs without a runner. Each counts as an attempt: a recording that takes the service down
        with it every time is given up at last.
        """
        earlier = select(JobRunnerRow.id).where(JobRunnerRow.installation == installation)
        with self._write() as session:
            ended = session.scalars(earlier).all()
            queued = _requeue(session, None, now_ns, max_attempts)
            for one in ended:
                queued += _end(session, one, now_ns, max_attempts)
            session.add(
                JobRunnerRow(
                    id=runner,
                    installation=installation,
                    renewals=0,
                    started_ns=now_ns,
                    host=place.host,
                    process_id=place.process_id,
                    workers=place.workers,
                )
            )
            return queued

    def renew_runner(self, runner: str) -> dict[str, int]:
        """Renew the lease, and return every runner's number of renewals.

        Raises RunnerEndedError where others declared the runner dead: it holds no job any more.
        """
        with self._write(ahead=True) as session:
            own = session.get(JobRunnerRow, runner, with_for_update={"key_share": True})
            if own is None:
                raise RunnerEndedError(runner)
            own.renewals += 1
            return {row.id: row.renewals for row in session.scalars(select(JobRunnerRow))}

    def job_runners(self) -> tuple[JobRunnerEntry, ...]:
        """Return all job runners, by id, with the number of jobs each has under way."""
        query = (
            select(JobRunnerRow, func.count(JobRow.id))
            .outerjoin(JobRow, and_(JobRow.state == JobState.RUNNING, JobRow.runner == JobRunnerRow.id))
            .group_by(JobRunnerRow.id)
            .order_by(JobRunnerRow.id)
        )
        with self._read() as session:
            return tuple(
                JobRunnerEntry(row.id, row.host, row.process_id, row.workers, row.started_ns, jobs)
                for row, jobs in session.execute(query)
            )

    def release_unknown_jobs(self, runner: str, known: Collection[str]) -> int:
        """Put back the runner's jobs that it does not know of, as if they had not been claimed.

        A connection that is cut during a commit leaves open whether a job was claimed. Returns their number.
        """
        running = select(JobRow).where(JobRow.state == JobState.RUNNING, JobRow.runner == runner)
        with self._write() as session:
            rows = session.scalars(running.order_by(JobRow.id).with_for_update(key_share=True)).all()
            unknown = [row for row in rows if row.id not in known]
            for row in unknown:
                release(row)
            return len(unknown)

    def end_runner(self, runner: str, *, now_ns: int, max_attempts: int, renewals: int | None = None) -> bool:
        """Queue the jobs of a runner again that is dead; with `renewals`, only if it still counts so many.

        False when there was nothing to end.
        """
        with self._write() as session:
            row = session.get(JobRunnerRow, runner, with_for_update=True)
            if row is None or renewals not in (None, row.renewals):
                return False
            _end(session, runner, now_ns, max_attempts)
            return True


def _end(session: Session, runner: str, now_ns: int, max_attempts: int) -> int:
    row = session.get(JobRunnerRow, runner, with_for_update=True)
    if row is None:
        return 0
    queued = _requeue(session, runner, now_ns, max_attempts)
    session.delete(row)
    return queued


def _requeue(session: Session, runner: str | None, now_ns: int, max_attempts: int) -> int:
    running = (
        select(JobRow)
        .where(JobRow.state == JobState.RUNNING, JobRow.runner == runner)
        .order_by(JobRow.id)
        .with_for_update(key_share=True)
    )
    rows = session.scalars(running).all()
    for row in rows:
        retry_or_give_up(session, row, INTERRUPTED, now_ns=now_ns, max_attempts=max_attempts, pause_s=0.0)
    return len(rows)

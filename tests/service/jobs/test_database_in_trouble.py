"""The job runner while its database fails it."""

import sqlite3
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, closing, contextmanager

import pytest
from sqlalchemy import Engine
from sqlalchemy.exc import OperationalError

from service.recording_store.store import RecordingStore
from service.storage import Repository, connect
from service.storage.records import ClaimedJob
from service.storage.states import JobState
from service.storage.transaction_limits import TransactionLimits
from testing.service.plants import two_motor_plant
from testing.waiting import wait_until
from tests.service.jobs.running import add, ended, running


class CutOff(Repository):
    """The connection is cut after the first claim was kept, and before the answer has come."""

    was_cut = False

    def claim_job(self, *, now_ns: int, runner: str) -> ClaimedJob | None:
        claimed = super().claim_job(now_ns=now_ns, runner=runner)
        if claimed is not None and not self.was_cut:
            self.was_cut = True
            raise OperationalError("COMMIT", None, ConnectionResetError(), connection_invalidated=True)
        return claimed


def test_a_claim_whose_answer_is_lost_holds_up_no_job(
    repository: Repository, store: RecordingStore, engine: Engine
) -> None:
    recording_id = add(repository, store, "fine")
    cut_off = CutOff(engine)
    with running(cut_off, store):
        wait_until(lambda: ended(repository, recording_id))
    assert cut_off.was_cut
    (found,) = repository.jobs(recording_id, limit=5).items
    assert (found.job.state, found.job.attempts) == (JobState.DONE, 1)


@contextmanager
def locked(engine: Engine) -> Iterator[None]:
    """Nobody else can write: the database does not answer in time."""
    if engine.dialect.name == "postgresql":
        with engine.connect() as other:
            other.exec_driver_sql("LOCK TABLE jobs")
            yield
            other.rollback()
        return
    with closing(sqlite3.connect(str(engine.url.database))) as other:
        other.execute("BEGIN IMMEDIATE")
        yield
        other.rollback()


@contextmanager
def without_its_table(engine: Engine) -> Iterator[None]:
    """The database answers, and refuses every statement about jobs."""
    with engine.begin() as connection:
        connection.exec_driver_sql("ALTER TABLE jobs RENAME TO jobs_away")
    yield
    with engine.begin() as connection:
        connection.exec_driver_sql("ALTER TABLE jobs_away RENAME TO jobs")


@pytest.mark.parametrize(
    ("trouble", "problem"),
    [
        (locked, "the database does not answer"),
        (without_its_table, "the database refused a statement of this service"),
    ],
)
def test_a_database_in_trouble_is_a_problem_not_the_end(
    database_url: str,
    store: RecordingStore,
    engine: Engine,
    trouble: Callable[[Engine], AbstractContextManager[None]],
    problem: str,
) -> None:
    impatient = connect(database_url, busy_timeout_s=0.2, limits=TransactionLimits(60.0, 0.2))
    repository = Repository(impatient)
    repository.sync_plant(two_motor_plant())
    with running(repository, store) as runner:
        with trouble(engine):
            wait_until(lambda: problem in (runner.problem() or ""))
        recording_id = add(repository, store, "fine")
        wait_until(lambda: ended(repository, recording_id))
        wait_until(lambda: runner.problem() is None)
    impatient.dispose()

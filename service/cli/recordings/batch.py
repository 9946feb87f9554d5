"""`mcc rediagnose --batch`: the recordings of an archive diagnosed again on a Dask cluster."""

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from sqlalchemy.exc import SQLAlchemyError

from core.time_stamps import nanoseconds
from service.cli.audit.actor import command_line_actor
from service.cli.output import CommandError, failing_clearly, print_document, progress, results
from service.configuration.settings import Settings, SettingsError
from service.plant import PlantError, read_plant
from service.process.logs import without_logs
from service.process.single_instance import AlreadyRunningError
from service.recording_store.opening import open_store_anywhere
from service.storage import Repository, StorageError, connect
from service.storage.migrations import require_current_tables
from service.storage.records import Job
from service.storage.transaction_limits import limits_of

if TYPE_CHECKING:
    from service.application.rediagnosis import Progress as Done
    from service.jobs.dask_workers import DaskWorkers

SHOWN_FAILURES = 20
TROUBLES = (SettingsError, PlantError, StorageError, AlreadyRunningError, SQLAlchemyError, OSError)


def rediagnose_archive(
    config: Path | None,
    scheduler: str | None,
    motors: Sequence[str],
    method: str,
    model: str,
    *,
    processes: int | None,
    made_before: str | None,
    as_json: bool,
) -> None:
    """Diagnose what is to be done, and print what came of it.

    Raises CommandError, also where a diagnosis has failed.
    """
    if find_spec("distributed") is None:
        raise CommandError(
            'rediagnose: expected the library distributed, found none: pip install "statorwatch[dask]"'
        )
    from service.application.rediagnosis import RediagnosisError, Wanted, rediagnose
    from service.jobs.dask_workers import UnusableClusterError

    with failing_clearly(*TROUBLES, RediagnosisError, UnusableClusterError):
        made_before_ns = 0 if made_before is None else _time(made_before)
        settings = Settings.load(config)
        plant = read_plant(settings)
        require_current_tables(settings.database_url)
        names = list(dict.fromkeys(motors)) or [motor.name for motor in plant.motors]
        wanted = Wanted(names, method, model, made_before_ns)
        engine = connect(settings.database_url, limits=limits_of(settings))
        try:
            with without_logs(), _workers(settings, scheduler, processes) as workers, _bar() as show:
                done = rediagnose(
                    settings, plant, Repository(engine), workers, wanted, command_line_actor(), show
                )
        finally:
            engine.dispose()
    _print(done, as_json=as_json)


def _workers(settings: Settings, scheduler: str | None, processes: int | None) -> "DaskWorkers":
    from service.jobs.dask_workers import DaskWorkers

    if scheduler is None:
        return DaskWorkers.of_this_machine(processes or settings.workers)
    return DaskWorkers.of_scheduler(scheduler, open_store_anywhere(settings), settings.dask)


def _time(text: str) -> int:
    """Return a time that has passed: diagnoses before a later one would be made at every start."""
    try:
        time_ns = nanoseconds(text)
    except ValueError as error:
        raise CommandError(f"--made-before: {error}") from error
    if time_ns > time.time_ns():
        raise CommandError(f"--made-before: expected a time that has passed, found {text}")
    return time_ns


def _print(done: "Done", *, as_json: bool) -> None:
    if as_json:
        failed = [_failure(job) for job in done.failed]
        print_document(
            {"to_do": done.to_do, "made": done.made, "already_made": done.already, "failed": failed}
        )
        return
    results().print(
        f"{done.made} of {done.to_do} recordings diagnosed again, {done.already} were done before",
        soft_wrap=True,
    )
    for job in done.failed[:SHOWN_FAILURES]:
        results().print(f"{job.recording_id}: {job.error}", markup=False, soft_wrap=True)
    if done.failed:
        raise CommandError(f"{len(done.failed)} of {done.to_do} diagnoses failed")


def _failure(job: Job) -> dict[str, object]:
    return {"recording_id": job.recording_id, "id": job.id, "error": job.error}


@contextmanager
def _bar() -> Iterator[Callable[["Done"], None]]:
    """Show a progress bar on stderr, if that is a terminal."""
    console = progress()
    columns = (TextColumn("recordings"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("recordings", total=None)
        yield lambda done: bar.update(
            task, completed=done.made + len(done.failed), total=max(done.to_do, done.made + len(done.failed))
        )

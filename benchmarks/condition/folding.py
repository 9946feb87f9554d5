"""What it costs the service to fold records: read from a database, followed, assessed and written back."""

import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import AbstractContextManager, ExitStack, contextmanager
from dataclasses import dataclass, replace
from functools import cache
from math import inf
from pathlib import Path
from time import perf_counter, process_time, sleep
from uuid import uuid4

import numpy as np
from sqlalchemy import Engine, insert

from benchmarks.condition.cost import MOST_MICROSECONDS, PLANT_MOTORS, PLANT_RECORDS
from benchmarks.condition.courses import healthy, shape, with_fault
from benchmarks.condition.marks import Mark, figure_at_most
from benchmarks.condition.operation import draw_operation
from benchmarks.condition.population import draw_motor
from benchmarks.condition.records import REAL_NOISE, measure
from benchmarks.reporting import spread, table
from core.condition.observation import Observation
from core.machines.parameters import Motor
from service.condition.motor_data import document_of
from service.condition.worker import fold_due
from service.configuration.settings import sqlite_url
from service.plant import Plant, PlantMotor, Site
from service.storage import Repository, connect, migrate
from service.storage.models import Base
from service.storage.repository.conditions.observations import observation_row
from testing.service.plants import NOW_NS, relay
from testing.service.postgresql import binaries, serving_postgresql

SITE = "PLANT"
CORES = 2
REFOLDED = (
    f"{PLANT_MOTORS} motors with ten years of hourly records ({PLANT_MOTORS * PLANT_RECORDS:,}) folded again"
    f" by {CORES} workers"
)


@dataclass(frozen=True, slots=True)
class Task:
    """One motor, by its number; faulty: with shorted turns from the middle on."""

    number: int
    records: int
    faulty: bool


@dataclass(frozen=True, slots=True)
class Fold:
    """A motor to fold in a database."""

    database_url: str
    motor: Motor


def records_of(task: Task) -> tuple[Motor, Sequence[Observation]]:
    """Return a motor and what its records tell."""
    random = np.random.default_rng([task.number, 7])
    simulated = draw_motor(random)
    operation = draw_operation(random, task.records)
    course = healthy(task.records)
    if task.faulty:
        course = with_fault(course, 0, 0.01 * shape(task.records, task.records // 2), 0.0)
    observations = measure(random, simulated, operation, course, REAL_NOISE).observations()
    return replace(simulated.motor, name=f"M{task.number:04}"), observations


def fold(task: Fold) -> float:
    """Fold all records of a motor; return the processor time of this process [s], without the database's."""
    _warm_up()
    engine = connect(task.database_url)
    begun = process_time()
    fold_due(Repository(engine), task.motor, inf)
    seconds = process_time() - begun
    engine.dispose()
    return seconds


def folding(motors: int, records: int, pool: Executor) -> Iterator[str | Mark]:
    """Marks, a table of databases and kinds of motors, and the time of the plant."""
    rows = []
    for faulty in (False, True):
        kind = "1 % from the middle on" if faulty else "healthy"
        tasks = [Task(number, records, faulty) for number in range(motors)]
        known = list(spread(records_of, tasks, f"folding, {kind}", pool))
        for name, serving in DATABASES.items():
            with serving() as url:
                if url is None:
                    yield f"{name}: not measured, no server is installed."
                    yield ""
                    continue
                _fill(url, known)
                list(pool.map(_load, range(2 * CORES)))
                begun = perf_counter()
                processor_s = sum(spread(fold, [Fold(url, motor) for motor, _ in known], name, pool))
                elapsed_s = perf_counter() - begun
            number = sum(len(observations) for _, observations in known)
            us = processor_s / number * 1e6
            rows.append(
                [name, kind, f"{motors}", f"{records:,}", f"{us:.0f}", f"{number / elapsed_s:,.0f}"]
            )  # fmt: skip
            if not faulty:
                minutes = PLANT_MOTORS * PLANT_RECORDS * elapsed_s / number / 60
                what = f"{name}: processor time of a worker a record, healthy motor"
                yield figure_at_most(what, us, MOST_MICROSECONDS, "us")
                told = f"{minutes:.0f} minutes, extrapolated from {number:,} records"
                yield Mark(f"{name}: {REFOLDED}", "a stated time", told, met=True)
    yield from table(
        [
            "database", "motors", "number", "records each", "us of a worker a record",
            f"records a second, {CORES} workers",
        ],
        rows,
    )  # fmt: skip


@cache
def _warm_up() -> None:
    """Have this process load all that a fold needs, which it does once."""
    known = [records_of(Task(0, 60, faulty=True))]
    with _sqlite() as url:
        _fill(url, known)
        engine = connect(url)
        fold_due(Repository(engine), known[0][0], inf)
        engine.dispose()


def _load(_: int) -> None:
    _warm_up()
    sleep(1.0)  # so that each process takes one


def _fill(url: str, known: Sequence[tuple[Motor, Sequence[Observation]]]) -> None:
    """Put a plant and all its observations into a migrated database, to be folded from the first one on."""
    engine = connect(url)
    repository = Repository(engine)
    names = [motor.name for motor, _ in known]
    repository.sync_plant(
        Plant(
            sites=(Site(SITE, "Plant"),),
            relays=tuple(relay(f"R-{name}", SITE, 10_000 + at) for at, name in enumerate(names)),
            motors=tuple(PlantMotor(motor, "Motor", SITE, f"R-{motor.name}") for motor, _ in known),
        )
    )
    repository.note_motors({motor.name: document_of(motor) for motor, _ in known}, now_ns=NOW_NS)
    for motor, observations in known:
        _insert(engine, motor.name, observations)
        repository.forget_checkpoints(motor.name)
    engine.dispose()


def _insert(engine: Engine, motor: str, observations: Sequence[Observation]) -> None:
    observed = Base.metadata.tables["observations"]
    rows = [observation_row(str(uuid4()), motor, one) for one in observations]
    with engine.begin() as connection:
        values = [{column.name: getattr(row, column.name) for column in observed.columns} for row in rows]
        connection.execute(insert(observed), values)


@contextmanager
def _sqlite() -> Iterator[str]:
    with tempfile.TemporaryDirectory() as folder:
        url = sqlite_url(Path(folder))
        migrate(url)
        yield url


@contextmanager
def _postgresql() -> Iterator[str | None]:
    folder = binaries()
    if folder is None:
        yield None
        return
    with ExitStack() as stack:
        server = stack.enter_context(serving_postgresql(folder))
        yield stack.enter_context(server.database())


DATABASES: Mapping[str, Callable[[], AbstractContextManager[str | None]]] = {
    "SQLite": _sqlite,
    "PostgreSQL": _postgresql,
}

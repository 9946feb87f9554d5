"""No list or figure of the API is found by reading through a table that grows, whatever it is asked for."""

from collections.abc import Iterator

import pytest
from fastapi import APIRouter, FastAPI
from sqlalchemy import Connection, Engine, text

from benchmarks.storage.filling import fill
from benchmarks.storage.plans import GROWING, Statement, noted, statements_of, whole_scans
from benchmarks.storage.requests import asks
from benchmarks.storage.rows import END_NS, Amounts
from benchmarks.storage.server import api_on
from core.units import NANOSECONDS_PER_DAY
from service.storage import Repository, connect
from service.storage.models import Base
from service.storage.repository.overviews.change_stamps import Subject
from testing.service.database import make_database

AMOUNTS = Amounts.of(4_000, motors=12)

DO_NOT_GROW = frozenset(
    {
        "api_tokens",
        "failed_logins",
        "login_links",
        "passkeys",
        "recovery_codes",
        "used_once",
        "user_sessions",
        "users",
        "sites",
        "ieds",
        "motors",
        "audit_forwarding",
        "audit_head",
        "notifications",
        "notification_alarms",
        "baseline_recordings",
        "baselines",
        "conditions",
        "condition_checkpoints",
        "discarded_folders",
        "fold_marks",
        "gateways",
        "inspection_pictures",
        "inspections",
        "job_runners",
        "leases",
        "link_figures",
        "motor_versions",
        "quarantines",
        "relay_findings",
        "standing_alarm_counts",
        "state_counts",
    }
)
"""Tables that are as large as the plant is, or as the work of the moment."""


@pytest.fixture(scope="module")
def engine(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Engine]:
    """A database with a little of all that the benchmark fills in."""
    url = make_database(tmp_path_factory.mktemp("filled"))
    fill(url, AMOUNTS)
    engine = connect(url)
    yield engine
    engine.dispose()


@pytest.fixture(scope="module")
def app(engine: Engine, tmp_path_factory: pytest.TempPathFactory) -> FastAPI:
    return api_on(Repository(engine), tmp_path_factory.mktemp("api"))


@pytest.fixture
def connection(engine: Engine) -> Iterator[Connection]:
    with engine.connect() as connection:
        yield connection


def test_no_list_and_no_figure_reads_through_a_table_that_grows(
    app: FastAPI, engine: Engine, connection: Connection
) -> None:
    found = [
        f"{ask.label}: {step}: {statement.text}"
        for ask in asks(app)
        for statement in statements_of(app, engine, ask.at(0.5, AMOUNTS))
        for step in whole_scans(statement, statement.plan(connection))
    ]
    assert not found, "\n".join(found)


def test_neither_the_fleet_nor_what_open_pages_are_told_reads_through_a_table_that_grows(
    engine: Engine, connection: Connection
) -> None:
    repository = Repository(engine)
    motors = [motor.name for motor in repository.motors(limit=100).items]
    with noted(engine) as statements:
        assert repository.fleet()
        assert repository.condition_days(motors, from_ns=END_NS - 365 * NANOSECONDS_PER_DAY)
        repository.change_stamps(list(Subject))
        repository.motor_stamps(motors)
    found = [
        f"{step}: {statement.text}"
        for statement in statements
        for step in whole_scans(statement, statement.plan(connection))
    ]
    assert not found, "\n".join(found)


def test_the_trend_reads_no_row_that_has_a_document(
    app: FastAPI, engine: Engine, connection: Connection
) -> None:
    for quantity in ("mu_f", "theta_f", "load_level"):
        path = f"/api/v1/motors/MOTOR-0000/trend?quantity={quantity}"
        *_, points = statements_of(app, engine, path)
        assert "COVERING INDEX ix_diagnoses_trend" in " ".join(points.plan(connection))


@pytest.mark.parametrize(
    ("statement", "reads_all"),
    [
        ("SELECT id FROM recordings WHERE motor = 'M' ORDER BY announced_ns DESC, id DESC LIMIT 9", False),
        ("SELECT id FROM recordings ORDER BY announced_ns DESC, id DESC LIMIT 9", False),
        ("SELECT id FROM recordings WHERE recordings.reason = 'x'", True),
        ("SELECT count(*) FROM recordings", True),
        ("SELECT * FROM recordings WHERE recordings.name = 'x' ORDER BY announced_ns, id LIMIT 9", True),
        ("SELECT * FROM jobs WHERE jobs.recording_id = 'x' ORDER BY jobs.error LIMIT 9", True),
        (
            "SELECT * FROM recordings WHERE recordings.motor = 'M' AND recordings.source = 'relay'"
            " ORDER BY announced_ns, id LIMIT 9",
            True,
        ),
        ("SELECT * FROM motors WHERE motors.description = 'x'", False),
    ],
)
def test_what_counts_as_reading_through_a_table(
    connection: Connection, statement: str, *, reads_all: bool
) -> None:
    asked = Statement(statement, ())
    assert bool(whole_scans(asked, asked.plan(connection))) is reads_all


def test_a_route_that_nobody_has_thought_of_is_named(app: FastAPI) -> None:
    more = FastAPI()
    more.include_router(app.router)
    router = APIRouter()
    router.add_api_route("/api/v1/forgotten", lambda: None)
    more.include_router(router)
    with pytest.raises(LookupError, match=r"neither timed nor excused: \['/api/v1/forgotten'\]"):
        list(asks(more))


def test_every_table_either_grows_or_is_as_large_as_the_plant(connection: Connection) -> None:
    assert set(Base.metadata.tables) == GROWING | DO_NOT_GROW
    empty = [
        name
        for name in sorted(GROWING)
        if not connection.scalar(text(f"SELECT count(*) FROM {name}"))  # noqa: S608 - names of our tables
    ]
    assert not empty

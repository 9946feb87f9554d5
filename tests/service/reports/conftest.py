from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from core.condition.events import Event, EventKind
from core.operation import Operation
from core.units import NANOSECONDS_PER_DAY
from service.condition.motor_data import document_of
from service.recording_store.folder import FolderStore
from service.reports.source import ReportSource
from service.storage import Repository, connect
from service.storage.records.actors import SERVICE
from service.storage.states import LinkState
from testing.service.conditions import DRIFTING, FAULT, HEALTHY, tell
from testing.service.database import make_database
from testing.service.diagnosed import add_diagnosed
from testing.service.job_runner import register_runner
from testing.service.links import set_link_state
from testing.service.observations import HOUR_NS, records_of_a_motor
from testing.service.plants import NOW_NS, fault, undiagnosable
from testing.web.seeding import FAULTY, STALE, STANDING, WATCHED, WELL, demo_plant
from tests.service.fixtures import database_url, engine, repository, store

__all__ = ["database_url", "engine", "repository", "store"]

RECORDS = 40
UNTIL_NS = NOW_NS + RECORDS * HOUR_NS


@pytest.fixture(scope="module")
def seeded(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ReportSource]:
    """The demo's plant: a fault, a motor that is watched, one that stands, one without a recent record."""
    directory: Path = tmp_path_factory.mktemp("seeded")
    engine = connect(make_database(directory))
    repository = Repository(engine)
    plant = demo_plant()
    repository.sync_plant(plant)
    register_runner(repository)
    repository.note_motors({one.name: document_of(one.motor) for one in plant.motors}, now_ns=NOW_NS)
    store = FolderStore(directory / "recordings")
    for number, observed in enumerate(records_of_a_motor(RECORDS, fault_from=25)):
        add_diagnosed(repository, store, fault(), observed.time_ns, name=f"E{number}", observed=observed)
    since_ns = NOW_NS + 25 * HOUR_NS
    faulty = replace(FAULT, motor=FAULTY, as_of_ns=UNTIL_NS - HOUR_NS, since_ns=since_ns)
    tell(repository, faulty, now_ns=UNTIL_NS - HOUR_NS)
    note = Event(NOW_NS + HOUR_NS, EventKind.NOTE, "bearings greased")
    repository.add_event(FAULTY, note, by=SERVICE, on_behalf_of="ann", now_ns=UNTIL_NS)
    for motor, condition, days in ((WATCHED, DRIFTING, 1), (WELL, HEALTHY, 1), (STALE, HEALTHY, 60)):
        last_ns = UNTIL_NS - days * NANOSECONDS_PER_DAY
        tell(repository, replace(condition, motor=motor, as_of_ns=last_ns), now_ns=last_ns)
    stood_ns = UNTIL_NS - 3 * NANOSECONDS_PER_DAY
    tell(repository, replace(HEALTHY, motor=STANDING, as_of_ns=stood_ns), now_ns=stood_ns)
    stands = replace(undiagnosable(), operation=Operation.NOT_RUNNING)
    add_diagnosed(repository, store, stands, UNTIL_NS - HOUR_NS, motor=STANDING)
    down = next(one.relay for one in plant.motors if one.name == STALE)
    for relay in plant.relays:
        state = LinkState.DOWN if relay.name == down else LinkState.UP
        set_link_state(repository, relay.name, state, None, now_ns=NOW_NS)
    yield ReportSource(repository)
    engine.dispose()

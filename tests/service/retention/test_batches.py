"""However much there is to forget, others write beside it."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from statistics import quantiles
from threading import Event, Thread

import pytest
from sqlalchemy import Engine, event

from benchmarks.storage.forgetting import MOTORS, Waits, fill, plant
from core.units import NANOSECONDS_PER_DAY as DAY_NS
from service.background.housekeeping import Housekeeping
from service.configuration.settings import Settings
from service.retention.batches import Batches, Pace
from service.storage import Repository, connect
from service.storage.records import DeletedRows
from service.storage.repository.relays.leases import Share
from service.timing.wall_clock import SETTLING_S
from testing.service.plants import NOW_NS, SECOND_NS

RELAYS = [one.name for one in plant().relays]
HOUR_NS = round(SETTLING_S * SECOND_NS)


@contextmanager
def renewing(url: str, period_s: float) -> Iterator[Waits]:
    """Renew the leases of a gateway, which has a repository of its own, and note how long each takes.

    They are taken before: that inserts a row for each relay, and is no renewal.
    """
    engine = connect(url)
    gateways = Repository(engine)
    gateways.register_gateway("measured", host="here", process_id=1, now_ns=NOW_NS)
    waits, end = Waits(), Event()

    def renew() -> Share:
        return gateways.share_relays("measured", RELAYS, most=MOTORS, problem=None)

    assert renew().held == set(RELAYS)
    thread = Thread(target=waits.repeat, args=(renew, end.wait, period_s))
    thread.start()
    try:
        yield waits
    finally:
        end.set()
        thread.join()
        engine.dispose()


def test_a_lease_is_renewed_between_the_batches(
    database_url: str, engine: Engine, repository: Repository
) -> None:
    repository.sync_plant(plant())
    fill(engine, 10_000)
    batches = Batches(Pace(most_rows=300))
    with renewing(database_url, 0.002) as waits:
        number = batches.run(partial(repository.forget_measurements, 0, before_ns=NOW_NS))
        renewals = len(waits.each_s)
    assert number >= 10_000
    assert renewals > 5, "there were more than 30 batches"


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
def test_a_batch_looks_at_no_row_that_it_leaves(engine: Engine, repository: Repository) -> None:
    """Or each batch of ten million rows would take as long as all of them."""
    repository.sync_plant(plant())
    fill(engine, 20_000)
    hundreds_of_steps = 0

    def count() -> None:
        nonlocal hundreds_of_steps
        hundreds_of_steps += 1

    event.listen(
        engine, "checkout", lambda connection, _entry, _proxy: connection.set_progress_handler(count, 100)
    )
    assert repository.forget_measurements(0, 100, before_ns=NOW_NS).rows < 300
    assert hundreds_of_steps < 300, "of SQLite's machine"


@pytest.mark.campaign
def test_no_renewal_waits_for_long(
    database_url: str, engine: Engine, repository: Repository, tmp_path: Path
) -> None:
    """A gateway with the shortest lease, one second, renews it each 0.1 s, and ends itself 0.8 s later.

    So 0.7 s are left for a renewal. A disk that others keep busy may take some of it for one write, but not
    for one in ten: those wait for a batch or two, of 50 ms.
    """
    repository.sync_plant(plant())
    fill(engine, 300_000)
    housekeeping = Housekeeping(Settings(data_directory=tmp_path, metering_sample_days=1), repository)
    housekeeping.average_and_delete(NOW_NS + 2 * DAY_NS, 0)  # the means; the clock is not trusted yet
    with renewing(database_url, 0.1) as waits:
        housekeeping.average_and_delete(NOW_NS + 2 * DAY_NS + HOUR_NS, HOUR_NS)
    assert repository.measurements("MOTOR-000", 0, limit=1).items == ()
    assert repository.measurements("MOTOR-000", 60, limit=1).items != ()
    assert waits.refused == 0
    assert max(waits.each_s, default=0.0) < 0.7, waits.text()
    # PostgreSQL drops the partitions of old days as a whole, and is done before many renewals come.
    if engine.dialect.name == "sqlite":
        assert len(waits.each_s) > 4
        assert quantiles(waits.each_s, n=10)[-1] < 0.2, waits.text()


def test_a_batch_takes_about_the_time_it_may() -> None:
    left = 10_000

    def delete(rows: int) -> DeletedRows:
        nonlocal left
        deleted = min(rows, left)
        left -= deleted
        return DeletedRows(deleted, deleted * 1e-4)

    batches = Batches(Pace(batch_s=0.05, rest=0.01))
    assert batches.run(delete) == 10_000
    assert batches.largest_s == pytest.approx(0.05)


def test_a_round_ends_and_so_does_a_service_that_stops() -> None:
    assert Batches(Pace(round_s=0.05, rest=0.0)).run(lambda rows: DeletedRows(rows, 1e-3)) > 0, (
        "though there was always more"
    )
    stop = Event()
    stop.set()
    assert Batches(stop=stop).run(lambda rows: DeletedRows(rows, 1e-3)) == 0

"""Gateways to other systems as the service runs them: real processes on a real database."""

from collections.abc import Iterator
from contextlib import contextmanager

from service.configuration.settings import Settings
from service.gateways.supervision import PlantGateways
from service.storage import Repository, connect
from testing.not_installed import not_installed
from testing.service.conditions import HEALTHY, tell
from testing.service.plants import two_motor_plant
from testing.service.postgresql import INSTALLED, PostgresServer, binaries, serving_postgresql
from testing.waiting import wait_until

MOST_RESTARTS = 3
"""A gateway that has ended so often never works."""


@contextmanager
def started_gateways(settings: Settings) -> Iterator[PlantGateways]:
    """Run the gateways of these settings, whether they work or not."""
    gateways = PlantGateways(settings)
    gateways.start()
    try:
        yield gateways
    finally:
        gateways.stop()


@contextmanager
def running_gateways(settings: Settings) -> Iterator[PlantGateways]:
    """Run the gateways of these settings; the block begins when nothing lacks in any of them."""
    with started_gateways(settings) as gateways:
        wait_until(lambda: _work_or_end(gateways), "the gateways to work")
        ended = [one.kind for one in gateways.status() if one.problem is not None]
        assert not ended, f"these ended again and again: {', '.join(ended)}"
        yield gateways


@contextmanager
def healthy_plant_on_postgresql() -> Iterator[tuple[PostgresServer, str]]:
    """A PostgreSQL that can be stopped or frozen, and the URL of its database of two motors, one healthy."""
    folder = binaries()
    if folder is None:
        not_installed(f"no PostgreSQL server in {INSTALLED}: apt-get install postgresql")
    with serving_postgresql(folder) as postgresql, postgresql.database() as url:
        engine = connect(url)
        repository = Repository(engine)
        repository.sync_plant(two_motor_plant())
        tell(repository, HEALTHY)
        engine.dispose()
        yield postgresql, url


def _work_or_end(gateways: PlantGateways) -> bool:
    """Whether all work, or one of them has ended so often that it never will."""
    found = gateways.status()
    return all(one.problem is None for one in found) or any(one.restarts >= MOST_RESTARTS for one in found)

"""No value of a gateway counts as good for longer than documented after the database has fallen silent."""

import time
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import pytest

from service.configuration.gateways.iec104 import Iec104Settings
from service.configuration.gateways.settings import GatewaysSettings
from service.configuration.settings import Settings
from service.gateways.iec104.points import BLOCK, FIRST
from service.gateways.plant_state.following import SILENCE_S
from service.storage import Repository, connect
from testing.not_installed import not_installed
from testing.ports import LOOPBACK, free_port
from testing.service.conditions import HEALTHY, tell
from testing.service.gateways import running_gateways
from testing.service.plants import two_motor_plant
from testing.service.postgresql import INSTALLED, PostgresServer, binaries, serving_postgresql
from testing.waiting import wait_until
from tests.service.gateways.iec104.telegrams import NOT_TOPICAL, Master

LATER_S = 2.0
"""A gateway looks at what was read twice a second, and a question to it takes its time."""


@pytest.mark.campaign
@pytest.mark.parametrize(
    ("ends", "begins"),
    [
        pytest.param(PostgresServer.stop, PostgresServer.start, id="away"),
        pytest.param(PostgresServer.freeze, PostgresServer.thaw, id="frozen"),
    ],
)
def test_a_silent_database_leaves_nothing_good_and_all_is_good_again_after(
    tmp_path: Path, ends: Callable[[PostgresServer], None], begins: Callable[[PostgresServer], None]
) -> None:
    folder = binaries()
    if folder is None:
        not_installed(f"no PostgreSQL server in {INSTALLED}: apt-get install postgresql")
    server = Iec104Settings(port=free_port())
    with serving_postgresql(folder) as postgresql, postgresql.database() as url:
        engine = connect(url)
        repository = Repository(engine)
        repository.sync_plant(two_motor_plant())
        tell(repository, HEALTHY)
        engine.dispose()
        chosen = Settings(
            data_directory=tmp_path,
            database_url=url,
            stale_after_days=3650,
            gateways=GatewaysSettings(iec104=server),
        )
        with running_gateways(chosen) as gateways, closing(Master(LOOPBACK, server.port)) as master:
            pump = FIRST + BLOCK

            def quality() -> int:
                master.interrogate()
                return master.told[pump].quality

            wait_until(lambda: quality() == 0, "a good value")
            ends(postgresql)
            begun_s = time.monotonic()
            wait_until(lambda: quality() == NOT_TOPICAL, "a value that is not topical", within_s=120)
            assert time.monotonic() - begun_s < SILENCE_S + LATER_S
            problem = gateways.status()[0].problem or ""
            assert "database does not answer" in problem or "database has not answered for" in problem
            begins(postgresql)
            wait_until(lambda: quality() == 0, "a good value again")
            wait_until(lambda: gateways.status()[0].problem is None, "no problem any more")

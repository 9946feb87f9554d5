"""No value of a gateway counts as good for longer than documented after the database has fallen silent."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from service.gateways.plant_state.following import SILENCE_S
from service.gateways.supervision import PlantGateways
from testing.service.gateways import healthy_plant_on_postgresql
from testing.service.mosquitto import running_mosquitto
from testing.service.postgresql import PostgresServer
from testing.waiting import wait_until
from tests.service.gateways.watching import all_gateways, watched_gateways

LATER_S = 4.0
"""A gateway looks at what was read twice a second; six of them tell it beside each other."""


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
    with healthy_plant_on_postgresql() as (postgresql, url), running_mosquitto(tmp_path) as broker:
        chosen = all_gateways(tmp_path, broker, database_url=url, stale_after_days=3650)
        with watched_gateways(chosen, broker) as (gateways, watch):
            watch.wait_for_good()
            ends(postgresql)
            longest_s = watch.longest_good_s()
            assert max(longest_s.values()) < SILENCE_S + LATER_S, longest_s
            wait_until(lambda: all_tell_of_it(gateways), "all gateways to tell of the database")
            begins(postgresql)
            watch.wait_for_good()
            wait_until(lambda: all(one.problem is None for one in gateways.status()), "no problem any more")


def all_tell_of_it(gateways: PlantGateways) -> bool:
    return all(
        re.search("database does not answer|database has not answered for", one.problem or "")
        for one in gateways.status()
    )

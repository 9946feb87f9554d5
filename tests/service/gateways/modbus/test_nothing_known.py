"""Modbus tells nothing as good of which nobody knows: before the first reading, and of motors that left."""

import json
import math
import socket
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import pytest

from service.gateways.modbus.gateway import NUMBERS
from service.gateways.modbus.register_map import BLOCK, FIRST_BLOCK, MOST_MOTORS
from service.storage import Repository
from testing.ports import LOOPBACK
from testing.service.conditions import HEALTHY, tell
from testing.service.gateways import healthy_plant_on_postgresql, running_gateways, started_gateways
from testing.service.plants import two_motor_plant
from testing.waiting import eventually, wait_until
from tests.service.gateways.modbus.telegrams import registers
from tests.service.gateways.modbus.test_modbus import FAN, PUMP
from tests.service.gateways.settings import port_of, settings_of

HEALTHY_AND_GOOD = (1, 0, 0, 0, 0, 0, 0, 0, 0, 0)
NOTHING = (0, 0, 0, 2, 2, 0, 1, 0, 0, 0)
"""State unknown, health to be checked, quality bad, stale, no alarm, and a link of which nothing is known."""


@contextmanager
def connected(port: int) -> Iterator[socket.socket]:
    """A connection, once the port is open."""
    wait_until(lambda: is_open(port), "the port")
    with socket.create_connection((LOOPBACK, port), timeout=20) as link:
        yield link


def is_open(port: int) -> bool:
    with socket.socket() as probe:
        return probe.connect_ex((LOOPBACK, port)) == 0


def codes(link: socket.socket, block: int) -> tuple[int, ...]:
    """The integers of a motor."""
    return registers(link, block, 10)


def figures(link: socket.socket, block: int) -> tuple[float, ...]:
    """Its floats."""
    read = (*registers(link, block + 10, 12), *registers(link, block + 26, 6))
    return struct.unpack(">9f", struct.pack(">18H", *read))


def assert_nothing_is_known(link: socket.socket, block: int) -> None:
    assert codes(link, block) == NOTHING, block
    assert all(math.isnan(one) for one in figures(link, block)), block
    assert registers(link, block + 22, 4) == (0,) * 4, "its times"


def test_where_the_database_is_away_from_the_start_every_block_is_bad(tmp_path: Path) -> None:
    (tmp_path / NUMBERS).write_text(json.dumps({"FAN-A2": 0, "PUMP-A1": 1}))
    away = f"postgresql+psycopg://nobody@/none?host={tmp_path}"
    chosen = settings_of("modbus", tmp_path).model_copy(update={"database_url": away})
    with started_gateways(chosen) as gateways, connected(port_of(chosen)) as link:
        for number in range(MOST_MOTORS):
            assert_nothing_is_known(link, FIRST_BLOCK + BLOCK * number)
        version, blocks, alive, *rest = registers(link, 0, 8)
        assert (version, blocks) == (1, 2)
        assert rest == [0] * 5, "nothing is current, nothing was read, no alarm is known"
        wait_until(lambda: registers(link, 2, 1) != (alive,), "the counter to move on")
        told = "database does not answer"
        wait_until(lambda: told in (gateways.status()[0].problem or ""), told)


def test_a_motor_that_left_is_bad_also_where_the_gateway_never_saw_it(
    repository: Repository, tmp_path: Path
) -> None:
    (tmp_path / NUMBERS).write_text(json.dumps({"MILL-X": 0}))
    left, fan, pump = (FIRST_BLOCK + BLOCK * number for number in range(3))
    tell(repository, HEALTHY)
    chosen = settings_of("modbus", tmp_path)
    plant = two_motor_plant()
    with running_gateways(chosen), connected(port_of(chosen)) as link:
        assert eventually(lambda: codes(link, pump) == HEALTHY_AND_GOOD)
        assert codes(link, fan) == NOTHING, "nobody has judged it"
        assert registers(link, 1, 1) == (3,), "what left has its block"
        assert_nothing_is_known(link, left)
        repository.sync_plant(replace(plant, motors=plant.motors[1:]))
        wait_until(lambda: codes(link, pump) == NOTHING, "a block without its motor")
        assert_nothing_is_known(link, pump)
        repository.sync_plant(plant)
        wait_until(lambda: codes(link, pump) == HEALTHY_AND_GOOD, "the motor that is back")


@pytest.mark.campaign
def test_a_database_that_comes_after_the_gateway_makes_the_values_good(tmp_path: Path) -> None:
    with healthy_plant_on_postgresql() as (postgresql, url):
        chosen = settings_of("modbus", tmp_path).model_copy(update={"database_url": url})
        with running_gateways(chosen), connected(port_of(chosen)) as link:
            wait_until(lambda: codes(link, PUMP) == HEALTHY_AND_GOOD, "a good value")
        postgresql.stop()
        with started_gateways(chosen), connected(port_of(chosen)) as link:
            assert registers(link, 3, 1) == (0,)
            for block in (FAN, PUMP):
                assert_nothing_is_known(link, block)
            postgresql.start()
            wait_until(lambda: codes(link, PUMP) == HEALTHY_AND_GOOD, "a good value again")
            assert registers(link, 3, 1) == (1,)

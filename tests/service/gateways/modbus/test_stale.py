"""What Modbus tells of motors of which nothing is known, or nothing new: quality, health and times."""

import math
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from core.units import NANOSECONDS_PER_DAY
from service.gateways.plant_state.following import REFRESH_S, SILENCE_S
from service.storage import Repository
from testing.service.conditions import FAULT, HEALTHY, UNKNOWN, tell
from testing.service.gateways import healthy_plant_on_postgresql, running_gateways
from testing.service.plants import NOW_NS, SECOND_NS
from testing.waiting import eventually, wait_until
from tests.service.gateways.modbus.test_modbus import FAN, PUMP, figures
from tests.service.gateways.settings import port_of, settings_of

HEADER = 0
OLD_NS = NOW_NS - 4000 * NANOSECONDS_PER_DAY
"""More days ago than the settings of these tests let a condition be without becoming stale."""

STALE_DAYS = 0.01
"""The shortest time that the settings allow."""

LATER_S = 3.0
"""A gateway looks twice a second, and a question to it takes its time."""


@pytest.fixture
def port(repository: Repository, tmp_path: Path) -> Iterator[int]:
    settings = settings_of("modbus", tmp_path)
    with running_gateways(settings):
        yield port_of(settings)


def told(port: int, block: int = PUMP) -> list[float]:
    """State, kind, phase, health, quality, rotor and staleness of a motor."""
    return figures(port, block, "", 7)


def times(port: int, block: int = PUMP) -> list[float]:
    """Of the latest record, and since when the state is so."""
    return figures(port, block + 22, ":int", 2)


def test_a_motor_that_was_never_judged_is_bad_and_has_no_figures(port: int) -> None:
    for block in (FAN, PUMP):
        assert eventually(lambda: told(port, block) == [0, 0, 0, 2, 2, 0, 1])  # noqa: B023 - it waits here
        assert all(math.isnan(one) for one in figures(port, block + 10, ":float", 6))
        assert figures(port, block + 7, "", 3) == [0, 0, 0]
        assert times(port, block) == [0, 0]


def test_a_record_of_long_ago_is_uncertain_and_keeps_its_figures_and_its_time(
    repository: Repository, port: int
) -> None:
    tell(repository, replace(HEALTHY, as_of_ns=OLD_NS))
    assert eventually(lambda: told(port) == [1, 0, 0, 2, 1, 0, 1])
    level, low, high = figures(port, PUMP + 10, ":float", 3)
    assert (level, low, high) == pytest.approx((0.0004, 0.0, 0.012))
    assert times(port) == [OLD_NS // SECOND_NS, 0]
    tell(repository, replace(FAULT, as_of_ns=OLD_NS))
    assert eventually(lambda: told(port) == [3, 1, 2, 1, 1, 0, 1]), "a fault stays a failure"
    assert times(port) == [one // SECOND_NS for one in (OLD_NS, FAULT.since_ns or 0)]
    assert figures(port, HEADER + 3, "") == [1], "what is old is not what is not current"


def test_a_record_of_a_later_time_is_uncertain_and_not_stale(repository: Repository, port: int) -> None:
    later_ns = time.time_ns() + 3 * NANOSECONDS_PER_DAY
    tell(repository, replace(HEALTHY, as_of_ns=later_ns))
    assert eventually(lambda: told(port) == [1, 0, 0, 0, 1, 0, 0])
    assert times(port) == [later_ns // SECOND_NS, 0]


def test_records_that_do_not_tell_the_condition_leave_it_uncertain(repository: Repository, port: int) -> None:
    tell(repository, replace(UNKNOWN, as_of_ns=NOW_NS))
    assert eventually(lambda: told(port) == [0, 0, 0, 2, 1, 0, 0])
    assert all(math.isnan(one) for one in figures(port, PUMP + 10, ":float", 4))
    tell(repository, HEALTHY)
    assert eventually(lambda: told(port) == [1, 0, 0, 0, 0, 0, 0])


@pytest.mark.parametrize(
    ("stale_after_days", "age_days", "stale"),
    [(None, 6.5, 0), (None, 7.5, 1), (30.0, 29.5, 0), (30.0, 30.5, 1), (STALE_DAYS, 0.02, 1)],
)
def test_a_condition_is_stale_after_the_days_of_the_settings_or_a_week(
    repository: Repository, tmp_path: Path, stale_after_days: float | None, age_days: float, stale: int
) -> None:
    as_of_ns = time.time_ns() - round(age_days * NANOSECONDS_PER_DAY)
    tell(repository, replace(HEALTHY, as_of_ns=as_of_ns))
    chosen = settings_of("modbus", tmp_path).model_copy(update={"stale_after_days": stale_after_days})
    with running_gateways(chosen):
        assert eventually(lambda: figures(port_of(chosen), PUMP, "") == [1])
        assert told(port_of(chosen)) == [1, 0, 0, 2 * stale, stale, 0, stale]


@pytest.mark.campaign
def test_a_good_value_gets_stale_without_anything_being_written(
    repository: Repository, tmp_path: Path
) -> None:
    chosen = settings_of("modbus", tmp_path).model_copy(update={"stale_after_days": STALE_DAYS})
    with running_gateways(chosen):
        good_for_s = 10
        oldest_ns = round(STALE_DAYS * NANOSECONDS_PER_DAY)
        tell(repository, replace(HEALTHY, as_of_ns=time.time_ns() - oldest_ns + good_for_s * SECOND_NS))
        assert eventually(lambda: told(port_of(chosen)) == [1, 0, 0, 0, 0, 0, 0], good_for_s)
        begun_s = time.monotonic()
        wait_until(lambda: told(port_of(chosen)) == [1, 0, 0, 2, 1, 0, 1], "a value that is stale")
        assert time.monotonic() - begun_s < good_for_s + REFRESH_S + LATER_S


@pytest.mark.campaign
def test_a_database_that_falls_silent_leaves_nothing_good_nor_current(tmp_path: Path) -> None:
    with healthy_plant_on_postgresql() as (postgresql, url):
        chosen = settings_of("modbus", tmp_path).model_copy(update={"database_url": url})
        port = port_of(chosen)

        def current_and_quality() -> list[float]:
            return [*figures(port, HEADER + 3, ""), *figures(port, PUMP + 4, ""), *figures(port, FAN + 4, "")]

        with running_gateways(chosen):
            wait_until(lambda: current_and_quality() == [1, 0, 2], "a good value")
            postgresql.freeze()
            begun_s = time.monotonic()
            wait_until(lambda: current_and_quality() == [0, 1, 2], "none that is good", within_s=120)
            assert time.monotonic() - begun_s < SILENCE_S + LATER_S
            assert figures(port, PUMP, "") == [1], "what was told last stays"
            (alive,) = figures(port, HEADER + 2, "")
            wait_until(lambda: figures(port, HEADER + 2, "") != [alive], "the counter to move on")
            read_at = figures(port, HEADER + 4, ":int")
            assert 0 < time.time() - read_at[0] < 120
            postgresql.thaw()
            wait_until(lambda: current_and_quality() == [1, 0, 2], "a good value again")

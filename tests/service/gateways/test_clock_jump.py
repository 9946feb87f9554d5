"""While this machine's clock is wrong no value counts as good, and all is good again after."""

import os
import time
from dataclasses import replace
from pathlib import Path

import pytest

from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND
from service.gateways.plant_state.following import REFRESH_S
from service.storage import Repository
from testing.service.conditions import FAULT, HEALTHY, tell
from testing.service.mosquitto import running_mosquitto
from tests.service.gateways.watching import all_gateways, watched_gateways

SHIFTED_CLOCK = Path(__file__).parents[2] / "chaos" / "shifted_clock"
STALE_AFTER_DAYS = 7
DAY_S = NANOSECONDS_PER_DAY // NANOSECONDS_PER_SECOND
LATER_S = 4.0
"""A gateway looks twice a second, reading takes its time, and six of them tell it beside each other."""


@pytest.mark.campaign
@pytest.mark.parametrize(
    "off_days",
    [
        pytest.param(-2, id="back, so that the record is of a later time"),
        pytest.param(STALE_AFTER_DAYS + 1, id="ahead, so that the record is stale"),
    ],
)
def test_a_clock_that_jumps_leaves_nothing_good_and_all_is_good_again_when_it_is_right(
    repository: Repository, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, off_days: int
) -> None:
    offset = tmp_path / "clock-offset"
    offset.write_text("0")
    paths = filter(None, (str(SHIFTED_CLOCK), os.environ.get("PYTHONPATH")))
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(paths))
    monkeypatch.setenv("CHAOS_CLOCK_OFFSET", str(offset))
    now_ns = time.time_ns()
    tell(repository, replace(HEALTHY, as_of_ns=now_ns), now_ns=now_ns)
    with running_mosquitto(tmp_path) as broker:
        chosen = all_gateways(tmp_path, broker, stale_after_days=STALE_AFTER_DAYS)
        with watched_gateways(chosen, broker) as (gateways, watch):
            watch.wait_for_good()
            offset.write_text(str(off_days * DAY_S))
            longest_s = watch.longest_good_s()
            assert max(longest_s.values()) < REFRESH_S + LATER_S, longest_s
            tell(repository, replace(FAULT, as_of_ns=now_ns), now_ns=now_ns)
            watch.wait_for_fault()
            offset.write_text("0")
            watch.wait_for_good()
            assert [(one.problem, one.restarts) for one in gateways.status()] == [(None, 0)] * 5

"""The relay's clock in a time zone: records have its summer time."""

from zoneinfo import ZoneInfo

import pytest

from core.time_stamps import nanoseconds
from ied_sim.misbehaviour import MisbehaviourState
from ied_sim.relay.clock import RelayClock
from ied_sim.relay.plant_clock import PlantClock

HOUR_NS = 3600 * 10**9


@pytest.mark.parametrize(
    ("zone", "time", "hours"),
    [
        ("Europe/Berlin", "2026-01-15T12:00:00Z", 1),
        ("Europe/Berlin", "2026-07-15T12:00:00Z", 2),
        ("Europe/Berlin", "2026-10-25T00:59:59.5Z", 2),
        ("Europe/Berlin", "2026-10-25T01:00:00.5Z", 1),
        ("Asia/Kolkata", "2026-07-15T12:00:00Z", 5.5),
        (None, "2026-07-15T12:00:00Z", 0),
    ],
)
def test_records_have_local_time(zone: str | None, time: str, hours: float) -> None:
    state = MisbehaviourState((), lambda: 0.0)
    clock = RelayClock(PlantClock(0), state, None if zone is None else ZoneInfo(zone))
    time_ns = nanoseconds(time)
    assert clock.written(time_ns) - time_ns == hours * HOUR_NS
    assert clock.is_local == (zone is not None)

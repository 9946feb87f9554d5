"""A triggered record that is hours off its trigger tells of a clock in another time zone."""

import pytest

from core.time_stamps import nanoseconds
from service.jobs.relay_time import TriggeredRecord

TRIGGERED_NS = nanoseconds("2026-07-01T12:00:00Z")
MINUTE_NS = 60 * 10**9


def record(minutes: float, *, time_zone: str | None = None, has_time_code: bool = False) -> TriggeredRecord:
    recorded_ns = TRIGGERED_NS + round(minutes * MINUTE_NS)
    return TriggeredRecord("R-1", time_zone, recorded_ns, TRIGGERED_NS, has_time_code)


@pytest.mark.parametrize(
    ("minutes", "words"),
    [
        (120, "2 h ahead"),
        (120.2, "2 h ahead"),
        (330, "5 h 30 min ahead"),
        (345, "5 h 45 min ahead"),
        (-300, "5 h behind"),
        (14 * 60, "14 h ahead"),
    ],
)
def test_hours_off(minutes: float, words: str) -> None:
    wrong = record(minutes).wrong_zone()
    assert wrong is not None
    assert (
        f", {words}: the relay's clock runs in local time: set time_zone in the [[relay]] table of R-1"
        in wrong
    )
    assert "or the relay's clock to UTC" in wrong
    assert not record(minutes).is_right


@pytest.mark.parametrize("minutes", [0, 0.05, -0.9, 5, -7, 100 * 60, 22])
def test_a_clock_that_is_right_or_wrong_otherwise(minutes: float) -> None:
    assert record(minutes).wrong_zone() is None
    assert record(minutes).is_right == (abs(minutes) < 1)


def test_the_cure_where_a_zone_is_set_or_the_record_tells_one() -> None:
    set_wrong = record(-120, time_zone="Europe/Berlin").wrong_zone()
    assert set_wrong is not None
    assert "the motors file says that its clock runs in Europe/Berlin, and it does not" in set_wrong
    told_wrong = record(120, has_time_code=True).wrong_zone()
    assert told_wrong is not None
    assert "the record itself says how far its times are ahead of UTC, and is wrong" in told_wrong

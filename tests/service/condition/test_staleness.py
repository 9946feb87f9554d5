"""A condition is stale when more records are missing than may fail."""

import pytest

from core.units import NANOSECONDS_PER_DAY
from service.condition.staleness import stale_after_ns


@pytest.mark.parametrize(
    ("schedule", "days"),
    [
        (None, 7.0),
        ("0 * * * *", 2.5 / 24),
        ("* 6-17 * * MON-FRI", 2.5 * (2.5 + 1 / 1440)),
        ("30 6 * * MON", 17.5),
        ("0 0 1 * *", 2.5 * 31),
    ],
)
def test_a_condition_is_stale_after_two_and_a_half_of_the_longest_pauses(
    schedule: str | None, days: float
) -> None:
    assert stale_after_ns(schedule) == pytest.approx(days * NANOSECONDS_PER_DAY)


def test_the_settings_say_otherwise() -> None:
    assert stale_after_ns("0 * * * *", 3.0) == 3 * NANOSECONDS_PER_DAY

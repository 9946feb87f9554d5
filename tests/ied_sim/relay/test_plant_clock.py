"""The clock of a plant that lives through its past in leaps."""

import pytest

from core.units import NANOSECONDS_PER_DAY as DAY_NS
from core.units import NANOSECONDS_PER_SECOND as SECOND_NS
from ied_sim.relay.plant_clock import ClockSettings, PlantClock

START_NS = 1_800_000_000 * SECOND_NS
MONTH = ClockSettings(start_days_ago=30.0, speed_up=8641.0, leap_every_s=5.0)
"""Leaps of 12 h every 5 s: 60 of them."""


def test_without_a_past_the_plants_time_is_the_real_one() -> None:
    clock = PlantClock(START_NS)
    for after_s in (-3.2, 0.0, 4.9, 5.0, 1e6):
        real_ns = START_NS + round(after_s * SECOND_NS)
        assert clock.plant_ns(real_ns) == real_ns
        assert clock.real_ns(real_ns) == real_ns


def test_a_month_passes_in_five_minutes_and_then_time_is_real() -> None:
    clock = PlantClock(START_NS, MONTH)
    assert clock.plant_ns(START_NS) == clock.epoch_ns == START_NS - 30 * DAY_NS
    assert clock.plant_ns(START_NS + 150 * SECOND_NS) == START_NS - 15 * DAY_NS + 150 * SECOND_NS
    for after_s in (300, 301, 10_000):
        assert clock.plant_ns(START_NS + after_s * SECOND_NS) == START_NS + after_s * SECOND_NS


def test_between_leaps_a_second_is_a_second() -> None:
    clock = PlantClock(START_NS, MONTH)
    first, last = START_NS + 35 * SECOND_NS, START_NS + 40 * SECOND_NS - 1
    assert clock.plant_ns(last) - clock.plant_ns(first) == last - first
    assert clock.plant_ns(last + 1) - clock.plant_ns(last) == DAY_NS // 2 + 1


@pytest.mark.parametrize("settings", [MONTH, ClockSettings(7.0, 1000.0, 3.0)])
def test_time_never_goes_back_nor_ahead_of_the_real_one(settings: ClockSettings) -> None:
    clock = PlantClock(START_NS, settings)
    reals = [START_NS + round(k * 0.7 * SECOND_NS) for k in range(1200)]
    plants = [clock.plant_ns(real_ns) for real_ns in reals]
    assert plants == sorted(set(plants))
    assert all(plant_ns <= real_ns for plant_ns, real_ns in zip(plants, reals, strict=True))
    assert plants[-1] == reals[-1]
    assert [clock.real_ns(plant_ns) for plant_ns in plants] == reals


def test_a_time_that_is_leapt_over_comes_at_the_leap() -> None:
    clock = PlantClock(START_NS, MONTH)
    assert clock.real_ns(clock.epoch_ns + DAY_NS // 4) == START_NS + 5 * SECOND_NS

"""The relay's thermal element against the trip times and settings that its manual prints."""

import pytest

from core.thermal.course import CurrentStep
from core.thermal.relay_model import HOT, RelaySettings, RelayState, after, cold

TRIPS_WHILE_RUNNING = {1.1: 3183.0, 1.2: 1717.0, 1.3: 1150.0, 1.4: 848.3, 1.5: 662.1, 2.0: 285.1, 2.45: 172.7}
TRIPS_WHILE_STARTING = {2.5: 144.0, 3.0: 100.0, 4.0: 56.25, 6.0: 25.0, 8.0: 14.06, 12.0: 6.25}
"""SEL-749M manual, table 4.5, curve 10, service factor 1.01: hot stator, cold rotor; times [s]."""


def curve(number: int, service_factor: float = 1.01) -> RelaySettings:
    """Settings of a curve, as the manual says which ratings they stand for (F.15 to F.17)."""
    return RelaySettings(service_factor, 6.0, 2.08 * number)


def trip_s(state: RelayState, current: float, settings: RelaySettings) -> float:
    """When the element trips, found by halving."""
    low, high = 0.0, 1e5
    while high - low > 1e-4 * high:
        middle = (low + high) / 2.0
        later = after(state, [CurrentStep(middle, current)], settings)
        low, high = (low, middle) if later.thermal_capacity_used >= 1.0 else (middle, high)
    return high


@pytest.mark.parametrize(("current", "time_s"), TRIPS_WHILE_RUNNING.items())
def test_an_overload_trips_when_the_manual_says(current: float, time_s: float) -> None:
    settings = curve(10)
    hot = after(cold(settings), [CurrentStep(1e7, HOT * settings.service_factor)], settings)

    # The manual's own constant, 2.5 s / ln(...), is rounded to two digits: 2.08 * 1.2 is 2.496.
    assert trip_s(hot, current, settings) == pytest.approx(time_s, rel=0.003)


@pytest.mark.parametrize(("current", "time_s"), TRIPS_WHILE_STARTING.items())
def test_a_locked_rotor_trips_when_the_manual_says(current: float, time_s: float) -> None:
    settings = curve(10)

    assert trip_s(cold(settings), current * 1.00001, settings) == pytest.approx(time_s, rel=0.003)


def test_a_hot_motor_bears_a_locked_rotor_for_its_hot_time() -> None:
    settings = RelaySettings(1.15, 6.0, 10.0)
    hot = after(cold(settings), [CurrentStep(1e7, 1.0)], settings)

    assert trip_s(hot, 6.0, settings) == pytest.approx(10.0, rel=1e-3)
    assert trip_s(cold(settings), 6.0, settings) == pytest.approx(12.0, rel=1e-3)


def test_the_automatic_time_constant_is_that_of_the_manual_s_example() -> None:
    settings = curve(14, service_factor=1.15)

    assert settings.running_s / 60.0 == pytest.approx(81.0, abs=0.5)
    assert settings.standstill_s / 60.0 == pytest.approx(243.0, abs=1.5)


def test_full_load_uses_the_inverse_square_of_the_service_factor() -> None:
    settings = RelaySettings(1.15, 6.0, 10.0)
    state = after(cold(settings), [CurrentStep(1e7, 1.0)], settings)

    assert state.thermal_capacity_used == pytest.approx(1.0 / 1.15**2)


def test_negative_sequence_counts_five_times_while_running_and_once_while_starting() -> None:
    settings = RelaySettings(1.15, 6.0, 10.0)
    uneven = after(cold(settings), [CurrentStep(1e7, 0.8, 0.2)], settings)
    even = after(cold(settings), [CurrentStep(1e7, (0.8**2 + 5 * 0.2**2) ** 0.5)], settings)
    started = after(cold(settings), [CurrentStep(2.0, 5.0, 1.0)], settings)

    assert uneven.heat == pytest.approx(even.heat)
    assert started.heat == pytest.approx(2.0 * 26.0)


def test_a_start_that_succeeds_does_not_trip_and_its_heat_goes() -> None:
    settings = RelaySettings(1.15, 6.0, 10.0)
    started = after(cold(settings), [CurrentStep(8.0, 6.0)], settings)
    running = after(started, [CurrentStep(1.0, 0.9)], settings)
    later = after(running, [CurrentStep(1e7, 0.9)], settings)

    assert started.starting
    assert not running.starting
    assert started.thermal_capacity_used == pytest.approx(8.0 / 12.0)
    assert running.thermal_capacity_used == pytest.approx(started.thermal_capacity_used, rel=0.01)
    assert later.thermal_capacity_used == pytest.approx((0.9 / 1.15) ** 2)


def test_one_long_step_is_many_short_ones() -> None:
    settings = RelaySettings(1.15, 6.0, 10.0)
    long = after(cold(settings), [CurrentStep(600.0, 0.9), CurrentStep(900.0, 0.0)], settings)
    short = after(cold(settings), [CurrentStep(1.0, 0.9)] * 600 + [CurrentStep(1.0, 0.0)] * 900, settings)

    assert long.heat == pytest.approx(short.heat)


@pytest.mark.parametrize(
    "values", [(0.9, 6.0, 10.0), (1.15, 2.0, 10.0), (1.15, 6.0, 0.0), (1.15, 6.0, 10.0, -1.0)]
)
def test_settings_that_no_relay_takes_are_refused(values: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match=r"above zero|service factor"):
        RelaySettings(*values)

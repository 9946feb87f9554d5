"""Thermal capacity used, where the currents are known at times only."""

import pytest

from core.machines.parameters import ThermalElement
from core.thermal.bounded_rises import bounded_capacity
from core.thermal.course import CurrentStep
from core.thermal.relay_model import settings_of

SETTINGS = settings_of(ThermalElement(1.15, 6.0, 12.0, running_time_constant_s=1800.0))
AT_FULL_LOAD = 1.0 / 1.15**2


def test_nothing_known_is_anything_from_cold_to_full_load() -> None:
    assert bounded_capacity([7200.0], SETTINGS) == pytest.approx((0.0, AT_FULL_LOAD))


def test_known_hours_close_the_bounds_at_the_squared_current() -> None:
    low, high = bounded_capacity([3600.0, CurrentStep(10 * 1800.0, 0.8)], SETTINGS)
    assert low == pytest.approx(0.64 * AT_FULL_LOAD, rel=1e-3)
    assert high == pytest.approx(low, rel=1e-3)


def test_an_unknown_hour_opens_them_again() -> None:
    known = [CurrentStep(10 * 1800.0, 0.8)]
    low, high = bounded_capacity([*known, 1800.0], SETTINGS)
    assert low < 0.64 * AT_FULL_LOAD < high < AT_FULL_LOAD

"""When a rotor that gets worse reaches its limit."""

import numpy as np
import pytest

from core.condition.forecast.outcome import HORIZONS_DAYS
from core.motor_condition.rotor_forecast import rotor_forecast
from core.rotor.judgement import FAULT_DB
from core.units import NANOSECONDS_PER_DAY

SOUND_DB = -48.0
SCATTER_DB = 0.8
"""Standard deviation of a severity from record to record."""
TRIALS = 200


def decibels(asymmetry: np.ndarray) -> np.ndarray:
    return np.asarray(20.0 * np.log10(asymmetry))


def growing(random: np.random.Generator, days: int) -> np.ndarray:
    """Asymmetry of a cage, day by day: the rate wanders, or feeds itself."""
    start = 10.0 ** (SOUND_DB / 20.0)
    t = np.arange(float(days))
    if random.random() < 0.5:
        rate = 10.0 ** random.uniform(-4.6, -3.9) * np.exp(np.cumsum(0.05 * random.standard_normal(days)))
        return np.asarray(start + np.cumsum(rate))
    return np.asarray(start * np.exp(np.minimum(t / random.uniform(60.0, 300.0), 20.0)))


def test_about_eight_in_ten_hold_that_are_told_to_hold_with_80_percent() -> None:
    random = np.random.default_rng(13)
    held = told = 0
    for _ in range(TRIALS):
        true = growing(random, 6000)
        crossing = int(np.searchsorted(true, 10.0 ** (FAULT_DB / 20.0)))
        watched = int(np.searchsorted(true, 10.0 ** ((SOUND_DB + 4.0) / 20.0)))
        seen = watched + int(random.uniform(0.2, 0.9) * (crossing - watched))
        if seen - watched < 6 or crossing >= true.size:
            continue
        noisy = decibels(true[: seen + 1]) + SCATTER_DB * random.standard_normal(seen + 1)
        entries = [
            (day * NANOSECONDS_PER_DAY, float(one)) for day, one in enumerate(noisy) if day > seen - 200
        ]
        found = rotor_forecast(entries, watched * NANOSECONDS_PER_DAY, [SOUND_DB])
        assert found.chances is not None
        if found.chances[-1] < 0.2:
            continue
        until = float(np.interp(0.2, found.chances, HORIZONS_DAYS))
        told += 1
        held += crossing - seen > until
    assert told > 100
    assert 0.7 <= held / told <= 0.95


def test_without_a_change_nothing_is_forecast() -> None:
    found = rotor_forecast([(k * NANOSECONDS_PER_DAY, SOUND_DB) for k in range(30)], None)
    assert found.chances is None
    assert found.limit == pytest.approx(10.0 ** (FAULT_DB / 20.0))


def test_a_step_that_stays_is_no_growth() -> None:
    random = np.random.default_rng(2)
    severities = np.where(np.arange(60) < 20, SOUND_DB, -42.0) + SCATTER_DB * random.standard_normal(60)
    entries = [(k * NANOSECONDS_PER_DAY, float(one)) for k, one in enumerate(severities)]
    found = rotor_forecast(entries, 20 * NANOSECONDS_PER_DAY, [SOUND_DB])
    soon = found.reached_within(30.0)
    assert soon is not None
    assert soon < 0.1

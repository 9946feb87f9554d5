"""When a level reaches a limit: growth of several kinds, and none."""

from collections.abc import Callable
from time import process_time

import numpy as np
import pytest
from numpy.typing import NDArray

from core.condition.assessment import Level
from core.condition.forecast.forecast import QUANTILES, forecast, limit_ahead
from core.condition.forecast.outcome import Forecast
from core.units import NANOSECONDS_PER_DAY

Array = NDArray[np.float64]
Course = Callable[[np.random.Generator, Array], Array]

LIMIT = 0.005
NOISE = 2e-4
RECORDS = 3000
PER_DAY = 24.0


def flat(rng: np.random.Generator, t: Array) -> Array:
    return np.full(t.size, rng.uniform(0.3, 0.9) * LIMIT)


def linear(rng: np.random.Generator, t: Array) -> Array:
    return np.asarray(10.0 ** rng.uniform(-4.8, -3.5) * t)


def exponential(rng: np.random.Generator, t: Array) -> Array:
    return np.asarray(
        10.0 ** rng.uniform(-4.0, -3.0) * np.expm1(np.minimum(t / rng.uniform(40.0, 300.0), 30.0))
    )


def wandering(rng: np.random.Generator, t: Array) -> Array:
    steps = 10.0 ** rng.uniform(-6.0, -5.0) * rng.standard_normal(t.size)
    growth = np.maximum(0.0, 10.0 ** rng.uniform(-5.0, -4.0) + np.cumsum(steps))
    return np.cumsum(growth)


def told(t: Array, m: Array, rng: np.random.Generator, upto: int) -> Forecast:
    """Return the forecast from the latest 200 records before one of them."""
    shown = slice(max(0, upto - 200), upto + 1)
    noisy = m[shown] + NOISE * rng.standard_normal(m[shown].size)
    times = np.rint(t[shown] / PER_DAY * NANOSECONDS_PER_DAY).astype(np.int64)
    return forecast([(int(time), float(level)) for time, level in zip(times, noisy, strict=True)], LIMIT)


def coverage(course: Course, *, trials: int = 600, irregular: bool = False) -> tuple[float, int]:
    """Return the share of published intervals that hold the true time, and how many were published."""
    rng = np.random.default_rng(7)
    inside = published = 0
    for _ in range(trials):
        hours = np.arange(RECORDS, dtype=np.float64)
        true = course(rng, hours)
        t = np.cumsum(rng.exponential(1.0, RECORDS)) if irregular else hours
        m = np.interp(t, hours, true)
        seen = max(10, int(np.searchsorted(m, rng.uniform(0.3, 0.9) * LIMIT)))
        if seen >= min(int(np.searchsorted(m, LIMIT)), RECORDS - 1):
            continue
        days = told(t, m, rng, seen).days
        if days is None:
            continue
        published += 1
        reached = np.interp(LIMIT, true, hours) if true[-1] > LIMIT else np.inf
        truth = (reached - t[seen]) / PER_DAY
        inside += days[0] <= truth <= days[2]
    return inside / max(published, 1), published


@pytest.mark.parametrize("irregular", [False, True])
@pytest.mark.parametrize(
    ("course", "least"),
    [(linear, 0.96), (wandering, 0.80), (exponential, 0.80)],
    ids=["linear", "wandering", "exponential"],
)
def test_the_interval_covers_what_it_says(course: Course, least: float, irregular: bool) -> None:
    share, published = coverage(course, irregular=irregular)
    assert published >= 200
    assert share >= least


def test_no_growth_has_no_trend() -> None:
    rng = np.random.default_rng(3)
    t = np.arange(200.0)
    found = [told(t, flat(rng, t), rng, upto) for upto in (20, 60, 199) for _ in range(40)]
    assert sum(one.days is not None for one in found) <= 4
    assert max(abs(one.growth_per_day or 0.0) for one in found if one.days is None) < 0.005


def test_a_line_is_told_with_its_growth() -> None:
    rng = np.random.default_rng(1)
    t = np.arange(400.0)
    found = told(t, 1e-5 * t, rng, 300)
    assert found.growth_per_day == pytest.approx(24e-5, rel=0.1)
    assert found.days is not None
    low, mid, high = found.days
    assert mid == pytest.approx(200.0 / PER_DAY, rel=0.15)
    assert low < mid < high


def test_the_same_trend_is_told_of_daily_and_hourly_records() -> None:
    rng = np.random.default_rng(2)
    m = 2e-5 * np.arange(150.0) + NOISE * rng.standard_normal(150)
    hourly = forecast([(k * NANOSECONDS_PER_DAY // 24, level) for k, level in enumerate(m)], LIMIT)
    daily = forecast([(k * NANOSECONDS_PER_DAY, level) for k, level in enumerate(m)], LIMIT)
    assert hourly.days is not None
    assert daily.days == pytest.approx([24.0 * days for days in hourly.days], rel=0.05)
    assert hourly.growth_per_day == pytest.approx(24.0 * (daily.growth_per_day or 0.0))


def test_what_stands_brings_the_limit_nearer_and_doubt_widens() -> None:
    rng = np.random.default_rng(4)
    levels = [
        (k * NANOSECONDS_PER_DAY // 24, 1e-5 * k + NOISE * float(rng.standard_normal())) for k in range(200)
    ]
    alone, beside = forecast(levels, LIMIT).days, forecast(levels, LIMIT, standing=0.002).days
    sure = forecast(levels, LIMIT, today=Level(1e-5 * 199, 1e-6, 0)).days
    doubtful = forecast(levels, LIMIT, today=Level(1e-5 * 199, 3e-4, 0)).days
    assert alone is not None
    assert beside is not None
    assert sure is not None
    assert doubtful is not None
    assert beside[1] == pytest.approx(alone[1] - 200.0 / PER_DAY, abs=1.5)
    assert sure == pytest.approx(alone, rel=0.1)
    assert doubtful[0] < alone[0] < alone[2] < doubtful[2]
    smaller = forecast(levels, LIMIT, today=Level(0.5e-5 * 199, 1e-6, 0))
    assert smaller.days is not None
    assert smaller.days[1] == pytest.approx((LIMIT / 0.5e-5 - 199.0) / PER_DAY, rel=0.1)
    assert smaller.growth_per_day == pytest.approx(0.5e-5 * PER_DAY, rel=0.1)


@pytest.mark.parametrize("levels", [[], [(0, 0.001)] * 3, [(5, 0.001)] * 10])
def test_too_few_records_tell_no_growth(levels: list[tuple[int, float]]) -> None:
    assert forecast(levels, LIMIT) == Forecast(LIMIT)


def test_records_at_one_time_and_perfect_lines_do_no_harm() -> None:
    doubled = [(k // 2 * NANOSECONDS_PER_DAY, 1e-4 * (k // 2)) for k in range(40)]
    found = forecast(doubled, LIMIT)
    assert found.days is not None
    assert found.days[1] == pytest.approx(31.0, rel=0.05)


def test_above_its_limit_a_level_is_told_when_it_doubles() -> None:
    assert limit_ahead(0.004, 0.005) == 0.005
    assert limit_ahead(0.005, 0.005) == 0.01
    assert limit_ahead(0.0333, 0.005) == 0.04


def test_a_step_at_the_onset_is_not_taken_for_growth() -> None:
    rng = np.random.default_rng(6)
    growth = 2e-5 * np.maximum(np.arange(60.0) - 3.0, 0.0)
    levels = np.where(np.arange(60) < 3, 0.0, 0.003 + growth) + 5e-5 * rng.standard_normal(60)
    told_of = forecast([(k * NANOSECONDS_PER_DAY // 24, float(m)) for k, m in enumerate(levels)], LIMIT)
    assert told_of.growth_per_day == pytest.approx(24.0 * 2e-5, rel=0.2)
    assert told_of.days is not None
    assert told_of.days[1] == pytest.approx((0.002 / 2e-5 - 56.0) / 24.0, rel=0.2)


def test_a_level_that_drifts_with_the_winding_s_temperature_shows_no_trend() -> None:
    rng = np.random.default_rng(8)
    warming = 0.004 * (1.0 + 0.1 * np.linspace(0.0, 1.0, 200))
    levels = warming + 2e-5 * rng.standard_normal(200)
    found = forecast([(k * NANOSECONDS_PER_DAY // 24, float(m)) for k, m in enumerate(levels)], LIMIT)
    assert found.days is None
    assert found.growth_per_day == pytest.approx(0.0004 * PER_DAY / 199.0, rel=0.2)


def test_chances_are_those_of_the_days_and_less_sure_of_a_level_that_is_scaled() -> None:
    rng = np.random.default_rng(14)
    levels = [
        (k * NANOSECONDS_PER_DAY // 24, 1e-5 * k + NOISE * float(rng.standard_normal())) for k in range(200)
    ]
    plain = forecast(levels, LIMIT)
    assert plain.chances is not None
    assert plain.days is not None
    for share, days in zip(QUANTILES, plain.days, strict=True):
        assert plain.reached_within(days) == pytest.approx(share, abs=0.08), "between times that are kept"
    assert plain.reached_within(0.0) == 0.0
    assert plain.reached_within(4000.0) is None
    assert list(plain.chances) == sorted(plain.chances)
    scaled = forecast(levels, LIMIT, today=Level(1e-5 * 199, 1e-6, 0)).chances
    assert scaled is not None
    assert all(one >= other - 1e-3 for one, other in zip(scaled, plain.chances, strict=True))
    assert Forecast(LIMIT).reached_within(1.0) is None


def test_growth_that_has_stopped_shows_no_trend_any_more() -> None:
    rng = np.random.default_rng(9)
    t = np.arange(300.0)
    m = 3e-5 * np.minimum(t, 100.0)
    told_then, told_later = told(t, m, rng, 100), [told(t, m, rng, upto) for upto in (200, 250, 299)]
    assert told_then.days is not None
    assert [one.days for one in told_later] == [None, None, None]


def test_the_interval_of_today_s_level_is_that_of_the_time() -> None:
    levels = [(k * NANOSECONDS_PER_DAY // 24, 1e-5 * k) for k in range(201)]
    likely = forecast(levels, LIMIT, today=Level(0.002, 1e-6, 0)).days
    less = forecast(levels, LIMIT, today=Level(0.002, 4e-4, 0, (0.001, 0.002))).days
    more = forecast(levels, LIMIT, today=Level(0.002, 4e-4, 0, (0.002, 0.004))).days
    assert likely is not None
    assert less is not None
    assert more is not None
    # A level that is half of that in truth reaches the limit after four times the days so far.
    assert less[2] > 4.0 * 200.0 / PER_DAY > likely[2]
    assert less[0] == pytest.approx(likely[0], rel=0.15)
    assert more[0] < 0.8 * likely[0]
    assert more[2] == pytest.approx(likely[2], rel=0.15)


def test_it_is_fast() -> None:
    rng = np.random.default_rng(5)
    levels = [
        (k * NANOSECONDS_PER_DAY // 24, 1e-5 * k + NOISE * float(rng.standard_normal())) for k in range(64)
    ]
    forecast(levels, LIMIT)
    spent = []
    for _ in range(20):
        begun = process_time()
        forecast(levels, LIMIT)
        spent.append(process_time() - begun)
    assert min(spent) < 0.0006  # about 0.12 ms; shared caches make it three times as long

"""Of levels of which it was told that they stay below their limit until a day with 80 %, about 80 % do."""

from benchmarks.condition.forecasts import FIRST, Growth, Task, follow_growth, stayed
from benchmarks.condition.records import REAL_NOISE

MOTORS = 12
GROWING = (Growth.LINEAR, Growth.WANDERING, Growth.EXPONENTIAL)


def test_about_eight_in_ten_hold_that_are_told_to_hold_with_80_percent() -> None:
    tasks = [Task(growth, FIRST + number, REAL_NOISE) for growth in GROWING for number in range(MOTORS)]
    looks = [look for task in tasks for look in follow_growth(task)]
    held, told = stayed(looks, 0.8)
    assert told >= 100
    assert 0.7 <= held / told <= 0.92
    surely, _ = stayed(looks, 0.95)
    assert surely >= held

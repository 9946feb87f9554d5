"""Growth beyond what the interval leaves open, and what is a new kind of asymmetry."""

from hypothesis import given
from hypothesis import strategies as st

from service.alarms.growth import LevelSeen, has_grown, is_another_kind, magnitude

LEVELS = st.floats(1e-4, 0.5)


@given(LEVELS, LEVELS, st.floats(0.0, 0.1), st.floats(0.0, 1.0))
def test_growth_is_told_only_where_the_interval_leaves_no_doubt(
    told: float, level: float, half: float, share: float
) -> None:
    seen = LevelSeen(level, max(0.0, level - half), level + half)
    grown = has_grown(told, seen, share)
    assert grown == (level - half > told and level >= told * (1.0 + share))
    assert not has_grown(level, seen, share)  # what was told last has not grown


@given(LEVELS, st.floats(0.05, 0.5), st.lists(st.floats(-1.9, 1.9), min_size=1, max_size=100))
def test_a_level_that_scatters_within_its_interval_calls_nobody_again(
    level: float, relative: float, scatter: list[float]
) -> None:
    """Each record's level is off by less than its interval, and people are told the first one."""
    deviation = relative * level / 1.96
    lowest = min([0.0, *scatter])
    told = level + lowest * deviation
    for off in scatter:
        value = level + off * deviation
        if value - told < 1.96 * deviation:
            assert not has_grown(told, LevelSeen(value, value - 1.96 * deviation, None), 0.0)


@given(st.floats(0.001, 0.01), st.integers(1, 60))
def test_steady_growth_calls_again_now_and_then(first: float, records: int) -> None:
    told, calls = first, 0
    for number in range(records):
        level = first * 1.05**number
        if has_grown(told, LevelSeen(level, 0.8 * level, 1.2 * level), 0.1):
            told, calls = level, calls + 1
    # Each call needs a level a quarter higher than the one before: five steps of 5 %.
    assert calls == (records - 1) // 5


def test_without_an_interval_nothing_is_known_to_have_grown() -> None:
    assert not has_grown(0.01, LevelSeen(0.5, None, None), 0.1)


def test_only_another_kind_is_new() -> None:
    told = frozenset({"shorted-turns", "connection"})
    assert not is_another_kind(told, frozenset({"shorted-turns"}))
    assert not is_another_kind(frozenset({"shorted-turns"}), told)
    assert not is_another_kind(told, frozenset())
    assert is_another_kind(told, frozenset({"voltage-channel"}))
    assert is_another_kind(frozenset(), frozenset({"voltage-channel"}))


@given(LEVELS, st.floats(0.0, 0.5))
def test_a_channel_that_reads_too_little_grows_as_one_that_reads_too_much(size: float, half: float) -> None:
    high, low = LevelSeen(size, size - half, size + half), LevelSeen(-size, -size - half, -size + half)
    assert magnitude(low) == magnitude(high)
    assert magnitude(high) == LevelSeen(size, max(0.0, size - half), size + half)

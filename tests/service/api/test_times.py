"""Times of answers."""

from hypothesis import given
from hypothesis import strategies as st

from core.time_stamps import MAX_NS, rfc3339
from service.api.times import rfc3339_of_all


@given(st.lists(st.integers(min_value=-MAX_NS, max_value=MAX_NS)))
def test_many_times_are_told_as_each_of_them(times_ns: list[int]) -> None:
    assert rfc3339_of_all(times_ns) == [rfc3339(time_ns) for time_ns in times_ns]

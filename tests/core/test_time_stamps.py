from datetime import UTC, datetime

import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.time_stamps import MAX_NS, nanoseconds, rfc3339


@given(st.integers(min_value=-(2**62), max_value=MAX_NS))
def test_times_come_back_to_the_nanosecond(time_ns: int) -> None:
    assert nanoseconds(rfc3339(time_ns)) == time_ns


@given(st.datetimes(timezones=st.just(UTC), min_value=datetime(1700, 1, 1), max_value=datetime(2260, 1, 1)))
def test_python_reads_our_times(time: datetime) -> None:
    assert datetime.fromisoformat(rfc3339(nanoseconds(time.isoformat()))) == time


@pytest.mark.parametrize(
    ("text", "same"),
    [
        ("2026-01-31T12:00:00Z", "2026-01-31T12:00:00.000000000Z"),
        ("2026-01-31t12:00:00.5z", "2026-01-31T12:00:00.500000000Z"),
        ("2026-01-31T12:00:00.1234567891+02:00", "2026-01-31T10:00:00.123456789Z"),
        ("2016-12-31T23:59:60Z", "2017-01-01T00:00:00.000000000Z"),
        ("9999-12-31T23:59:59Z", "2262-04-11T23:47:16.854775807Z"),
    ],
)
def test_forms_of_a_time(text: str, same: str) -> None:
    assert rfc3339(nanoseconds(text)) == same


def test_a_date_is_its_beginning() -> None:
    assert nanoseconds("2026-01-31") == nanoseconds("2026-01-31T00:00:00Z")


@pytest.mark.parametrize(
    "text", ["", "2026-1-31", "2026-02-30", "2026-01-31T12:00:00", "2026-02-31T12:00:00Z", "1"]
)
def test_what_is_no_time(text: str) -> None:
    with pytest.raises(ValueError):  # noqa: PT011  # any ValueError is what the contract says
        nanoseconds(text)

from hypothesis import given
from hypothesis import strategies as st

from service.timing.backoff import Backoff, RestartDelay


def test_pauses_double_up_to_the_longest() -> None:
    backoff = Backoff(first_s=0.5, longest_s=10.0)
    assert [backoff.pause_s(failures) for failures in range(8)] == [0.0, 0.5, 1.0, 2.0, 4.0, 8.0, 10.0, 10.0]


@given(st.integers(min_value=1, max_value=10**9))
def test_no_number_of_failures_overflows(failures: int) -> None:
    assert 0.5 <= Backoff(first_s=0.5, longest_s=10.0).pause_s(failures) <= 10.0


def test_each_further_end_is_waited_for_longer_until_a_run_was_stable() -> None:
    delay = RestartDelay(Backoff(first_s=0.2, longest_s=30.0), stable_after_s=60.0)
    lasted_s = [0.0] * 10 + [60.0, 60.5, 0.0]
    expected_s = [0.2, 0.4, 0.8, 1.6, 3.2, 6.4, 12.8, 25.6, 30.0, 30.0, 30.0, 0.2, 0.4]
    assert [delay.after_run_s(each) for each in lasted_s] == expected_s

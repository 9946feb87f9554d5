"""Since when links are down, and when a whole site is."""

from hypothesis import given
from hypothesis import strategies as st

from service.alarms.outages import LinkPeriod, SiteRule, down_since

SETTLE = 60


@st.composite
def histories(draw: st.DrawFn) -> tuple[list[LinkPeriod], int]:
    lengths = draw(st.lists(st.integers(1, 200), min_size=1, max_size=20))
    first_is_up = draw(st.booleans())
    begins = [sum(lengths[:number]) for number in range(len(lengths))]
    periods = [LinkPeriod(begin, (number % 2 == 0) is first_is_up) for number, begin in enumerate(begins)]
    return periods, sum(lengths)


def is_up_at(periods: list[LinkPeriod], time: int) -> bool:
    return [period.is_up for period in periods if period.since_ns <= time][-1]


@given(histories())
def test_a_link_is_down_since_it_was_last_up_for_long(history: tuple[list[LinkPeriod], int]) -> None:
    """Second by second: the outage begins with the first second after which no answer lasted."""
    periods, now = history
    began, up_for = None, 0
    for second in range(now):
        if is_up_at(periods, second):
            up_for += 1
            began = None if up_for >= SETTLE else began
        else:
            began, up_for = second if began is None else began, 0
    assert down_since(periods, now, SETTLE) == began


def up(since: int) -> LinkPeriod:
    return LinkPeriod(since, is_up=True)


def down(since: int) -> LinkPeriod:
    return LinkPeriod(since, is_up=False)


def test_an_answer_now_and_then_ends_no_outage() -> None:
    flapping = [up(0), down(1000), up(1500), down(1510)]
    assert down_since(flapping, 2000, SETTLE) == 1000
    assert down_since([*flapping, up(2000)], 2059, SETTLE) == 1000
    assert down_since([*flapping, up(2000)], 2060, SETTLE) is None
    assert down_since([up(0)], 10, SETTLE) is None
    assert down_since([], 10, SETTLE) is None


RULE = SiteRule(share=0.8, within_ns=60, least=3)


def test_most_relays_within_a_minute_are_a_site_that_is_lost() -> None:
    assert RULE.lost_since([5, *range(100, 140)], 50) == 100
    assert RULE.lost_since([0, 30, 60], 3) == 0
    assert RULE.lost_since([0, 30, 61], 3) is None
    assert RULE.lost_since(range(39), 50) is None


def test_relays_that_fail_one_by_one_speak_for_themselves() -> None:
    assert RULE.lost_since(range(0, 50 * 61, 61), 50) is None


def test_two_relays_are_no_site() -> None:
    assert RULE.lost_since([0, 0], 2) is None


@given(st.integers(1, 100), st.lists(st.integers(0, 1000), max_size=100))
def test_a_site_that_is_lost_is_not_back(relays: int, down: list[int]) -> None:
    if RULE.lost_since(down, relays) is not None:
        assert not RULE.is_back(len(down), relays)
    assert RULE.is_back(0, relays)

"""A link over some days: nothing is claimed of the time that nobody knows of."""

from hypothesis import given
from hypothesis import strategies as st

from core.units import NANOSECONDS_PER_DAY
from service.storage.records import LinkChange
from service.storage.states import LinkState
from service.web.relays.links import link_history
from testing.service.plants import NOW_NS

DAY = NANOSECONDS_PER_DAY
UP, DOWN, UNKNOWN = LinkState.UP, LinkState.DOWN, LinkState.UNKNOWN


def change(days_ago: float, state: LinkState) -> LinkChange:
    return LinkChange(NOW_NS - round(days_ago * DAY), state, None)


def test_a_relay_that_was_away_for_a_day_of_ten() -> None:
    history = link_history([change(40, UP), change(3, DOWN), change(2, UP)], days=10, now_ns=NOW_NS)
    assert history.sentence == "The relay answered 90.0 % of the last 10 days, with one outage."
    assert [span.state for span in history.spans] == ["up", "down", "up"]


def test_a_relay_that_is_new_and_one_that_nobody_knows() -> None:
    history = link_history([change(5, UP)], days=10, now_ns=NOW_NS)
    assert (
        history.sentence
        == "The relay answered 100.0 % of the 5 days that are known of the last 10 days, with no outage."
    )
    assert history.spans[0].state is None
    assert link_history([], days=30, now_ns=NOW_NS).sentence == "No data of the link in the last 30 days."
    only = link_history([change(1, UNKNOWN)], days=1, now_ns=NOW_NS)
    assert only.answered is None


def test_no_share_is_rounded_to_what_it_is_not() -> None:
    """Four minutes are no thirty days, and a day with an outage of seconds is no whole one."""
    new = link_history([change(4 / 1440, UP)], days=30, now_ns=NOW_NS)
    assert (
        new.sentence
        == "The relay answered 100.0 % of the 4 minutes that are known of the last 30 days, with no outage."
    )
    assert "link-not-known" in new.picture("R1")
    short = link_history([change(40, UP), change(1, DOWN), change(0.9999, UP)], days=30, now_ns=NOW_NS)
    assert short.sentence == "The relay answered more than 99.9 % of the last 30 days, with one outage."


def test_a_service_that_starts_again_is_no_outage_of_the_relay() -> None:
    changes = [change(9, UP), change(2, UNKNOWN), change(1.9, UP), change(1, DOWN), change(0.9, DOWN)]
    assert link_history(changes, days=10, now_ns=NOW_NS).outages == 1


@given(st.lists(st.tuples(st.floats(0, 100), st.sampled_from(LinkState)), max_size=20), st.integers(1, 60))
def test_the_parts_make_up_the_whole(found: list[tuple[float, LinkState]], days: int) -> None:
    changes = [change(ago, state) for ago, state in sorted(found, key=lambda one: -one[0])]
    history = link_history(changes, days=days, now_ns=NOW_NS)
    assert history.spans[0].begin_ns == NOW_NS - days * DAY
    assert history.spans[-1].end_ns == NOW_NS
    for one, other in zip(history.spans, history.spans[1:], strict=False):
        assert one.end_ns == other.begin_ns
    assert 0.0 <= history.known <= 1.0
    assert history.answered is None or 0.0 <= history.answered <= 1.0

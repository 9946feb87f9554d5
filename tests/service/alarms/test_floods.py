"""A thousand alarms in a minute become one line that says so."""

from collections import Counter
from collections.abc import Sequence

from hypothesis import given
from hypothesis import strategies as st

from service.alarms.floods import EVERYWHERE, FreshAlarm, floods, is_over, told

SITES = st.sampled_from(["A", "B", "C", None])
PRIORITIES = st.sampled_from(["critical", "high", "low"])
SEEN = st.lists(st.tuples(SITES, PRIORITIES), max_size=120)


def fresh(seen: Sequence[tuple[str | None, str]]) -> list[FreshAlarm]:
    return [
        FreshAlarm(str(number), site, priority, "link-down") for number, (site, priority) in enumerate(seen)
    ]


@given(SEEN, st.integers(2, 20))
def test_there_are_never_more_lines_of_a_priority_than_can_be_read(
    seen: list[tuple[str | None, str]], most: int
) -> None:
    alarms = fresh(seen)
    found = floods(alarms, most)
    hidden = [member.id for flood in found for member in flood.members]
    assert len(hidden) == len(set(hidden))
    lines = Counter(alarm.priority for alarm in alarms if alarm.id not in set(hidden))
    lines += Counter(flood.priority for flood in found)
    assert all(number <= most for number in lines.values())


@given(SEEN, st.integers(2, 20))
def test_what_is_no_flood_stays_as_it_is(seen: list[tuple[str | None, str]], most: int) -> None:
    for flood in floods(fresh(seen), most):
        assert len(flood.members) > most
        assert {member.priority for member in flood.members} == {flood.priority}
        assert flood.site is EVERYWHERE or {member.site for member in flood.members} == {flood.site}


def test_a_flood_of_minor_alarms_hides_no_urgent_one() -> None:
    (flood,) = floods(fresh([("A", "low")] * 1000 + [("A", "critical")] * 2), 10)
    assert (flood.site, flood.priority, len(flood.members)) == ("A", "low", 1000)
    assert told({"file-refused": 20, "link-down": 980}, 640) == (
        "1000 alarms at once: 980 link-down, 20 file-refused; 640 of them stand"
    )


def test_floods_of_many_sites_are_one() -> None:
    seen: list[tuple[str | None, str]] = [
        (f"site {number}", "low") for number in range(40) for _ in range(25)
    ]
    (flood,) = floods(fresh(seen), 10)
    assert (flood.site, len(flood.members)) == (EVERYWHERE, 1000)


def test_a_flood_is_over_when_the_rest_can_be_read() -> None:
    assert is_over(5, 10)
    assert not is_over(6, 10)

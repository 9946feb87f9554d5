"""Confirmation, dead bands and delays: what is seen once raises nothing, and nothing chatters."""

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from service.alarms.confirmation import Confirmation, DeadBand, Decision, Delays


@st.composite
def confirmations(draw: st.DrawFn) -> Confirmation:
    of = draw(st.integers(1, 8))
    needed = draw(st.integers(1, of))
    return Confirmation(needed, of, draw(st.integers(of - needed + 1, of + 3)))


def alarms(looks: list[bool], rule: Confirmation) -> list[bool]:
    """Return whether an alarm stands after each look."""
    stands, course = False, []
    for number in range(1, len(looks) + 1):
        decision = rule.decide(looks[:number], stands=stands)
        stands = {Decision.RAISE: True, Decision.CLEAR: False, Decision.KEEP: stands}[decision]
        course.append(stands)
    return course


@given(confirmations(), st.lists(st.booleans(), max_size=60))
def test_an_alarm_follows_only_from_as_many_bad_looks_as_confirm_it(
    rule: Confirmation, looks: list[bool]
) -> None:
    course = alarms(looks, rule)
    for at, stands in enumerate(course):
        before = course[at - 1] if at else False
        if stands and not before:
            assert sum(looks[max(0, at + 1 - rule.of) : at + 1]) >= rule.needed
        if before and not stands:
            assert looks[at + 1 - rule.good : at + 1] == [False] * rule.good


@given(confirmations(), st.lists(st.booleans(), max_size=60))
def test_each_alarm_takes_bad_looks_of_its_own_and_so_nothing_chatters(
    rule: Confirmation, looks: list[bool]
) -> None:
    course = [False, *alarms(looks, rule)]
    raised = sum(after and not before for before, after in pairwise(course))
    assert raised * rule.needed <= sum(looks)
    assert (raised - 1) * rule.good <= looks.count(False)


@given(confirmations(), st.lists(st.booleans(), max_size=30))
def test_only_the_latest_looks_matter(rule: Confirmation, looks: list[bool]) -> None:
    for stands in (True, False):
        decision = rule.decide(looks, stands=stands)
        assert rule.decide(looks[-rule.looks :], stands=stands) is decision
        assert decision is not (Decision.RAISE if stands else Decision.CLEAR)


@given(confirmations())
def test_lasting_trouble_is_always_told_and_lasting_peace_too(rule: Confirmation) -> None:
    course = alarms([True] * rule.of + [False] * rule.good, rule)
    assert course[rule.needed - 1 : rule.of] == [True] * (rule.of - rule.needed + 1)
    assert course[-1] is False


def test_one_bad_look_of_two_in_three_raises_nothing() -> None:
    rule = Confirmation(2, 3, 2)
    assert alarms([True, False, False, True, False, False], rule) == [False] * 6
    assert alarms([True, False, True, False, True, False, False], rule) == [
        *(False, False, True, True, True, True),
        False,
    ]


@pytest.mark.parametrize(("needed", "of", "good"), [(0, 3, 3), (4, 3, 3), (2, 3, 1), (1, 3, 2)])
def test_figures_that_contradict_each_other_are_refused(needed: int, of: int, good: int) -> None:
    with pytest.raises(ValueError, match="expected"):
        Confirmation(needed, of, good)


FIGURES = st.floats(-1e6, 1e6)


@given(FIGURES, FIGURES, st.lists(st.tuples(FIGURES, FIGURES).map(sorted), max_size=30))
def test_between_its_two_ends_a_dead_band_changes_nothing(
    raise_at: float, clear_at: float, seen: list[list[float]]
) -> None:
    if raise_at == clear_at:
        with pytest.raises(ValueError, match="expected two figures"):
            DeadBand(raise_at, clear_at)
        return
    band = DeadBand(raise_at, clear_at)
    sign = 1.0 if raise_at > clear_at else -1.0
    for low, high in seen:
        for stands in (True, False):
            decision = band.decide_between(low, high, stands=stands)
            mildest = low if sign > 0 else high
            worst = high if sign > 0 else low
            if decision is Decision.RAISE:
                assert not stands
                assert sign * mildest >= sign * raise_at
            elif decision is Decision.CLEAR:
                assert stands
                assert sign * worst <= sign * clear_at
            elif stands:
                assert sign * worst > sign * clear_at
            else:
                assert sign * mildest < sign * raise_at
            if low == high:
                assert band.decide(low, stands=stands) is decision


@given(st.floats(0.01, 1.0), st.lists(st.floats(-0.5, 0.5), max_size=50))
def test_noise_within_the_dead_band_makes_one_alarm_at_most(width: float, noise: list[float]) -> None:
    band = DeadBand(raise_at=1.0, clear_at=1.0 - width)
    stands, changes = False, 0
    for step in noise:
        decision = band.decide(1.0 + step * width, stands=stands)
        changes += decision is not Decision.KEEP
        stands = stands or decision is Decision.RAISE
    assert changes <= 1


@pytest.mark.parametrize(
    ("for_s", "is_bad", "stands", "expected"),
    [
        (9.9, True, False, Decision.KEEP),
        (10.0, True, False, Decision.RAISE),
        (10.0, True, True, Decision.KEEP),
        (4.9, False, True, Decision.KEEP),
        (5.0, False, True, Decision.CLEAR),
        (5.0, False, False, Decision.KEEP),
    ],
)
def test_what_lasts_is_told_and_what_comes_back_for_a_moment_is_not_over(
    for_s: float, is_bad: bool, stands: bool, expected: Decision
) -> None:
    assert Delays(10.0, 5.0).decide(for_s, is_bad=is_bad, stands=stands) is expected

"""A condition in words, as pages and reports say it."""

from dataclasses import replace

import pytest

from core.condition.kinds import Kind, State
from core.units import NANOSECONDS_PER_DAY
from service.condition.staleness import Missing, missing
from service.condition.wording import advice_now, cause, expected, finding, level_ahead, since
from service.web.words import day, percent
from testing.service.conditions import DRIFTING, FAULT, HEALTHY, OPEN_PHASE, entry_of
from testing.service.plants import NOW_NS

DAY_NS = NANOSECONDS_PER_DAY


def test_an_open_finding_is_told_as_what_it_may_be() -> None:
    assert cause(entry_of(FAULT)) == "shorted turns, phase b"
    assert cause(entry_of(DRIFTING)) == "may be an error of a voltage channel or shorted turns, phase c"
    alone = replace(entry_of(DRIFTING), candidates=(Kind.SHORTED_TURNS,))
    assert cause(alone) == "may be shorted turns, phase c"
    assert cause(replace(alone, candidates=(), phase=None)) == "a change that another record has to confirm"
    assert cause(entry_of(HEALTHY)) == ""


def test_shorted_turns_in_no_sure_phase_have_the_likely_ones() -> None:
    likely = "shorted turns in phase a (72 %) or c (28 %)"
    assert cause(entry_of(OPEN_PHASE)) == likely
    assert finding(entry_of(OPEN_PHASE), None, complete=True) == f"S{likely[1:]}"
    drifting = replace(DRIFTING, phase=None, phase_probabilities=(0.72, 0.0, 0.28))
    assert cause(entry_of(drifting)) == f"may be an error of a voltage channel or {likely}"
    told = finding(entry_of(drifting), None, complete=True)
    assert told == f"A change that may be an error of a voltage channel or {likely}"
    joint = replace(OPEN_PHASE, kind=Kind.CONNECTION)
    assert cause(entry_of(joint)) == "more resistance in a joint", "its phase would be another one's"


def test_without_a_recent_record_the_last_finding_is_told_as_such() -> None:
    healthy = entry_of(HEALTHY)
    assert finding(healthy, None, complete=True) == "No change is seen"
    assert finding(healthy, Missing.STALE, complete=True) == "Last known: no change is seen"
    told = finding(entry_of(FAULT), Missing.NOT_RUNNING, complete=True)
    assert told == "Last known: shorted turns in phase b"
    never = replace(healthy, state=State.UNKNOWN)
    assert finding(never, Missing.STALE, complete=False) == "Nothing is known of its windings yet"


def test_without_a_recent_record_the_advice_is_to_record() -> None:
    assert advice_now(HEALTHY.advice, State.HEALTHY, None) == HEALTHY.advice
    assert advice_now(FAULT.advice, State.FAULT, Missing.STALE) == FAULT.advice
    assert "runs again" in advice_now(HEALTHY.advice, State.HEALTHY, Missing.NOT_RUNNING)
    stale = advice_now(HEALTHY.advice, State.HEALTHY, Missing.STALE)
    assert stale.startswith("Last known: healthy. Have the motor recorded")


@pytest.mark.parametrize(
    ("recorded", "stood", "why"),
    [
        (None, None, None),
        (1, None, None),
        (8, None, Missing.STALE),
        (8, 1, Missing.NOT_RUNNING),
        (None, 8, Missing.STALE),
        (1, 2, None),
    ],
)
def test_why_a_recent_record_is_missing(recorded: int | None, stood: int | None, why: Missing | None) -> None:
    as_of_ns, stood_ns = (None if days is None else NOW_NS - days * DAY_NS for days in (recorded, stood))
    assert missing(as_of_ns, stood_ns, NOW_NS, 7 * DAY_NS) is why


def test_a_forecast_is_counted_from_the_latest_record_and_told_from_now_on() -> None:
    days = (0.0, 1.4, 8.9)
    as_of_ns = 20_000 * DAY_NS
    fresh = expected("2.00 %", as_of_ns, days, as_of_ns, day)
    assert fresh == "It likely reaches 2.00 % in about 34 hours, on 2024-10-05 (2024-10-04 to 2024-10-12)."
    passed = expected("2.00 %", as_of_ns, days, as_of_ns + 7 * DAY_NS, day)
    assert passed == (
        "It was expected to reach 2.00 % by 2024-10-05 (2024-10-04 to 2024-10-12), "
        "counted from the latest record."
    )
    later = expected("2.00 %", as_of_ns, (9.0, 12.0, 20.0), as_of_ns + 7 * DAY_NS, day, short=True)
    assert later == "It likely reaches 2.00 % in about 5 days, on 2024-10-16."


def test_the_level_ahead_is_told_from_the_motors_limit() -> None:
    assert level_ahead(0.005, 0.005, percent) == "the motor's limit of 0.50 %"
    told = level_ahead(0.02, 0.005, percent)
    assert told == "2.00 % (the next level; the motor's limit is 0.50 %)"
    assert level_ahead(0.02, None, percent) == "2.00 %"


def test_since_when_is_not_known_of_what_the_first_record_shows() -> None:
    assert since("2026-11-03", is_from_first_record=False) == "since 2026-11-03"
    told = since("2026-11-03", is_from_first_record=True)
    assert told == "there since the first record, of 2026-11-03; since when is not known"

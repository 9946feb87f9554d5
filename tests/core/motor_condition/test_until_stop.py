"""Whether a motor may run until its planned stop."""

from collections.abc import Mapping, Sequence

import pytest

from core.condition.forecast.outcome import HORIZONS_DAYS, Forecast
from core.condition.kinds import State
from core.motor_condition.parts import Part, PartCondition
from core.motor_condition.until_stop import UntilStop, until_stop
from core.units import NANOSECONDS_PER_DAY

AS_OF_NS = 1_760_000_000 * 10**9
LIMIT = 0.005
GROWING = Forecast(LIMIT, chances=tuple(min(days / 100.0, 1.0) for days in HORIZONS_DAYS))
"""One chance in a hundred more each day."""
SOUND = (
    PartCondition(Part.STATOR, State.HEALTHY, "no shorted turns"),
    PartCondition(Part.ROTOR, State.HEALTHY, "even"),
)


def asked(
    days: float,
    *parts: PartCondition,
    forecasts: Mapping[Part, Forecast] | None = None,
    stale: bool = False,
) -> UntilStop:
    ahead = {Part.STATOR: GROWING, Part.ROTOR: GROWING} if forecasts is None else forecasts
    return until_stop(
        AS_OF_NS + round(days * NANOSECONDS_PER_DAY),
        parts,
        ahead,
        as_of_ns=dict.fromkeys(ahead, AS_OF_NS),
        stale=stale,
        fault_level=LIMIT,
    )


def watched(part: Part) -> PartCondition:
    return PartCondition(part, State.WATCH, "something grows")


def test_a_stator_that_grows_is_told_with_its_probability_and_until_when_it_is_90_percent() -> None:
    answer = asked(20.0, watched(Part.STATOR), SOUND[1])
    assert answer.probability == pytest.approx(0.8)
    assert answer.likely_until_ns == pytest.approx(AS_OF_NS + 10 * NANOSECONDS_PER_DAY, rel=1e-9)
    assert any("which load would make it 90 %" in one for one in answer.reasons)
    assert asked(5.0, watched(Part.STATOR), SOUND[1]).probability == pytest.approx(0.95)


def test_parts_are_independent() -> None:
    answer = asked(20.0, watched(Part.STATOR), watched(Part.ROTOR))
    assert answer.probability == pytest.approx(0.64)
    assert answer.likely_until_ns is not None
    days = (answer.likely_until_ns - AS_OF_NS) / NANOSECONDS_PER_DAY
    assert (1.0 - days / 100.0) ** 2 == pytest.approx(0.9, abs=0.001)


def test_nothing_is_said_of_a_motor_of_which_nothing_moves() -> None:
    answer = asked(20.0, *SOUND)
    assert answer.probability is None
    assert answer.likely_until_ns is None
    assert answer.reasons[0] == "no part is seen to move towards its limit"


def test_a_rotor_that_was_not_assessed_is_left_out_and_named() -> None:
    answer = asked(20.0, watched(Part.STATOR), PartCondition(Part.ROTOR, State.UNKNOWN, "not assessed"))
    assert answer.probability == pytest.approx(0.8)
    assert answer.reasons[0] == "without the rotor: not assessed"


@pytest.mark.parametrize(
    ("parts", "why"),
    [
        ((), "the stator is not assessed"),
        ((PartCondition(Part.STATOR, State.UNKNOWN, ""), watched(Part.ROTOR)), "the stator is not assessed"),
        ((watched(Part.STATOR),), "stator: it is on watch, and how fast it grows is not known"),
    ],
)
def test_what_is_not_known_is_not_told(parts: Sequence[PartCondition], why: str) -> None:
    answer = asked(20.0, *parts, forecasts={Part.STATOR: Forecast(LIMIT)})
    assert answer.probability is None
    assert answer.reasons[0] == why


def test_a_part_beyond_its_limit_is_told_whatever_else_is_known() -> None:
    ahead = Forecast(0.01, chances=GROWING.chances)
    fault = PartCondition(Part.STATOR, State.FAULT, "shorted turns")
    answer = asked(20.0, fault, SOUND[1], forecasts={Part.STATOR: ahead}, stale=True)
    assert answer.probability == 0.0
    assert answer.reasons == ("beyond the limit already: stator",)
    assert answer.parts[0].reason == (
        "beyond its limit already; 80 % likely that its level stays below 1.00 %"
    )
    likely = asked(20.0, watched(Part.STATOR), SOUND[1], forecasts={Part.STATOR: ahead})
    assert likely.probability == 0.0, "its level is above the limit, if not for sure"
    rotor = asked(20.0, SOUND[0], PartCondition(Part.ROTOR, State.FAULT, "broken bars"))
    assert (rotor.probability, rotor.reasons) == (0.0, ("beyond the limit already: rotor",))


def test_old_records_tell_nothing() -> None:
    answer = asked(20.0, watched(Part.STATOR), SOUND[1], stale=True)
    assert answer.probability is None
    assert answer.reasons == ("the latest record is too old",)
    assert {one.probability for one in answer.parts} == {None}


def test_a_stop_beyond_the_forecast_is_not_told() -> None:
    answer = asked(5000.0, watched(Part.STATOR), SOUND[1])
    assert answer.reasons == ("stator: the stop is more than 10 years ahead",)


def test_other_parts_on_watch_are_named_and_have_no_limit() -> None:
    answer = asked(20.0, watched(Part.STATOR), SOUND[1], watched(Part.THERMAL), watched(Part.EFFICIENCY))
    assert answer.probability == pytest.approx(0.8)
    assert [one.part for one in answer.parts] == [Part.STATOR, Part.ROTOR, Part.THERMAL]
    assert answer.reasons[0] == "without the thermal: no limit is forecast"


def test_a_certain_forecast_is_not_taken_for_a_limit_that_is_passed() -> None:
    sure = Forecast(LIMIT, chances=(0.0, *(1.0 for _ in HORIZONS_DAYS[1:])))
    answer = asked(20.0, watched(Part.STATOR), SOUND[1], forecasts={Part.STATOR: sure})
    assert answer.probability == 0.0
    assert not answer.parts[0].is_beyond
    assert answer.reasons[0].startswith("a fault that begins later")


def test_the_document_has_times_as_text() -> None:
    document = asked(20.0, watched(Part.STATOR), SOUND[1]).as_dict()
    assert str(document["stop"]).startswith("2025-10-29T")
    assert str(document["likely_until"]).startswith("2025-10-19T")

"""Why a motor is judged as it is, in words."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

from core.condition.assessment import PHASES, Assessment, Change, Level, Phase, Reference
from core.condition.events import Event
from core.condition.filter.state import START
from core.condition.forecast.outcome import Forecast
from core.condition.kinds import Kind
from core.condition.severity import FEW, Interval, standing_stays_a_fault, stands_out, stays_a_fault
from core.diagnosis.phase_words import phase_in_words
from core.time_stamps import SECONDS_END, rfc3339
from core.time_words import time_ahead

MOST_CERTAIN: Final = 99.0
"""Highest probability that is told as a figure [%]."""

WORDS: Final = {
    Kind.NONE: "nothing",
    Kind.SHORTED_TURNS: "shorted turns",
    Kind.VOLTAGE_CHANNEL: "a voltage channel",
    Kind.CURRENT_CHANNEL: "a current channel",
    Kind.CONNECTION: "a joint",
    Kind.SUPPLY: "the supply",
    Kind.PARAMETERS: "the motor's impedance",
    Kind.ROTOR: "the rotor",
    Kind.ASYMMETRY: "an asymmetry of unknown cause",
    Kind.OTHER_LOAD: "a capacitor or another load behind the relay",
    Kind.UNCLEAR: "something else",
}
"""Each kind as a part of a sentence."""


def reasons_of(assessment: Assessment, limit: float, forecast: Forecast) -> tuple[str, ...]:
    """Return the reasons of a condition.

    Parameters
    ----------
    assessment : Assessment
        What the records tell.
    limit : float
        Limit of the motor, a fraction of the phase turns.
    forecast : Forecast
        Growth of the level.

    Returns
    -------
    tuple of str
        The reasons, the most important first.
    """
    found = [*_of_change(assessment.change, limit)] if assessment.change is not None else []
    found += _of_forecast(forecast)
    found += _of_standing(assessment, limit)
    found += _of_reference(assessment.reference)
    if assessment.seen_by is not None:
        found.append(
            f"the latest record is of another recorder or direction of rotation than those of "
            f"{assessment.seen_by}, in which this is seen; it stays until they or a person say otherwise"
        )
    if assessment.unconfirmed and assessment.change is None:
        found.insert(0, "the latest record differs from all before: another has to confirm it")
    return tuple(found)


def reason_of_unknown(ended_by: Event | None) -> str:
    """Return why nothing is known of a motor.

    Parameters
    ----------
    ended_by : Event or None
        The event that ended the reference, where there is no record since.

    Returns
    -------
    str
        The reason.
    """
    if ended_by is None:
        return "there is no valid record yet"
    said = f" ({ended_by.reason})" if ended_by.reason else ""
    return (
        f"there is no valid record since the event {ended_by.kind}{said} of {_seconds(ended_by.time_ns)}, "
        "which ended the reference"
    )


def _of_change(change: Change, limit: float) -> Iterator[str]:
    since = _seconds(change.since_ns)
    level = change.level
    if change.until_ns is not None:
        either = " or ".join(WORDS[kind] for kind in change.named)
        until = _seconds(change.until_ns)
        yield (f"{either}{_where(level)} from {since} to {until}: gone; was it repaired? Tell it with a note")
        yield f"their level was {_interval(level)}"
        return
    if not change.named:
        likely = sorted(change.probabilities.items(), key=lambda one: -one[1])
        yield f"something has changed since {since}; it may be " + ", ".join(
            f"{WORDS[kind]} ({_chance(probability)})" for kind, probability in likely if probability >= FEW
        )
    elif len(change.named) > 1:
        either = " or ".join(WORDS[kind] for kind in change.named)
        yield f"{either} since {since}: the records cannot tell which"
    elif change.named == (Kind.SHORTED_TURNS,):
        yield f"shorted turns{_where(level)} since {since}: {_interval(level)} more"
    elif change.named == (Kind.ASYMMETRY,):
        yield (
            f"an asymmetry of unknown cause since {since}: neither shorted turns nor a channel nor a joint "
            "explains it; a record at another load tells more"
        )
    elif change.named == (Kind.OTHER_LOAD,):
        drawn = "" if change.size is None else f", of {_percent(change.size)} of the rated current"
        yield (
            f"a capacitor or another load behind the relay's transformers has changed since {since}{drawn}: "
            "the current of the positive and of the negative sequence has changed as such a load does, and "
            "not as shorted turns do"
        )
    else:
        where = "" if change.channel is None else f" of phase {PHASES[change.channel]}"
        yield (
            f"{WORDS[change.named[0]]}{where} has changed{_by(change)} since {since}; "
            f"probability {_chance(change.probabilities.get(change.named[0], 0.0))}"
        )
    if not change.named and change.probabilities.get(Kind.OTHER_LOAD, 0.0) >= FEW:
        yield (
            "the negative-sequence current of a capacitor or a heater between two lines is like that of "
            "shorted turns; a record at another load, or the feeder's current while the motor is at rest, "
            "tells which it is"
        )
    if len(change.named) != 1 and change.probabilities.get(Kind.SHORTED_TURNS, 0.0) >= FEW:
        yield f"if it is shorted turns{_where(level)}: {_interval(level)}"
    if Kind.SHORTED_TURNS in change.named:
        above = level.ci95[0] > limit
        lies = "lies above" if above else "reaches below"
        yield f"the interval {lies} the motor's limit of {_percent(limit)}"
        if not above and stays_a_fault(change, limit):
            yield "it lay above the limit before; shorted turns do not heal, so it stays a fault"


def of_slip_rings(assessment: Assessment) -> Iterator[str]:
    """Return why no phase is told of a motor with slip rings.

    Parameters
    ----------
    assessment : Assessment
        What the records tell.

    Yields
    ------
    str
        The reason.
    """
    if assessment.change is not None or assessment.standing_fault:
        yield (
            "no phase is named: a rotor with slip rings does not damp the harmonics of a coil, so that they "
            "change what shorted turns look like"
        )


def _of_forecast(forecast: Forecast) -> Iterator[str]:
    growth = forecast.growth_per_day
    if growth is None:
        return
    if forecast.days is None:
        yield f"whether the level grows is not certain: it may never reach {_percent(forecast.limit)}"
    else:
        low, mid, high = (time_ahead(days) for days in forecast.days)
        yield (
            f"the level grows by {100.0 * growth:.3f} % a day; it reaches {_percent(forecast.limit)} in "
            f"about {mid}, in eight of ten cases between {low} and {high}"
        )


def _of_standing(assessment: Assessment, limit: float) -> Iterator[str]:
    reference = assessment.reference
    standing = reference.standing
    beyond = (
        f"the asymmetry that stands from the first record on lies {reference.standing_score:.1f} standard "
        "deviations from what sensors of this class leave"
    )
    if assessment.standing_fault:
        yield f"{beyond}: shorted turns{_where(standing)}, {_interval(standing)}"
        above = "above" if standing.value > limit else "below"
        yield f"their likeliest level lies {above} the motor's limit of {_percent(limit)}"
        if standing.value <= limit and standing_stays_a_fault(assessment, limit):
            yield "it lay above the limit before; shorted turns do not heal, so it stays a fault"
    elif reference.accepted:
        yield "a person has declared the motor healthy as it was when the reference was restarted"
        before = reference.declared
        if before is not None:
            yield (
                f"until then the records showed shorted turns{_in_phase(before.phase)}: "
                f"{_with_interval(before.level, before.ci95)}"
            )
        if stands_out(replace(assessment, reference=replace(reference, accepted=False)), limit):
            yield f"{beyond}; as shorted turns{_where(standing)}: {_interval(standing)}"
        else:
            yield f"the records since then leave room for shorted turns up to {_percent(standing.ci95[1])}"
    elif stands_out(assessment, limit):
        yield f"{beyond}; as shorted turns{_where(standing)}: {_interval(standing)}"
    else:
        yield (
            "the asymmetry that stands from the first record on is one of sensors of this class; it can hide "
            f"shorted turns up to {_percent(standing.ci95[1])}"
        )


def _of_reference(reference: Reference) -> Iterator[str]:
    if not reference.complete:
        yield (
            f"the reference is still being learnt ({reference.records} of {START} records): no change can be "
            "seen yet"
            if reference.records < START
            else f"the reference is learnt ({START} records): changes can be seen from the next record on"
        )
    elif reference.detectable is not None:
        yield (
            f"the reference holds {reference.records} records; a step of {_percent(reference.detectable)} of "
            "the turns would be seen within ten records in nine of ten cases"
        )


def _where(level: Level) -> str:
    """Return where shorted turns lie, as a part of a sentence; "" where no phase is told."""
    if level.phases is None:
        return ""
    if level.phase is None:
        return f" in phase {phase_in_words(level.phases)}"
    axis = "" if level.axis_deg is None else f", in coils of the axis {level.axis_deg:+.0f} degrees"
    return f"{_in_phase(level.phase)}{axis}"


def _in_phase(phase: Phase | None) -> str:
    return "" if phase is None else f" in phase {phase}"


def _interval(level: Level) -> str:
    return _with_interval(max(0.0, level.value), level.ci95)


def _by(change: Change) -> str:
    if change.size is None:
        return ""
    if change.size_ci95 is None:
        return f" by {_percent(change.size)}"
    return f" by {_with_interval(change.size, change.size_ci95)}"


def _with_interval(value: float, interval: Interval) -> str:
    return f"{_percent(value)} (95 % interval {_percent(interval[0])} to {_percent(interval[1])})"


def _percent(share: float) -> str:
    return f"{100.0 * share:.2f} %"


def _chance(probability: float) -> str:
    """Return a probability in words. No model is so exact that it could be certain."""
    return (
        f"more than {MOST_CERTAIN:.0f} %"
        if 100.0 * probability > MOST_CERTAIN
        else f"{100.0 * probability:.0f} %"
    )


def _seconds(time_ns: int) -> str:
    return f"{rfc3339(time_ns)[:SECONDS_END]}Z"

"""What the likeliest arrangement of relay, feeder and motor means for the verdict of a record, in words."""

from collections.abc import Callable
from typing import Final

from core.diagnosis.arrangements import LIKELY, Arranged, Arrangement
from core.diagnosis.estimates import Interval
from core.diagnosis.verdict import Verdict
from core.normal_distribution import NORMAL_95
from core.quality.finding import QualityFinding, finding

REFUSED: Final = {
    Arrangement.INSIDE_DELTA: (
        "the currents are those of the windings: the current transformers are inside the delta. Write "
        '`ct_position = "inside-delta"` into the motor file'
    ),
    Arrangement.IN_STAR: (
        "the motor runs in star, with a third of the currents that it would draw in delta: a star-delta "
        "starter that stays in star, or the connection of the motor file is wrong"
    ),
}
TWO_MOTORS: Final = (
    "twice the current of this motor: two motors behind the relay? Else a wrong ratio of the current "
    "transformers, or another nameplate"
)


RIVALS: Final = {
    Arrangement.CAPACITORS: "capacitors are measured with the motor that the motor file has not",
    Arrangement.TWO_MOTORS: "two motors are behind the relay",
    Arrangement.INSIDE_DELTA: "the current transformers are inside the delta",
    Arrangement.IN_STAR: "the motor runs in star",
}


def connected(arranged: Arranged) -> QualityFinding:
    """Check that the channels are connected as the motor's file says."""
    message = REFUSED.get(arranged.arrangement, "") + _rivals(arranged)
    refused = arranged.arrangement in REFUSED
    return finding(
        "connection", arranged.probability if refused else 0.0, 0.5, "probability of another",
        passed=not refused, message=message,
    )  # fmt: skip


def with_arrangement(
    verdict: Verdict, reasons: list[str], arranged: Arranged, advice: Callable[[], str]
) -> tuple[Verdict, list[str]]:
    """Return verdict and reasons, with what lies behind the relay besides what its file tells.

    A wrong ratio of the currents may look the same: `advice` names one that fits, or is empty.
    """
    likely = [one for one in arranged.rivals if one.probability >= LIKELY]
    if verdict is Verdict.FAULT and not all(one.calls_turns for one in likely):
        verdict = Verdict.WATCH
    words = _words(arranged)
    if not words and (not likely or verdict is Verdict.HEALTHY):
        return verdict, reasons
    if arranged.arrangement is Arrangement.TWO_MOTORS or verdict is Verdict.HEALTHY:
        verdict = Verdict.WATCH
    ratio = advice() if words else ""
    words += _rivals(arranged) if words else f"or{_rivals(arranged).removeprefix('; else')}"
    words += f"; or {ratio}" if ratio else ""
    return verdict, [*reasons[:1], words, *reasons[1:]]


def level_ci95(interval: Interval, arranged: Arranged) -> Interval:
    """Return the interval of a level that holds it under every arrangement that is possible."""
    found = [interval]
    for one in arranged.rivals:
        if one.calls_turns:
            turns = one.evidence.turns
            found.append((turns.level_quantile(0.025), turns.level_quantile(0.975)))
    return min(low for low, _ in found), max(high for _, high in found)


def _words(arranged: Arranged) -> str:
    if arranged.arrangement is Arrangement.CAPACITORS:
        reach = NORMAL_95 * arranged.kvar_deviation
        return (
            f"capacitors of {arranged.kvar:.2g} kvar (+-{reach:.1g}) are measured with the motor "
            f"({arranged.probability:.0%}), and the motor file has none: write [capacitors] into it"
        )
    if arranged.arrangement is Arrangement.TWO_MOTORS:
        return f"{TWO_MOTORS} ({arranged.probability:.0%})"
    return ""


def _rivals(arranged: Arranged) -> str:
    """Say which other arrangements are possible."""
    told = [
        f"{RIVALS[one.arrangement]} ({one.probability:.0%})"
        for one in arranged.rivals
        if one.probability >= LIKELY and one.arrangement in RIVALS
    ]
    return f"; else {' or '.join(told)}" if told else ""

"""What a motor's running costs over its latest records: a load that is too small, and losses that could go.

It says nothing of the motor's health: an oversized motor runs for decades. So it has an alarm of its own, and
leaves the motor's state alone.
"""

from collections.abc import Sequence
from typing import Final

from core.condition.kinds import State
from core.losses.figures import LossFigures
from core.motor_condition.parts import Part, PartCondition
from core.motor_condition.supply import AGREEING, LATEST_RECORDS

LOW_LOAD: Final = 0.4
"""Of the rated torque: efficiency and power factor fall steeply below it."""
FEWEST_LOADS: Final = 12
"""Records that tell how a motor is loaded most of the time."""
MOST_OF: Final = 0.75
"""Share of those records: more than half of the hours, whatever chance drew."""
EXTRA_LOSSES: Final = 0.1
"""Of the losses that the motor would have at this load, sound and at a good supply."""
ADVICE: Final = (
    "Compare what the losses cost in a year with what it takes to end them: the cause that is named, or a "
    "smaller motor, a star connection or a converter where the load is small."
)


def efficiency_part(latest: Sequence[LossFigures], load_levels: Sequence[float]) -> PartCondition:
    """Return what is said of a motor's efficiency.

    Parameters
    ----------
    latest : sequence of LossFigures
        Losses of its latest records, the latest last; the last LATEST_RECORDS count.
    load_levels : sequence of float
        Loads of its latest records, over the rated torque.

    Returns
    -------
    PartCondition
        The part: on watch where running costs more than it should.
    """
    told = [one for one in latest[-LATEST_RECORDS:] if one.efficiency is not None]
    findings, reasons = [], []
    low = sum(level < LOW_LOAD for level in load_levels)
    if len(load_levels) >= FEWEST_LOADS and low >= MOST_OF * len(load_levels):
        findings.append("small load most of the time")
        reasons.append(
            f"{low} of the latest {len(load_levels)} records have less than {LOW_LOAD:.0%} of the rated load"
        )
    shares = [_extra_share(one) for one in told]
    if sum(share > EXTRA_LOSSES for share in shares) >= AGREEING:
        findings.append("more losses than it should have")
        reasons.append(_extra_words(told[-1]))
    if told:
        reasons.append(f"efficiency {told[-1].efficiency:.1%}, losses {told[-1].losses_W:.4g} W")
    if findings:
        return PartCondition(
            Part.EFFICIENCY, State.WATCH, " and ".join(findings), None, ADVICE, tuple(reasons)
        )
    if not told:
        return PartCondition(Part.EFFICIENCY, State.UNKNOWN, "not assessed")
    return PartCondition(Part.EFFICIENCY, State.HEALTHY, "as it should be", reasons=tuple(reasons))


def _extra_share(figures: LossFigures) -> float:
    """Return the losses by the supply over those that the motor would have without any cause."""
    extra_W = sum(watts for cause, watts in figures.extra_W.items() if cause.is_of_supply)
    sound_W = (figures.losses_W or 0.0) - sum(figures.extra_W.values())
    return extra_W / max(sound_W, 1.0)


def _extra_words(figures: LossFigures) -> str:
    named = (
        f"{cause} {watts:.3g} W"
        for cause, watts in figures.extra_W.items()
        if cause.is_of_supply and watts >= 1.0
    )
    return f"{_extra_share(figures):.0%} more losses than at a good supply: {', '.join(named)}"

"""The air gap and the load of a motor on its page: as the latest record shows them, and over time."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from service.client.rotor_and_supply import gap_words, swing_words
from service.storage import Repository
from service.storage.records import SwingEntry
from service.web.charts import Chart, Kind, Series, Tone
from service.web.charts.chart import AxisKind
from service.web.motor.time_range import TimeRange, in_seconds
from service.web.motor.trend import SYNC, TAB_HEIGHT

MOST_RECORDS: Final = 400
"""The latest records that the chart shows."""
PERCENT: Final = 100.0
DIGITS: Final = 3


@dataclass(frozen=True, slots=True)
class SwingSection:
    """What the page says of air gap and load. words: what stands out. chart: None where no record tells.

    is_assessed: whether the latest record tells of either.
    """

    latest: SwingEntry | None
    words: Sequence[str]
    reasons: Sequence[str]
    chart: Chart | None
    is_assessed: bool = False


def swing_section(repository: Repository, motor: str, shown: TimeRange) -> SwingSection:
    """Read what the page says of a motor's air gap and of a load that swings."""
    entries = repository.latest_swings(motor, limit=MOST_RECORDS)
    if not entries:
        return SwingSection(None, (), (), None)
    latest = entries[-1]
    gap = gap_words(latest.eccentricity)
    words = ([] if gap is None else [f"air gap: {gap}"]) + [
        f"load: {one}" for one in swing_words(latest.eccentricity, latest.pulsation)
    ]
    reasons = (*latest.eccentricity.reasons, *latest.pulsation.reasons)
    figures = (latest.eccentricity.permeance_ripple, latest.pulsation.load_torque)
    is_assessed = any(one is not None for one in figures)
    return SwingSection(latest, words, reasons, _chart(motor, entries, shown), is_assessed)


def _chart(motor: str, every: Sequence[SwingEntry], shown: TimeRange) -> Chart | None:
    entries = [one for one in every if shown.has(one.time_ns)]
    lines = (
        (
            "air-gap eccentricity",
            "air gap",
            [one.eccentricity.permeance_ripple for one in entries],
            Tone.ACCENT,
        ),
        (
            "ripple that would be told",
            "limit",
            [one.eccentricity.detection_limit for one in entries],
            Tone.MUTED,
        ),
        ("torque once a turn", "once a turn", [one.eccentricity.load_torque for one in entries], Tone.INK),
        (
            "largest torque oscillation",
            "largest swing",
            [one.pulsation.load_torque for one in entries],
            Tone.MODEL,
        ),
    )
    told = [line for line in lines if any(value is not None for value in line[2])]
    if not told:
        return None
    return Chart(
        key="swings",
        caption=f"Air gap and load of {motor}",
        x_label="time",
        y_label="share",
        y_unit="%",
        x_kind=AxisKind.TIME,
        x=[in_seconds(one.time_ns) for one in entries],
        series=[
            Series(label, [_percent(value) for value in values], "%", tone, Kind.LINE, short=short)
            for label, short, values, tone in told
        ],
        x_from=shown.x_from,
        x_to=shown.x_to,
        sync=SYNC,
        height=TAB_HEIGHT,
        summary=f"{len(entries)} record{'s' if len(entries) > 1 else ''}.",
    )


def _percent(share: float | None) -> float | None:
    return None if share is None else round(PERCENT * share, DIGITS)

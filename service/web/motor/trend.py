"""The fault level of a motor over time as a chart: levels, intervals, limits, and what happened meanwhile."""

from collections.abc import Sequence
from typing import Final

from core.condition.kinds import State
from core.units import NANOSECONDS_PER_SECOND
from service.pictures.trend import TrendMark
from service.storage.records.history import ThinnedTrend
from service.web.charts import AxisKind, Chart, Kind, Limit, Mark, Series, Tone
from service.web.motor.time_range import TimeRange, in_seconds
from service.web.words import duration, percent

KEY: Final = "trend"
SYNC: Final = "motor"
"""Charts of a motor's page have one cursor, and are looked at closer together."""
HEIGHT: Final = 130
"""Of the charts below that of the fault level [CSS px]."""
TAB_HEIGHT: Final = 190
"""Of a chart with the width of a tab, and of that of the fault level [CSS px]."""
LEAST_TOP_PERCENT: Final = 1.0
"""The axis goes to 1 % at least, so that noise does not look like a fault."""
FAR: Final = 2.5
"""A line of a level so many times above all others would press them flat."""
PERCENT: Final = 100.0
DIGITS: Final = 4


def trend_chart(
    motor: str,
    trend: ThinnedTrend,
    *,
    limit: float | None = None,
    ahead: float | None = None,
    detectable: float | None = None,
    marks: Sequence[TrendMark] = (),
    shown: TimeRange | None = None,
) -> Chart:
    """Return the chart. limit: level of a fault; ahead: level that the forecast is about.

    detectable: detection limit of a change.  marks: in the order of time.  shown: the time that
    the axis shows, whether there are records or not.  Levels far above all others are told, and not drawn.
    """
    series = _series(trend)
    top = max(LEAST_TOP_PERCENT, PERCENT * (limit or 0.0), _highest(series))
    lines, above = [], []
    if limit is not None:
        lines.append(Limit(PERCENT * limit, f"motor's limit {percent(limit)}"))
    others = []
    if ahead is not None and ahead != limit:
        others.append(Limit(PERCENT * ahead, f"next level {percent(ahead)}", Tone.WATCH))
    if detectable is not None:
        others.append(Limit(PERCENT * detectable, f"detection limit {percent(detectable)}", Tone.MUTED))
    for one in others:
        if one.y <= FAR * top:
            lines.append(one)
        else:
            above.append(f" Above what is drawn: {one.label}.")
    return Chart(
        key=KEY,
        caption=f"Fault level of {motor}",
        x_label="time",
        y_label="fault level, share of the turns",
        y_unit="%",
        x_kind=AxisKind.TIME,
        x=_times(trend),
        series=series,
        summary=told(trend) + "".join(above),
        x_from=None if shown is None else shown.x_from,
        x_to=None if shown is None else shown.x_to,
        y_from=0.0,
        y_to=LEAST_TOP_PERCENT,
        marks=[Mark(in_seconds(one.time_ns), one.words) for one in marks],
        limits=lines,
        sync=SYNC,
        height=TAB_HEIGHT,
    )


def told(trend: ThinnedTrend) -> str:
    """Return what the chart shows, in words."""
    if not trend.records:
        return "No record."
    if trend.points:
        return f"{trend.records} record{'s' if trend.records > 1 else ''}, each with its 95 % interval."
    width = duration((trend.pieces[0].to_ns - trend.pieces[0].from_ns) / NANOSECONDS_PER_SECOND)
    return (
        f"{trend.records} records. A point is the highest level of about {width}. Its band reaches down to"
        " the lowest, the fainter one over all 95 % intervals: no outlier is left out."
    )


def _series(trend: ThinnedTrend) -> list[Series]:
    spread: tuple[list[float | None], list[float | None]] | None = None
    if trend.points:
        levels = [_percent(one.mu_f) for one in trend.points]
        lows = [_percent(one.mu_f_ci95_low) for one in trend.points]
        highs = [_percent(one.mu_f_ci95_high) for one in trend.points]
        states = [one.state for one in trend.points]
    else:
        levels = [_percent(one.highest) for one in trend.pieces]
        lows = [_percent(one.ci95_low) for one in trend.pieces]
        highs = [_percent(one.ci95_high) for one in trend.pieces]
        states = [one.state for one in trend.pieces]
        spread = ([_percent(one.lowest) for one in trend.pieces], levels)
    low, high = spread if spread is not None else (None, None)
    return [
        Series("95 % interval", [None] * len(levels), "%", Tone.MUTED, Kind.LINE, lows, highs),
        Series("level", levels, "%", Tone.INK, Kind.LINE, low, high),
        *(
            Series(state.value, _where(state, states, levels), "%", tone, Kind.POINTS)
            for state, tone in ((State.WATCH, Tone.WATCH), (State.FAULT, Tone.FAULT))
            if state in states
        ),
    ]


def _highest(series: Sequence[Series]) -> float:
    values = [value for one in series for value in (*one.values, *(one.high or ())) if value is not None]
    return max(values, default=0.0)


def _where(state: State, states: Sequence[State], levels: Sequence[float | None]) -> list[float | None]:
    return [level if one is state else None for one, level in zip(states, levels, strict=True)]


def _times(trend: ThinnedTrend) -> list[float]:
    if trend.points:
        return [in_seconds(one.time_ns) for one in trend.points]
    return [in_seconds((one.from_ns + one.to_ns) // 2) for one in trend.pieces]


def _percent(level: float | None) -> float | None:
    return None if level is None else float(f"{PERCENT * level:.{DIGITS}g}")

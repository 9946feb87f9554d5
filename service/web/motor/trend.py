"""The fault level of a motor over time as a chart: levels, intervals, limits, and what happened meanwhile."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from core.condition.kinds import State
from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND
from service.storage.records.history import ThinnedTrend
from service.web.charts import AxisKind, Chart, Kind, Limit, Mark, Series, Tone
from service.web.words import duration, percent

KEY: Final = "trend"
LEAST_TOP_PERCENT: Final = 1.0
"""The axis goes to 1 % at least, so that noise does not look like a fault."""
FAR: Final = 2.5
"""A line of a level so many times above all others would press them flat."""
PERCENT: Final = 100.0
DIGITS: Final = 4


@dataclass(frozen=True, slots=True)
class TrendSpan:
    """A time that can be looked at. days: None for all of it."""

    key: str
    words: str
    days: float | None

    def from_ns(self, now_ns: int) -> int | None:
        """Return where it begins; None for the first record."""
        return None if self.days is None else now_ns - round(self.days * NANOSECONDS_PER_DAY)


SPANS: Final = (
    TrendSpan("7", "7 days", 7.0),
    TrendSpan("30", "30 days", 30.0),
    TrendSpan("90", "90 days", 90.0),
    TrendSpan("365", "1 year", 365.0),
    TrendSpan("all", "all", None),
)
USUAL: Final = "90"


@dataclass(frozen=True, slots=True)
class TrendMark:
    """Something that happened at a time."""

    time_ns: int
    label: str


def trend_chart(
    motor: str,
    trend: ThinnedTrend,
    *,
    limit: float | None = None,
    ahead: float | None = None,
    detectable: float | None = None,
    marks: Sequence[TrendMark] = (),
    from_ns: int | None = None,
    to_ns: int | None = None,
) -> Chart:
    """Return the chart. limit: level of a fault; ahead: level that the forecast is about.

    detectable: detection limit of a change.  marks: in the order of time.  from_ns, to_ns: the time that
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
        x_from=None if from_ns is None else _seconds(from_ns),
        x_to=None if to_ns is None else _seconds(to_ns),
        y_from=0.0,
        y_to=LEAST_TOP_PERCENT,
        marks=[Mark(_seconds(one.time_ns), one.label) for one in marks],
        limits=lines,
        height=300,
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
        return [_seconds(one.time_ns) for one in trend.points]
    return [_seconds((one.from_ns + one.to_ns) // 2) for one in trend.pieces]


def _seconds(time_ns: int) -> float:
    return round(time_ns / NANOSECONDS_PER_SECOND, 3)


def _percent(level: float | None) -> float | None:
    return None if level is None else float(f"{PERCENT * level:.{DIGITS}g}")

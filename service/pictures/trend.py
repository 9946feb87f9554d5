"""The fault level of a motor over time, with its interval and the motor's limit."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, tzinfo
from math import isfinite

from core.units import NANOSECONDS_PER_SECOND
from service.pictures.svg import Drawing
from service.pictures.ticks import figure_ticks, time_ticks

WIDTH, HEIGHT = 640.0, 260.0
LEFT, RIGHT, TOP, BOTTOM = 52.0, 14.0, 34.0, 26.0

LEAST_TOP = 0.01
"""The axis goes to 1 % at least, so that noise does not look like a fault."""

MOST_POINTS = 600
"""More than that are less than a pixel apart."""

LONGEST_TITLE = 40

INK, GREY, GRID, BAND = "#1f2933", "#7b8794", "#e4e7eb", "#eef1f4"
COLOURS = {"watch": "#b7791f", "fault": "#c53030"}
"""What is normal is grey."""


@dataclass(frozen=True, slots=True)
class TrendPoint:
    """A figure at a time [ns], with its 95 % interval, and the motor's state from then on."""

    time_ns: int
    value: float
    low: float | None = None
    high: float | None = None
    state: str = "healthy"


def trend_picture(
    title: str, points: Sequence[TrendPoint], *, limit: float | None = None, zone: tzinfo = UTC
) -> str:
    """Return the picture as SVG.

    points: oldest first, shares of the phase turns. limit: the level from which on the motor has a fault.
    """
    drawing = Drawing(WIDTH, HEIGHT, title=f"{title}: fault level over time")
    drawing.rectangle(0, 0, WIDTH, HEIGHT, fill="#ffffff")
    drawing.text(LEFT, 20, title[:LONGEST_TITLE], fill=INK, font_weight="bold")
    known = thinned([point for point in points if isfinite(point.value)])
    if not known:
        drawing.text(WIDTH / 2, HEIGHT / 2, "no record yet", anchor="middle", fill=GREY)
        return drawing.svg()
    frame = _frame(known, limit)
    _interval(drawing, frame, known)
    _axes(drawing, frame, zone)
    _limit(drawing, frame, limit)
    _curve(drawing, frame, known)
    _latest(drawing, known[-1], zone)
    return drawing.svg()


@dataclass(frozen=True, slots=True)
class _Frame:
    """Where times and levels are in the picture."""

    first_ns: int
    last_ns: int
    top: float

    def x(self, time_ns: int) -> float:
        return LEFT + (WIDTH - LEFT - RIGHT) * (time_ns - self.first_ns) / (self.last_ns - self.first_ns)

    def y(self, level: float) -> float:
        share = min(max(level, 0.0), self.top) / self.top
        return HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * share


def _frame(points: Sequence[TrendPoint], limit: float | None) -> _Frame:
    largest = max(point.value for point in points)
    highest = max((point.high for point in points if point.high is not None), default=0.0)
    top = 1.08 * max(largest, min(highest, 2.0 * largest), 1.1 * (limit or 0.0), LEAST_TOP)
    first_ns, last_ns = points[0].time_ns, points[-1].time_ns
    return _Frame(first_ns, max(last_ns, first_ns + 60_000_000_000), top)


def _axes(drawing: Drawing, frame: _Frame, zone: tzinfo) -> None:
    for level in figure_ticks(0.0, frame.top, 5):
        y = frame.y(level)
        drawing.line(LEFT, y, WIDTH - RIGHT, y, stroke=GRID)
        drawing.text(LEFT - 6, y + 4, f"{100 * level:.4g} %", anchor="end", fill=GREY)
    for time_ns, words in time_ticks(frame.first_ns, frame.last_ns, 7, zone):
        x = frame.x(time_ns)
        drawing.line(x, HEIGHT - BOTTOM, x, HEIGHT - BOTTOM + 4, stroke=GREY)
        if LEFT + 10 <= x <= WIDTH - RIGHT - 14:
            drawing.text(x, HEIGHT - BOTTOM + 16, words, anchor="middle", fill=GREY)


def _limit(drawing: Drawing, frame: _Frame, limit: float | None) -> None:
    if limit is None:
        return
    y = frame.y(limit)
    drawing.line(LEFT, y, WIDTH - RIGHT, y, stroke=COLOURS["fault"], stroke_dasharray="5 4")
    drawing.text(LEFT + 4, y - 4, f"limit {100 * limit:.3g} %", fill=COLOURS["fault"], font_size="11")


def _interval(drawing: Drawing, frame: _Frame, points: Sequence[TrendPoint]) -> None:
    sure = [point for point in points if point.low is not None and point.high is not None]
    upper = [(frame.x(point.time_ns), frame.y(point.high or 0.0)) for point in sure]
    lower = [(frame.x(point.time_ns), frame.y(point.low or 0.0)) for point in sure]
    drawing.path([*upper, *reversed(lower)], closed=True, fill=BAND, stroke="none")


def _curve(drawing: Drawing, frame: _Frame, points: Sequence[TrendPoint]) -> None:
    places = [(frame.x(point.time_ns), frame.y(point.value)) for point in points]
    drawing.path(places, stroke=GREY, stroke_width="1.5", stroke_linejoin="round")
    for state, colour in COLOURS.items():
        told = [place for place, point in zip(places, points, strict=True) if point.state == state]
        drawing.circles(told, 2.5, fill=colour)
    drawing.circles(places[-1:], 4.0, fill=COLOURS.get(points[-1].state, INK))


def _latest(drawing: Drawing, point: TrendPoint, zone: tzinfo) -> None:
    at = datetime.fromtimestamp(point.time_ns // NANOSECONDS_PER_SECOND, zone)
    words = f"{100 * point.value:.2f} % at {at:%Y-%m-%d %H:%M} {at.tzname()}"
    drawing.text(WIDTH - RIGHT, 20, words, anchor="end", fill=INK)


def thinned(points: Sequence[TrendPoint], most: int = MOST_POINTS) -> Sequence[TrendPoint]:
    """Return at most so many points: of each piece of time the smallest and the largest, so that none hides.

    The latest one is always among them.
    """
    if len(points) <= most:
        return points
    first_ns = points[0].time_ns
    width_ns = max((points[-1].time_ns - first_ns) // (most // 2 - 1) + 1, 1)
    pieces: dict[int, list[TrendPoint]] = {}
    for point in points:
        pieces.setdefault((point.time_ns - first_ns) // width_ns, []).append(point)
    kept: list[TrendPoint] = []
    for piece in pieces.values():
        ends = {min(piece, key=_value), max(piece, key=_value)}
        kept += sorted(ends, key=lambda point: point.time_ns)
    return kept if kept[-1] is points[-1] else [*kept[: most - 1], points[-1]]


def _value(point: TrendPoint) -> float:
    return point.value

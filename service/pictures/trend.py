"""The fault level of a motor over time, with its interval and the motor's limit."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite
from zoneinfo import ZoneInfo

from core.time_words import clock
from service.pictures.looks import PRINT, Look
from service.pictures.marks import mark_states
from service.pictures.svg import Drawing
from service.pictures.ticks import figure_ticks, time_ticks

WIDTH, HEIGHT = 640.0, 260.0
LEFT, RIGHT, TOP, BOTTOM = 52.0, 14.0, 34.0, 26.0

FAR = 2.5
"""A line of a level so many times above all others would press them flat."""

LEAST_TOP = 0.01
"""The axis goes to 1 % at least, so that noise does not look like a fault."""

MOST_POINTS = 600
"""More than that are less than a pixel apart."""

LONGEST_TITLE = 40

MOST_MARKS = 40
"""Events beyond these are not readable; the latest are shown."""

LETTER = 6.0
"""Width of a letter of a mark's words, of about ten pixels."""

CALLS = ("watch", "fault")


@dataclass(frozen=True, slots=True)
class TrendPoint:
    """A figure at a time [ns], with its 95 % interval, and the motor's state from then on."""

    time_ns: int
    value: float
    low: float | None = None
    high: float | None = None
    state: str = "healthy"


@dataclass(frozen=True, slots=True)
class TrendMark:
    """Something that happened at a time [ns], in a word or two."""

    time_ns: int
    words: str


def trend_picture(
    title: str,
    points: Sequence[TrendPoint],
    *,
    limit: float | None = None,
    ahead: float | None = None,
    detectable: float | None = None,
    until_ns: int | None = None,
    marks: Sequence[TrendMark] = (),
    zone: str = "UTC",
    look: Look = PRINT,
) -> str:
    """Return the picture as SVG.

    points: oldest first, shares of the phase turns. limit: the level from which on the motor has a fault.
    ahead: the level that the forecast is about.  detectable: the least step that would be seen; either is
    drawn unless it is far above all else.  until_ns: where the time shown ends.  marks: what happened
    meanwhile, numbered from the left, with its words where they have room.
    """
    known = thinned([point for point in points if isfinite(point.value)])
    drawing = Drawing(
        WIDTH, HEIGHT, title=f"{title}: fault level over time", description=_told(known, limit, zone)
    )
    drawing.rectangle(0, 0, WIDTH, HEIGHT, fill=look.surface)
    drawing.text(LEFT, 20, title[:LONGEST_TITLE], fill=look.ink, font_weight="bold")
    if not known:
        drawing.text(WIDTH / 2, HEIGHT / 2, "no record yet", anchor="middle", fill=look.muted)
        return drawing.svg()
    frame = _frame(known, limit, [level for level in (ahead, detectable) if level is not None], until_ns)
    _interval(drawing, frame, known, look)
    _axes(drawing, frame, zone, look)
    _level(drawing, frame, limit, "motor's limit", look.fault, "5 4")
    _level(drawing, frame, None if ahead == limit else ahead, "next level", look.watch, "5 4")
    _level(drawing, frame, detectable, "detection limit", look.muted, "2 3")
    _marks(drawing, frame, marks, look)
    _curve(drawing, frame, known, look)
    _latest(drawing, known[-1], zone, look)
    return drawing.svg()


def _told(points: Sequence[TrendPoint], limit: float | None, zone: str) -> str:
    if not points:
        return "No record yet"
    latest = points[-1]
    told = f"Last {100 * latest.value:.2f} % on {clock(latest.time_ns, zone)}, {latest.state}"
    told += f"; highest {100 * max(point.value for point in points):.2f} %"
    return told if limit is None else f"{told}; limit {100 * limit:.3g} %"


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


def _frame(
    points: Sequence[TrendPoint], limit: float | None, others: Sequence[float], until_ns: int | None
) -> _Frame:
    largest = max(point.value for point in points)
    highest = max((point.high for point in points if point.high is not None), default=0.0)
    top = max(largest, min(highest, 2.0 * largest), 1.1 * (limit or 0.0), LEAST_TOP)
    top = 1.08 * max(top, *(level for level in others if level <= FAR * top), top)
    first_ns, last_ns = points[0].time_ns, max(points[-1].time_ns, until_ns or 0)
    return _Frame(first_ns, max(last_ns, first_ns + 60_000_000_000), top)


def _axes(drawing: Drawing, frame: _Frame, zone: str, look: Look) -> None:
    for level in figure_ticks(0.0, frame.top, 5):
        y = frame.y(level)
        drawing.line(LEFT, y, WIDTH - RIGHT, y, stroke=look.line)
        drawing.text(LEFT - 6, y + 4, f"{100 * level:.4g} %", anchor="end", fill=look.muted)
    for time_ns, words in time_ticks(frame.first_ns, frame.last_ns, 7, ZoneInfo(zone)):
        x = frame.x(time_ns)
        drawing.line(x, HEIGHT - BOTTOM, x, HEIGHT - BOTTOM + 4, stroke=look.muted)
        if LEFT + 10 <= x <= WIDTH - RIGHT - 14:
            drawing.text(x, HEIGHT - BOTTOM + 16, words, anchor="middle", fill=look.muted)


def _level(
    drawing: Drawing, frame: _Frame, level: float | None, words: str, colour: str, dashes: str
) -> None:
    if level is None or level > frame.top:
        return
    y = frame.y(level)
    drawing.line(LEFT, y, WIDTH - RIGHT, y, stroke=colour, stroke_dasharray=dashes)
    drawing.text(LEFT + 4, y - 4, f"{words} {100 * level:.3g} %", fill=colour, font_size="11")


def _marks(drawing: Drawing, frame: _Frame, marks: Sequence[TrendMark], look: Look) -> None:
    shown = [mark for mark in marks if frame.first_ns <= mark.time_ns <= frame.last_ns][-MOST_MARKS:]
    places = [frame.x(mark.time_ns) for mark in shown] + [WIDTH - RIGHT]
    for number, (mark, x, after) in enumerate(zip(shown, places, places[1:], strict=False), start=1):
        drawing.line(x, TOP, x, HEIGHT - BOTTOM, stroke=look.accent, stroke_dasharray="1 3")
        words = f"{number} {mark.words}"
        has_room = x + LETTER * len(words) < after
        drawing.text(x, TOP - 2, words if has_room else str(number), fill=look.accent, font_size="10")


def _interval(drawing: Drawing, frame: _Frame, points: Sequence[TrendPoint], look: Look) -> None:
    sure = [point for point in points if point.low is not None and point.high is not None]
    upper = [(frame.x(point.time_ns), frame.y(point.high or 0.0)) for point in sure]
    lower = [(frame.x(point.time_ns), frame.y(point.low or 0.0)) for point in sure]
    drawing.path([*upper, *reversed(lower)], closed=True, fill=look.band, stroke="none")


def _curve(drawing: Drawing, frame: _Frame, points: Sequence[TrendPoint], look: Look) -> None:
    places = [(frame.x(point.time_ns), frame.y(point.value)) for point in points]
    drawing.path(places, stroke=look.muted, stroke_width="1.5", stroke_linejoin="round")
    marked = [(place, point.state) for place, point in zip(places, points, strict=True)]
    mark_states(drawing, look, [one for one in marked if one[1] in CALLS], 2.5)
    mark_states(drawing, look, marked[-1:], 4.0)


def _latest(drawing: Drawing, point: TrendPoint, zone: str, look: Look) -> None:
    words = f"{100 * point.value:.2f} % at {clock(point.time_ns, zone)}"
    drawing.text(WIDTH - RIGHT, 20, words, anchor="end", fill=look.ink)


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

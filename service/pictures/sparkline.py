"""The fault level of a motor over some days in the height of a line of text, with its reference band."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite

from core.units import NANOSECONDS_PER_DAY
from service.pictures.looks import PRINT, Look
from service.pictures.marks import mark_states
from service.pictures.svg import Drawing

WIDTH, HEIGHT = 120, 28
MARGIN = 4
"""Room for the mark of the latest record at the right end."""

LEAST_TOP = 0.01
"""The height is 1 % at least, so that noise does not look like a fault."""


@dataclass(frozen=True, slots=True)
class SparkPoint:
    """A fault level at a time [ns], a fraction of the phase turns, and the motor's state then."""

    time_ns: int
    level: float
    state: str = "healthy"


def sparkline(
    motor: str,
    points: Sequence[SparkPoint],
    *,
    from_ns: int,
    to_ns: int,
    reference: tuple[float, float] | None = None,
    limit: float | None = None,
    look: Look = PRINT,
) -> str:
    """Return the picture as SVG.

    points: oldest first; days without any are gaps.  reference: levels between which the motor was while it
    was learnt, or between which a change cannot be told from none.  limit: level from which on it is a fault.
    """
    known = [one for one in points if isfinite(one.level) and from_ns <= one.time_ns <= to_ns]
    days = max(round((to_ns - from_ns) / NANOSECONDS_PER_DAY), 1)
    drawing = Drawing(WIDTH, HEIGHT, title=f"{motor}: fault level over {days} days", description=_told(known))
    if not known:
        drawing.line(0, HEIGHT - MARGIN, WIDTH, HEIGHT - MARGIN, stroke=look.line, stroke_dasharray="2 3")
        return drawing.svg()
    highest = reference[1] if reference is not None else 0.0
    top = max(*(one.level for one in known), 1.1 * (limit or 0.0), highest, LEAST_TOP)

    def x(time_ns: int) -> int:
        return round((WIDTH - 2 * MARGIN) * (time_ns - from_ns) / max(to_ns - from_ns, 1)) + MARGIN

    def y(level: float) -> int:
        return HEIGHT - MARGIN - round((HEIGHT - 2 * MARGIN) * min(max(level, 0.0), top) / top)

    if reference is not None:
        low, high = y(reference[0]), y(reference[1])
        drawing.rectangle(0, high, WIDTH, max(low - high, 1), fill=look.band)
    if limit is not None:
        drawing.line(0, y(limit), WIDTH, y(limit), stroke=look.muted, stroke_dasharray="2 2")
    drawing.steps(
        [[(x(one.time_ns), y(one.level)) for one in piece] for piece in _pieces(known)], stroke=look.muted
    )
    latest = known[-1]
    mark_states(drawing, look, [((x(latest.time_ns), y(latest.level)), latest.state)])
    return drawing.svg()


def _pieces(points: Sequence[SparkPoint]) -> list[list[SparkPoint]]:
    """Return the points without a gap of more than two days between them."""
    pieces: list[list[SparkPoint]] = []
    for point in points:
        if pieces and point.time_ns - pieces[-1][-1].time_ns <= 2 * NANOSECONDS_PER_DAY:
            pieces[-1].append(point)
        else:
            pieces.append([point])
    return pieces


def _told(points: Sequence[SparkPoint]) -> str:
    if not points:
        return "No record in this time"
    levels = [one.level for one in points]
    return (
        f"Between {100 * min(levels):.2f} % and {100 * max(levels):.2f} %,"
        f" last {100 * levels[-1]:.2f} %, {points[-1].state}"
    )

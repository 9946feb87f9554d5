"""The fault level against the load: a fault shows at any load, an error of a sensor or a parameter seldom."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite

from service.pictures.axes import LEFT, RIGHT, Axes, Axis, percent
from service.pictures.looks import PRINT, Look
from service.pictures.marks import mark_states
from service.pictures.svg import Drawing

WIDTH, HEIGHT = 360.0, 280.0
LEAST_LEVEL, LEAST_LOAD = 0.01, 1.0
MOST_POINTS = 600


@dataclass(frozen=True, slots=True)
class LoadPoint:
    """A record's fault level, its 95 % interval, and the load torque over the rated one."""

    load: float
    level: float
    low: float | None = None
    high: float | None = None
    state: str = "healthy"


def load_picture(
    title: str, points: Sequence[LoadPoint], *, limit: float | None = None, look: Look = PRINT
) -> str:
    """Return the picture as SVG. points: oldest first; the latest is marked.  limit: a fault from it on."""
    known = [one for one in points if isfinite(one.level) and isfinite(one.load)][-MOST_POINTS:]
    drawing = Drawing(
        WIDTH, HEIGHT, title=f"{title}: fault level against load", description=_told(known, limit)
    )
    drawing.rectangle(0, 0, WIDTH, HEIGHT, fill=look.surface)
    level = max([one.level for one in known], default=0.0)
    axes = Axes(
        WIDTH,
        HEIGHT,
        Axis(
            "load (torque over rated)",
            0.0,
            1.05 * max(*(one.load for one in known), LEAST_LOAD, 0.0),
            percent,
        ),
        Axis("fault level", 0.0, 1.1 * max(level, limit or 0.0, LEAST_LEVEL), percent, most=5),
    )
    axes.draw(drawing, look)
    for one in known:
        if one.low is not None and one.high is not None:
            x = axes.x(one.load)
            drawing.line(x, axes.y(one.low), x, axes.y(one.high), stroke=look.line)
    if limit is not None:
        y = axes.y(limit)
        drawing.line(LEFT, y, WIDTH - RIGHT, y, stroke=look.fault, stroke_dasharray="5 4")
        drawing.text(
            WIDTH - RIGHT, y - 4, f"motor's limit {100 * limit:.3g} %", anchor="end", fill=look.fault
        )
    marked = [((axes.x(one.load), axes.y(one.level)), one.state) for one in known]
    mark_states(drawing, look, marked[:-1], 2.0)
    mark_states(drawing, look, marked[-1:], 4.0)
    if not known:
        drawing.text(WIDTH / 2, HEIGHT / 2, "no record yet", anchor="middle", fill=look.muted)
    return drawing.svg()


def _told(points: Sequence[LoadPoint], limit: float | None) -> str:
    if not points:
        return "No record yet"
    loads = [one.load for one in points]
    told = f"{len(points)} records between {100 * min(loads):.0f} % and {100 * max(loads):.0f} % load"
    if limit is not None:
        told += f"; {sum(one.level > limit for one in points)} above the limit of {100 * limit:.3g} %"
    return told

"""How loaded a motor is, and for how long: shares of the time at each load."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite

from service.pictures.axes import BOTTOM, Axes, Axis, percent
from service.pictures.looks import PRINT, Look
from service.pictures.svg import Drawing

WIDTH, HEIGHT = 360.0, 240.0
STEP = 0.1
"""Width of a bar: a tenth of the rated load."""

MOST_LOAD = 2.0
"""What is above is counted with the last bar."""


@dataclass(frozen=True, slots=True)
class LoadShare:
    """A weight at a load: hours, or one for each record. load: over the rated one."""

    load: float
    weight: float = 1.0


def load_profile_picture(
    title: str, shares: Sequence[LoadShare], *, of_what: str = "of the records", look: Look = PRINT
) -> str:
    """Return the picture as SVG. of_what: what the bars are shares of."""
    bars = load_bars(shares)
    drawing = Drawing(WIDTH, HEIGHT, title=f"{title}: load profile", description=_told(bars, of_what))
    drawing.rectangle(0, 0, WIDTH, HEIGHT, fill=look.surface)
    axes = Axes(
        WIDTH,
        HEIGHT,
        Axis("load over rated", 0.0, max(len(bars) * STEP, 1.2), percent),
        Axis(f"share {of_what}", 0.0, 1.1 * max([*bars, 0.1]), percent, most=4),
    )
    axes.draw(drawing, look)
    for number, share in enumerate(bars):
        if share > 0.0:
            left, right = axes.x(number * STEP) + 1, axes.x((number + 1) * STEP) - 1
            top = axes.y(share)
            drawing.rectangle(left, top, right - left, HEIGHT - BOTTOM - top, fill=look.muted)
    rated = axes.x(1.0)
    drawing.line(
        rated, axes.y(axes.up.largest), rated, HEIGHT - BOTTOM, stroke=look.ink, stroke_dasharray="5 4"
    )
    drawing.text(rated + 4, axes.y(axes.up.largest) + 12, "rated", fill=look.ink, font_size="11")
    if not bars:
        drawing.text(WIDTH / 2, HEIGHT / 2, "nothing is known yet", anchor="middle", fill=look.muted)
    return drawing.svg()


def load_bars(shares: Sequence[LoadShare]) -> list[float]:
    """Return the share of the whole in each tenth of the rated load, from none on; empty without any."""
    known = [one for one in shares if isfinite(one.load) and one.weight > 0.0]
    whole = sum(one.weight for one in known)
    if not whole:
        return []
    last = round(MOST_LOAD / STEP) - 1
    weights = [0.0] * (last + 1)
    for one in known:
        weights[min(max(int(one.load / STEP + 1e-9), 0), last)] += one.weight
    used = max(number for number, weight in enumerate(weights) if weight) + 1
    return [weight / whole for weight in weights[:used]]


def _told(bars: Sequence[float], of_what: str) -> str:
    if not bars:
        return "Nothing is known yet"
    most = max(range(len(bars)), key=lambda number: bars[number])
    return (
        f"Most, {100 * bars[most]:.0f} % {of_what}, is at {100 * most * STEP:.0f} to"
        f" {100 * (most + 1) * STEP:.0f} % load"
    )

"""Unbalance of the currents against that of the voltages, with the lines that NEMA MG-1 draws.

NEMA MG-1 (12.45, 14.36) asks for less load above 1 % unbalance of the voltages and advises against running
above 5 %. It expects currents that are six to ten times as unbalanced as the voltages. What lies above that
is not the supply's doing. NEMA's unbalance, the largest deviation of a line voltage from their mean, is 0.87
to 1 times |V2| / |V1|.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite

from service.pictures.axes import BOTTOM, RIGHT, TOP, Axes, Axis, percent
from service.pictures.looks import PRINT, Look
from service.pictures.svg import Drawing

WIDTH, HEIGHT = 360.0, 280.0
LESS_LOAD, NOT_ADVISED = 0.01, 0.05
"""Unbalance of the voltages above which the load is to be less, and above which operation is not advised."""

EXPECTED = (6.0, 10.0)
"""Unbalance of the currents over that of the voltages."""

LEAST_ACROSS, LEAST_UP = 0.015, 0.06
MOST_POINTS = 600


@dataclass(frozen=True, slots=True)
class SupplyPoint:
    """|V2| / |V1| and |I2| / |I1| of a record."""

    voltage_unbalance: float
    current_unbalance: float


def supply_picture(title: str, points: Sequence[SupplyPoint], *, look: Look = PRINT) -> str:
    """Return the picture as SVG. points: oldest first; the latest is marked."""
    known = [one for one in points if isfinite(one.voltage_unbalance) and isfinite(one.current_unbalance)]
    drawing = Drawing(
        WIDTH, HEIGHT, title=f"{title}: unbalance of currents against voltages", description=_told(known)
    )
    drawing.rectangle(0, 0, WIDTH, HEIGHT, fill=look.surface)
    across = 1.1 * max([one.voltage_unbalance for one in known], default=0.0)
    up = 1.1 * max([one.current_unbalance for one in known], default=0.0)
    axes = Axes(
        WIDTH,
        HEIGHT,
        Axis("unbalance of the voltages V2/V1", 0.0, max(across, LEAST_ACROSS), percent),
        Axis("unbalance of the currents I2/I1", 0.0, max(up, LEAST_UP), percent, most=5),
    )
    _expected(drawing, axes, look)
    axes.draw(drawing, look)
    for limit, words, colour, row in (
        (LESS_LOAD, "NEMA: less load", look.watch, 12),
        (NOT_ADVISED, "NEMA: not advised", look.fault, 26),
    ):
        if limit < axes.across.largest:
            x = axes.x(limit)
            drawing.line(x, TOP, x, HEIGHT - BOTTOM, stroke=colour, stroke_dasharray="5 4")
            anchor, beside = ("start", 4) if x < WIDTH - 130 else ("end", -4)
            drawing.text(x + beside, TOP + row, words, anchor=anchor, fill=colour, font_size="11")
    shown = known[-MOST_POINTS:]
    places = [(axes.x(one.voltage_unbalance), axes.y(one.current_unbalance)) for one in shown]
    drawing.circles(places[:-1], 2.0, fill=look.muted, fill_opacity="0.6")
    drawing.circles(places[-1:], 4.0, fill=look.ink)
    if not known:
        drawing.text(WIDTH / 2, HEIGHT / 2, "no record yet", anchor="middle", fill=look.muted)
    return drawing.svg()


def _expected(drawing: Drawing, axes: Axes, look: Look) -> None:
    """Draw between which currents NEMA expects those of a sound motor."""
    across, up = axes.across.largest, axes.up.largest
    ends = [(min(across, up / ratio), min(across * ratio, up)) for ratio in EXPECTED]
    corner = [(across, up)] if ends[0][0] >= across and ends[1][1] >= up else []
    area = [(0.0, 0.0), ends[0], *corner, ends[1]]
    drawing.path([(axes.x(x), axes.y(y)) for x, y in area], closed=True, fill=look.band)
    words = "area: 6 to 10 times, expected"
    drawing.text(WIDTH - RIGHT, 14, words, anchor="end", fill=look.muted, font_size="11")


def _told(points: Sequence[SupplyPoint]) -> str:
    if not points:
        return "No record yet"
    latest = points[-1]
    return (
        f"Latest record: voltages {100 * latest.voltage_unbalance:.2f} %,"
        f" currents {100 * latest.current_unbalance:.2f} %"
    )

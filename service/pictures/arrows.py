"""Arrows of phasors and of asymmetries."""

from cmath import exp as cexp
from math import pi
from typing import Final

from service.pictures.svg import Drawing, Place

HEAD: Final = 8.5
"""Length of an arrow's head [px]; a shorter arrow is all head."""

HALF_ANGLE: Final = pi / 8.5
LEAST: Final = 1.0
"""A shorter arrow [px] is a dot."""


def dashes(*, dashed: bool) -> dict[str, str]:
    """Return the look of a line that is dashed, or is not."""
    return {"stroke_dasharray": "5 3"} if dashed else {}


def draw_arrow(drawing: Drawing, begin: Place, end: Place, colour: str, *, dashed: bool = False) -> None:
    """Draw an arrow from one place to another."""
    tip = complex(*end)
    way = tip - complex(*begin)
    if abs(way) < LEAST:
        drawing.circles([end], 3.0, fill=colour)
        return
    look = {"stroke": colour, "stroke_width": "2", **dashes(dashed=dashed)}
    drawing.line(begin[0], begin[1], end[0], end[1], **look)
    back = min(HEAD, abs(way)) * way / abs(way)
    corners = [tip, *(tip - back * cexp(1j * side * HALF_ANGLE) for side in (1, -1))]
    drawing.path([(one.real, one.imag) for one in corners], closed=True, fill=colour)

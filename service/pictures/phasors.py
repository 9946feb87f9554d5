"""Phasors as arrows: voltages and currents in one picture, each scaled to the largest of its own unit."""

from cmath import isfinite
from collections.abc import Sequence
from dataclasses import dataclass
from math import atan2, degrees

from service.pictures.arrows import dashes, draw_arrow
from service.pictures.looks import PRINT, Look
from service.pictures.svg import Drawing

SIZE = 280.0
LEGEND = 150.0
MIDDLE = SIZE / 2
RADIUS = 104.0
MOST = 12
"""More arrows than these are not readable."""

LEAST_SHOWN = 1e-3
"""An arrow below this share of the longest is left out; its figures are in the list."""


@dataclass(frozen=True, slots=True)
class Phasor:
    """A phasor with its name and unit. A positive angle leads: it turns against the clock."""

    name: str
    value: complex
    unit: str


def phasor_picture(title: str, phasors: Sequence[Phasor], *, look: Look = PRINT) -> str:
    """Return the picture as SVG. Phasors of the second unit have dashed arrows, and are drawn shorter."""
    known = [one for one in phasors if isfinite(one.value)][:MOST]
    drawing = Drawing(SIZE + LEGEND, SIZE, title=title, description="; ".join(map(_words, known)))
    drawing.rectangle(0, 0, SIZE + LEGEND, SIZE, fill=look.surface)
    drawing.circles([(MIDDLE, MIDDLE)], RADIUS, fill="none", stroke=look.line)
    drawing.line(MIDDLE - RADIUS, MIDDLE, MIDDLE + RADIUS, MIDDLE, stroke=look.line)
    drawing.line(MIDDLE, MIDDLE - RADIUS, MIDDLE, MIDDLE + RADIUS, stroke=look.line)
    units = list(dict.fromkeys(one.unit for one in known))
    for number, one in enumerate(known):
        at = units.index(one.unit)
        largest = max(abs(other.value) for other in known if other.unit == one.unit)
        colour = look.ink if at == 0 else look.accent
        length = 0.0 if largest == 0.0 else abs(one.value) / largest
        if length >= LEAST_SHOWN:
            reach = RADIUS * (1.0 if at == 0 else 0.72) * length
            _arrow(drawing, one, reach, colour, dashed=at > 0)
        y = 30 + 19 * number
        dash = dashes(dashed=at > 0)
        drawing.line(SIZE - 6, y - 4, SIZE + 14, y - 4, stroke=colour, stroke_width="2", **dash)
        drawing.text(SIZE + 20, y, _words(one), fill=look.ink, font_size="11")
    if not known:
        drawing.text(MIDDLE, MIDDLE, "nothing was measured", anchor="middle", fill=look.muted)
    return drawing.svg()


def _arrow(drawing: Drawing, phasor: Phasor, reach: float, colour: str, *, dashed: bool) -> None:
    direction = phasor.value / abs(phasor.value)
    end = reach * direction
    draw_arrow(drawing, (MIDDLE, MIDDLE), (MIDDLE + end.real, MIDDLE - end.imag), colour, dashed=dashed)
    label = (reach + 14.0) * direction
    drawing.text(
        MIDDLE + label.real,
        MIDDLE - label.imag + 4,
        phasor.name,
        anchor="middle",
        fill=colour,
        font_size="11",
    )


def _words(phasor: Phasor) -> str:
    angle = degrees(atan2(phasor.value.imag, phasor.value.real)) if phasor.value else 0.0
    return f"{phasor.name} {abs(phasor.value):.4g} {phasor.unit} at {angle:z.1f}°"

"""The axes of a picture with two figures: where a pair of them is, the grid, and what is written at it."""

from collections.abc import Callable
from dataclasses import dataclass

from service.pictures.looks import Look
from service.pictures.svg import Drawing
from service.pictures.ticks import figure_ticks

LEFT, RIGHT, TOP, BOTTOM = 52.0, 24.0, 34.0, 42.0


@dataclass(frozen=True, slots=True)
class Axis:
    """An axis from `least` to `largest`. words: how a figure is written at it.  most: so many marks."""

    name: str
    least: float
    largest: float
    words: Callable[[float], str]
    most: int = 6


@dataclass(frozen=True, slots=True)
class Axes:
    """A rectangle in a picture in which figures have places. What lies beyond an end is shown at that end."""

    width: float
    height: float
    across: Axis
    up: Axis

    def x(self, value: float) -> float:
        """Return where a figure of the axis across is."""
        return LEFT + (self.width - LEFT - RIGHT) * _share(value, self.across)

    def y(self, value: float) -> float:
        """Return where a figure of the axis up is."""
        return self.height - BOTTOM - (self.height - TOP - BOTTOM) * _share(value, self.up)

    def draw(self, drawing: Drawing, look: Look) -> None:
        """Draw the grid with its figures and the names of both axes."""
        right, bottom = self.width - RIGHT, self.height - BOTTOM
        for value in figure_ticks(self.up.least, self.up.largest, self.up.most):
            y = self.y(value)
            drawing.line(LEFT, y, right, y, stroke=look.line)
            drawing.text(LEFT - 6, y + 4, self.up.words(value), anchor="end", fill=look.muted)
        for value in figure_ticks(self.across.least, self.across.largest, self.across.most):
            x = self.x(value)
            drawing.line(x, bottom, x, bottom + 4, stroke=look.muted)
            drawing.text(x, bottom + 16, self.across.words(value), anchor="middle", fill=look.muted)
        drawing.line(LEFT, bottom, right, bottom, stroke=look.muted)
        drawing.text(right, self.height - 8, self.across.name, anchor="end", fill=look.muted)
        drawing.text(6, TOP - 8, self.up.name, fill=look.muted)


def percent(value: float) -> str:
    """Return a share as people write it."""
    return f"{100 * value:.4g} %"


def _share(value: float, axis: Axis) -> float:
    span = axis.largest - axis.least
    return min(max((value - axis.least) / span, 0.0), 1.0) if span > 0.0 else 0.0

"""Recorded starts over one another: current and voltage from the switching on, beside a reference start."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite

from service.pictures.axes import RIGHT, TOP, Axes, Axis
from service.pictures.looks import PRINT, Look
from service.pictures.svg import Drawing

WIDTH, HEIGHT = 640.0, 300.0
LOWER_HEIGHT = 190.0
MOST_POINTS = 400
LEAST_SPAN_S = 0.2
AFTER = 1.3
"""Of the longest start so much is shown: the current of the running motor is seen behind it."""


@dataclass(frozen=True, slots=True)
class StartLine:
    """A start: figures [A or V] over the time after the switching on [s].

    lasts_s: until the motor ran; None where that is not known.
    """

    first_s: float
    step_s: float
    values: Sequence[float]
    lasts_s: float | None = None

    @property
    def points(self) -> list[tuple[float, float]]:
        """Return times and figures."""
        return [(self.first_s + number * self.step_s, value) for number, value in enumerate(self.values)]


def starts_picture(
    title: str,
    starts: Sequence[StartLine],
    *,
    reference: StartLine | None = None,
    unit: str = "A",
    name: str = "current",
    look: Look = PRINT,
) -> str:
    """Return the picture as SVG.

    starts: oldest first; the latest is drawn over the others.  reference: what they are compared with.
    name: of the quantity, whose axis begins below the least figure for voltages, else at 0 or below.
    """
    height = HEIGHT if name == "current" else LOWER_HEIGHT
    known = [one for one in starts if one.values and all(map(isfinite, one.values))]
    drawing = Drawing(
        WIDTH, height, title=f"{title}: {name} of recorded starts", description=_told(known, reference, unit)
    )
    every = [*known, *([reference] if reference is not None else [])]
    if not every:
        drawing.text(WIDTH / 2, height / 2, "no start yet", anchor="middle", fill=look.muted)
        return drawing.svg()
    span_s = _span(every)
    shown = [value for one in every for time_s, value in one.points if time_s <= span_s]
    most = max(shown, default=0.0)
    lowest = min(shown, default=0.0)
    least = 0.95 * lowest if name == "voltage" else min(0.0, lowest)
    axes = Axes(
        WIDTH,
        height,
        Axis("time after switching on", 0.0, span_s, lambda seconds: f"{seconds:.4g} s", most=8),
        Axis(f"{name} [{unit}]", least, 1.05 * most or 1.0, lambda value: f"{value:.4g}", most=5),
    )
    axes.draw(drawing, look)
    before = {"stroke": look.muted, "stroke_width": "1", "stroke_opacity": "0.6"}
    for one in known[:-1]:
        _line(drawing, axes, one, span_s, before)
    if known:
        _line(drawing, axes, known[-1], span_s, {"stroke": look.accent, "stroke_width": "2"})
    if reference is not None:
        dashes = {"stroke": look.ink, "stroke_width": "1.5", "stroke_dasharray": "6 3"}
        _line(drawing, axes, reference, span_s, dashes)
    words = [
        ("bold: latest", look.accent),
        ("dashed: reference", look.ink),
        ("thin: before", look.muted),
    ]
    for number, (word, colour) in enumerate(words):
        x = WIDTH - RIGHT - 150
        drawing.text(x, TOP + 12 + 15 * number, word, fill=colour, font_size="11")
    return drawing.svg()


def _span(starts: Sequence[StartLine]) -> float:
    """Return how much is shown: the longest start and something after it, or all where none ends."""
    lasting = [one.lasts_s for one in starts if one.lasts_s is not None]
    recorded = max(one.first_s + one.step_s * len(one.values) for one in starts)
    if len(lasting) < len(starts):
        return max(recorded, LEAST_SPAN_S)
    return max(min(recorded, AFTER * max(lasting)), LEAST_SPAN_S)


def _line(drawing: Drawing, axes: Axes, start: StartLine, span_s: float, look: Mapping[str, str]) -> None:
    points = [point for point in start.points if point[0] <= span_s]
    step = -(-len(points) // MOST_POINTS) or 1
    drawing.path([(axes.x(time_s), axes.y(value)) for time_s, value in points[::step]], closed=False, **look)


def _told(starts: Sequence[StartLine], reference: StartLine | None, unit: str) -> str:
    if not starts:
        return "No start yet"
    told = f"{len(starts)} starts; the latest reaches {max(starts[-1].values):.4g} {unit}"
    if reference is not None and reference.values:
        told += f", the reference {max(reference.values):.4g} {unit}"
    return told

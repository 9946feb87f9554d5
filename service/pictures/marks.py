"""Marks of states: each has a shape of its own, so that they differ without colours, too."""

from collections.abc import Iterable

from service.pictures.looks import Look
from service.pictures.svg import Drawing, Place


def mark_states(
    drawing: Drawing, look: Look, marked: Iterable[tuple[Place, str]], radius: float = 3.0
) -> None:
    """Draw a mark at each place: a triangle for watch, a square for fault, a ring for unknown, else a dot."""
    for (x, y), state in marked:
        colour = look.of_state(state)
        if state == "fault":
            drawing.rectangle(x - radius, y - radius, 2 * radius, 2 * radius, fill=colour)
        elif state == "watch":
            corners = [
                (x, y - 1.3 * radius),
                (x + 1.2 * radius, y + 0.9 * radius),
                (x - 1.2 * radius, y + 0.9 * radius),
            ]
            drawing.path(corners, closed=True, fill=colour)
        elif state == "unknown":
            drawing.circles([(x, y)], radius, fill="none", stroke=colour, stroke_width="1.5")
        else:
            drawing.circles([(x, y)], radius, fill=colour)

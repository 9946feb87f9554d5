"""A relay's link over time, as a band: thin while the relay answers, high while it does not.

The height tells the states apart without colour. Colours are classes of the page's style sheet.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from service.pictures.svg import Drawing
from service.pictures.ticks import time_ticks

WIDTH, HEIGHT = 640.0, 56.0
LEFT, RIGHT, TOP, BOTTOM = 2.0, 2.0, 4.0, 20.0

LEAST_WIDTH = 1.5
"""A short outage is drawn so wide [px] that it is seen."""

ROOM_FOR_WORDS = 80.0
"""Width [px] of a time that has room to say that nothing is known of it."""

SHARES = {"up": 0.25, "down": 1.0, "quarantined": 0.75, "unknown": 0.1}
"""How much of the band's height each state takes."""


@dataclass(frozen=True, slots=True)
class LinkSpan:
    """A time [ns] in which a link was in one state; `state` is None where nothing is known."""

    begin_ns: int
    end_ns: int
    state: str | None


def link_timeline(title: str, spans: Sequence[LinkSpan]) -> str:
    """Return the band as SVG. spans: oldest first, each where the one before ends."""
    drawing = Drawing(WIDTH, HEIGHT, title=title)
    if not spans:
        return drawing.svg()
    first_ns, last_ns = spans[0].begin_ns, max(spans[-1].end_ns, spans[0].begin_ns + 1)
    scale = (WIDTH - LEFT - RIGHT) / (last_ns - first_ns)
    bottom = HEIGHT - BOTTOM
    drawing.line(LEFT, bottom, WIDTH - RIGHT, bottom, **{"class": "link-axis"})
    for span in sorted(spans, key=_drawn_late):  # short outages are drawn on top
        if span.state is None:
            _draw_unknown(
                drawing, LEFT + (span.begin_ns - first_ns) * scale, (span.end_ns - span.begin_ns) * scale
            )
            continue
        height = (bottom - TOP) * SHARES.get(span.state, 0.1)
        width = max((span.end_ns - span.begin_ns) * scale, LEAST_WIDTH)
        x = min(LEFT + (span.begin_ns - first_ns) * scale, WIDTH - RIGHT - width)
        drawing.rectangle(x, bottom - height, width, height, **{"class": f"link-{span.state}"})
    for time_ns, words in time_ticks(first_ns, last_ns, 6):
        x = LEFT + (time_ns - first_ns) * scale
        if LEFT + 20 <= x <= WIDTH - RIGHT - 24:
            drawing.line(x, bottom, x, bottom + 4, **{"class": "link-axis"})
            drawing.text(x, HEIGHT - 5, words, anchor="middle", **{"class": "link-tick"})
    return drawing.svg()


def _drawn_late(span: LinkSpan) -> int:
    return {None: 0, "up": 1}.get(span.state, 2)


def _draw_unknown(drawing: Drawing, x: float, width: float) -> None:
    """Draw a time of which nothing is known: a ground of its own, with words where they have room."""
    bottom = HEIGHT - BOTTOM
    drawing.rectangle(x, TOP, width, bottom - TOP, **{"class": "link-not-known"})
    if width >= ROOM_FOR_WORDS:
        middle = (TOP + bottom) / 2 + 4
        drawing.text(x + width / 2, middle, "not known", anchor="middle", **{"class": "link-tick"})

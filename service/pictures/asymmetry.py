"""The asymmetry of a motor in the plane: what it had from the first record on, and what has come since.

The direction of a point says which phase, its distance from the middle says how much. Both are as if the
asymmetry were shorted turns: phase a to the right, b and c a third of a turn further each.
"""

from cmath import exp as cexp
from cmath import isfinite
from collections.abc import Sequence
from dataclasses import dataclass
from math import pi

from service.pictures.arrows import draw_arrow
from service.pictures.looks import PRINT, Look
from service.pictures.svg import Drawing, Place
from service.pictures.ticks import figure_ticks

WIDTH, HEIGHT = 320.0, 350.0
MIDDLE_X, MIDDLE_Y = 160.0, 172.0
RADIUS = 118.0
LEAST_RADIUS = 0.01
"""The outermost ring is 1 % at least, so that noise does not look like a fault."""

MOST_POINTS = 400
"""More dots than these cover each other."""

TURN = cexp(2j * pi / 3.0)


@dataclass(frozen=True, slots=True)
class Asymmetry:
    """What is shown, as levels of shorted turns, fractions of the phase turns.

    before: records before the change, or all where none is seen.  since: those of the change.  standing: what
    the motor had without the change; None while that is not known.  now: what it has with the change; None
    without a change.  detectable: least step that would be seen.
    """

    before: Sequence[complex]
    since: Sequence[complex] = ()
    standing: complex | None = None
    now: complex | None = None
    detectable: float | None = None
    state: str = "healthy"


def asymmetry_picture(title: str, asymmetry: Asymmetry, *, look: Look = PRINT) -> str:
    """Return the picture as SVG."""
    before = _thinned([one for one in asymmetry.before if isfinite(one)])
    since = _thinned([one for one in asymmetry.since if isfinite(one)])
    drawing = Drawing(
        WIDTH, HEIGHT, title=f"{title}: asymmetry by phase", description=_told(asymmetry, len(before))
    )
    drawing.rectangle(0, 0, WIDTH, HEIGHT, fill=look.surface)
    reach = _reach(asymmetry, before, since)
    _grid(drawing, look, reach)
    drawing.circles([_place(one, reach) for one in before], 1.6, fill=look.muted, fill_opacity="0.55")
    colour = look.of_state(asymmetry.state)
    drawing.circles([_place(one, reach) for one in since], 2.2, fill="none", stroke=colour)
    standing, now = asymmetry.standing, asymmetry.now
    if standing is not None:
        if asymmetry.detectable is not None:
            drawing.circles(
                [_place(standing, reach)],
                RADIUS * asymmetry.detectable / reach,
                fill="none",
                stroke=look.muted,
                stroke_dasharray="3 3",
            )
        draw_arrow(drawing, _place(0j, reach), _place(standing, reach), look.ink)
        if now is not None:
            draw_arrow(drawing, _place(standing, reach), _place(now, reach), colour, dashed=True)
    if not before and not since:
        drawing.text(MIDDLE_X, MIDDLE_Y - 12, "no record yet", anchor="middle", fill=look.muted)
    _legend(drawing, look, asymmetry)
    return drawing.svg()


def _reach(asymmetry: Asymmetry, before: Sequence[complex], since: Sequence[complex]) -> float:
    """Return the level of the outermost ring: nearly all records are within."""
    sizes = sorted(map(abs, [*before, *since]))
    most = sizes[int(0.98 * (len(sizes) - 1))] if sizes else 0.0
    ends = [abs(one) for one in (asymmetry.standing, asymmetry.now) if one is not None]
    return 1.1 * max(most, *ends, LEAST_RADIUS, 0.0)


def _place(level: complex, reach: float) -> Place:
    """Return where a level is; one beyond the outermost ring is shown on it."""
    shown = level * min(1.0, reach / abs(level)) if level else level
    return MIDDLE_X + RADIUS * shown.real / reach, MIDDLE_Y - RADIUS * shown.imag / reach


def _grid(drawing: Drawing, look: Look, reach: float) -> None:
    for level in figure_ticks(0.0, reach, 4)[1:]:
        drawing.circles([(MIDDLE_X, MIDDLE_Y)], RADIUS * level / reach, fill="none", stroke=look.line)
        x, y = _place(level * cexp(1j * pi / 3.0), reach)
        drawing.text(x + 3, y - 2, f"{100 * level:.3g} %", fill=look.muted, font_size="10")
    for number, phase in enumerate("abc"):
        x, y = _place(reach * TURN**number, reach)
        drawing.line(MIDDLE_X, MIDDLE_Y, x, y, stroke=look.line)
        label_x, label_y = MIDDLE_X + 1.12 * (x - MIDDLE_X), MIDDLE_Y + 1.12 * (y - MIDDLE_Y)
        drawing.text(label_x, label_y + 4, phase, anchor="middle", fill=look.ink, font_weight="bold")


def _legend(drawing: Drawing, look: Look, asymmetry: Asymmetry) -> None:
    entries = [("dots: records", look.muted)]
    if asymmetry.standing is not None:
        entries.append((f"arrow: mean of the dots, {100 * abs(asymmetry.standing):.2f} %", look.ink))
    if asymmetry.standing is not None and asymmetry.now is not None:
        change = abs(asymmetry.now - asymmetry.standing)
        entries.append(
            (f"dashed arrow: mean change since then, {100 * change:.2f} %", look.of_state(asymmetry.state))
        )
    for number, (words, colour) in enumerate(entries):
        drawing.text(10, HEIGHT - 10 - 15 * (len(entries) - 1 - number), words, fill=colour, font_size="11")


def _told(asymmetry: Asymmetry, records: int) -> str:
    if asymmetry.standing is None:
        return "No reference yet" if records else "No record yet"
    told = f"Mean of the dots {_words(asymmetry.standing)}"
    if asymmetry.now is not None:
        told += f"; change since then {_words(asymmetry.now - asymmetry.standing)}"
    return told


def _words(level: complex) -> str:
    """Return a level with the phase that its direction is nearest to."""
    if not level:
        return "0 %"
    nearest = max(range(3), key=lambda number: (level * TURN.conjugate() ** number).real)
    return f"{100 * abs(level):.2f} %, nearest to phase {'abc'[nearest]}"


def _thinned(points: Sequence[complex]) -> Sequence[complex]:
    """Return every n-th of the points, and those farthest from the middle, so that no outlier hides."""
    if len(points) <= MOST_POINTS:
        return points
    step = -(-len(points) // (MOST_POINTS - 8))
    far = sorted(range(len(points)), key=lambda at: abs(points[at]))[-8:]
    kept = sorted({*range(0, len(points), step), *far})
    return [points[at] for at in kept]

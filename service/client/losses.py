"""Losses and efficiency as text for people, the same in commands and on pages."""

from collections.abc import Iterator
from typing import Final

from core.losses.figures import LossFigures
from core.quantity_text import with_unit

WORTH_NAMING: Final = 0.01
"""Of all losses: a cause that adds less is not named."""


def loss_words(figures: LossFigures) -> Iterator[str]:
    """Yield the efficiency with its interval, the losses, and what adds to them; or why none is told."""
    if figures.efficiency is None or figures.losses_W is None:
        yield from figures.reasons
        return
    words = f"efficiency {figures.efficiency:.1%}"
    if figures.efficiency_ci95 is not None:
        low, high = figures.efficiency_ci95
        words += f" [{100 * low:.1f}..{100 * high:.1f}]"
    if figures.output_W is not None:
        words += f" at {with_unit(figures.output_W, 'W', 3)} of shaft power"
    yield f"{words}; losses {with_unit(figures.losses_W, 'W', 3)}"
    added = [
        f"{cause} {with_unit(watts, 'W', 3)}"
        for cause, watts in figures.extra_W.items()
        if watts >= WORTH_NAMING * figures.losses_W
    ]
    if added:
        yield f"of these by {', '.join(added)}"
    yield from figures.reasons

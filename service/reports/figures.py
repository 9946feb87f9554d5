"""Figures of conditions in the words of a report."""

from service.condition.wording import cause
from service.storage.records import ConditionFigures

NOTHING = "-"


def number(value: object) -> float | None:
    """Return a figure of a stored document; None where it has none."""
    return float(value) if isinstance(value, int | float) else None


def share(value: float | None) -> str:
    """Return a share of one in percent."""
    return NOTHING if value is None else f"{100 * value:.2f} %"


def interval(value: float | None, ends: tuple[float, float] | None) -> str:
    """Return a share with its 95 % interval."""
    if value is None:
        return NOTHING
    return share(value) if ends is None else f"{share(value)} [{100 * ends[0]:.2f} .. {100 * ends[1]:.2f}]"


def state_words(figures: ConditionFigures) -> str:
    """Return a state with what stands out."""
    kind = cause(figures)
    return f"{figures.state.value}: {kind}" if kind else figures.state.value

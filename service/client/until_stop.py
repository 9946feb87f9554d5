"""Whether a motor may run until its planned stop, in words, the same on every surface."""

from collections.abc import Sequence
from typing import Final

SURE: Final = 0.995
"""Probability that is not told as 100 %."""


def answer_of(probability: float | None, reasons: Sequence[str]) -> str:
    """Return the answer. reasons: why there is none, or what it does not hold; the first one matters most."""
    first = reasons[0] if reasons else ""
    if probability is None:
        return f"not assessed: {first}"
    if probability == 0.0 and first.startswith("beyond"):
        return f"no: {first}"
    if probability >= SURE:
        return "more than 99 % likely that no part passes its limit before"
    if probability < 1.0 - SURE:
        return "less than 1 % likely that no part passes its limit before"
    return f"{100 * probability:.0f} % likely that no part passes its limit before"

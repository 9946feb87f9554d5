"""When a motor's standing asymmetry has changed so far that the others of its bus are judged anew.

It changes a little with every record. The others use the latest one with their own next record anyway.
"""

from collections.abc import Mapping, Sequence
from math import sqrt
from typing import Any

TOLD = "told"
"""Key of the document, beside the estimate: the one that the others were last judged anew for."""

DEVIATIONS = 0.2
"""Standard deviations of the estimate."""

RATIO = 1.25
"""Of variances."""


def is_material(told: Any, now: Mapping[str, Any] | None) -> bool:
    """Tell whether an estimate is so different from the one before that the others' conditions may be too."""
    if not told or now is None:
        return bool(told) != bool(now)
    if any(told[name] != now[name] for name in ("sequence", "others")):
        return True
    variances = _diagonal(told["covariance"])
    moved = zip(told["asymmetry"], now["asymmetry"], variances, strict=True)
    if any(abs(after - before) > DEVIATIONS * sqrt(variance) for before, after, variance in moved):
        return True
    return any(
        not before <= RATIO * after or not after <= RATIO * before
        for name in ("covariance", "channels")
        for before, after in zip(_diagonal(told[name]), _diagonal(now[name]), strict=True)
    )


def _diagonal(matrix: Sequence[Sequence[float]]) -> list[float]:
    return [row[at] for at, row in enumerate(matrix)]

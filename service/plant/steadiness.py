"""Whether a motor runs at a steady load, from what its relay measured over some time."""

from collections.abc import Mapping, Sequence

from core.machines.parameters import Nameplate
from service.plant.standstill import CURRENTS, why_it_stands

LEAST_SAMPLES = 3
MOST_SPREAD = 0.1
"""From the smallest to the largest mean of the phase currents, over the mean of all."""


def why_not_steady(measured: Sequence[Mapping[str, float | None]], nameplate: Nameplate) -> str | None:
    """Return why a motor is not taken to run at a steady load, in words; None where it does."""
    means = []
    for values in measured:
        currents = [value for each in CURRENTS if (value := values.get(each)) is not None]
        if currents:
            means.append(sum(currents) / len(currents))
            standing = why_it_stands(values, nameplate)
            if standing is not None:
                return standing
    if len(means) < LEAST_SAMPLES:
        return (
            f"too little was measured lately: expected its currents {LEAST_SAMPLES} times or more, found "
            f"{len(means)}; see metering_period_s of the settings, and which values the relay offers"
        )
    spread = (max(means) - min(means)) * len(means) / sum(means)
    if spread > MOST_SPREAD:
        return f"its load moves: its current differs by {spread:.0%}, expected {MOST_SPREAD:.0%} at most"
    return None

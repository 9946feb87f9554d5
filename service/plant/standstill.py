"""Whether a motor stands, from what its relay measures all the time."""

from collections.abc import Mapping

from core.machines.parameters import Nameplate
from core.quality import rated_current_A
from service.plant.quantities import MeteredQuantity

CURRENTS = (MeteredQuantity.IA, MeteredQuantity.IB, MeteredQuantity.IC)

LEAST_RUNNING = 0.05
"""Share of the rated current that a running motor draws at least: without load it is 0.15 and more. What a
relay shows of a motor at rest, offsets and noise, is below 0.02."""


def why_it_stands(measured: Mapping[str, float | None], nameplate: Nameplate) -> str | None:
    """Return why a motor is taken to stand, in words; None where it runs, or no current is measured."""
    currents = [value for each in CURRENTS if (value := measured.get(each)) is not None]
    least = LEAST_RUNNING * rated_current_A(nameplate)
    if not currents or max(currents) >= least:
        return None
    return (
        f"the motor stands: its relay measures {max(currents):.2g} A, and a running motor of this rating "
        f"draws at least {least:.2g} A"
    )

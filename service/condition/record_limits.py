"""How many records of a motor lie beyond limits of what its relay does not meter: harmonics of the supply.

A record is a moment. So the share is one of records, not of hours.
"""

from dataclasses import dataclass
from typing import Final

from service.storage import Repository
from service.storage.records import SupplyQuantity


@dataclass(frozen=True, slots=True)
class RecordLimit:
    """Records beyond a limit. records: all that tell the quantity.  worst: largest; None without records."""

    name: str
    limit: float
    records: int
    beyond: int
    worst: float | None

    @property
    def share(self) -> float | None:
        """Share of the records that lie beyond; None without records."""
        return self.beyond / self.records if self.records else None


LIMITS: Final = (
    ("THD of the voltage above 8 %", SupplyQuantity.THD_VOLTAGE, 0.08),
    ("HVF above 0.02", SupplyQuantity.HARMONIC_VOLTAGE_FACTOR, 0.02),
    ("HVF above 0.03", SupplyQuantity.HARMONIC_VOLTAGE_FACTOR, 0.03),
)
"""EN 50160 for the distortion; IEC 60034-1, 7.2.1.1, for HVF, of which 0.03 is for motors of design N."""


def record_limits(repository: Repository, motor: str, *, from_ns: int, to_ns: int) -> tuple[RecordLimit, ...]:
    """Return how many records lie beyond each limit, from_ns <= time < to_ns. Raises NotFoundError."""
    quantities = [(quantity, limit) for _, quantity, limit in LIMITS]
    counts = repository.supply_beyond(motor, quantities, from_ns=from_ns, to_ns=to_ns)
    return tuple(
        RecordLimit(name, limit, found.records, found.beyond, found.worst)
        for (name, _, limit), found in zip(LIMITS, counts, strict=True)
    )

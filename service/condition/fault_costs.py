"""What a motor's losses cost, from its records and from the hours that its relay meters."""

from dataclasses import dataclass
from typing import Final

from core.losses.cost import HOURS_PER_YEAR, DatedLosses, LossCost, loss_cost
from core.machines.parameters import Motor
from service.condition.metered_load import metered_duty
from service.configuration.energy import EnergySettings
from service.storage import Repository

MOST_RECORDS: Final = 400
"""Latest records that tell of the losses."""
DUTY_DAYS: Final = 30
"""Days whose metered hours tell how many the motor runs in a year."""


@dataclass(frozen=True, slots=True)
class FaultCosts:
    """What a motor's losses cost. duty: share of the time that it runs, None where it is not metered.

    currency: of the costs; empty where none is set.
    """

    found: LossCost
    duty: float | None
    currency: str


def fault_costs(
    repository: Repository, motor: str, known: Motor | None, energy: EnergySettings, *, now_ns: int
) -> FaultCosts:
    """Return what the losses of a motor cost. Raises NotFoundError.

    known: the motor as its file tells it, for its metered hours; None before a service has read the file. A
    motor of which no hours are metered is taken to run all the time.
    """
    course = [
        DatedLosses(one.time_ns, one.figures)
        for one in repository.latest_losses(motor, limit=MOST_RECORDS)
        if one.figures.efficiency is not None
    ]
    duty = None if known is None else metered_duty(repository, known, days=DUTY_DAYS, now_ns=now_ns)
    hours = HOURS_PER_YEAR * (1.0 if duty is None else duty)
    found = loss_cost(course, running_hours_per_year=hours, price_per_kWh=energy.price_per_kWh)
    return FaultCosts(found, duty, energy.currency)

"""Documents of a motor's losses and of what they cost. Fields that are null are not known (yet)."""

from service.api.document import Document, Listed
from service.condition.fault_costs import FaultCosts

Interval = tuple[float, float]


class LoadEfficiency(Document):
    """The efficiency at one load: of so many records, the median of each figure.

    load_class: tenth of the rated power at the shaft, 0 to 11.
    """

    load_class: int
    records: int
    efficiency: float
    efficiency_ci95: Interval


class CauseCost(Document):
    """What one cause adds to the losses, the median of the latest records; below zero where it saves some.

    growth_W_per_year: null of too few records (..._ci95: 95 % interval, by the scatter of the records).
    """

    cause: str
    loss_W: float
    energy_kWh_per_year: float
    cost_per_year: float | None
    growth_W_per_year: float | None
    growth_W_per_year_ci95: Interval | None


class Losses(Document):
    """What a motor loses, and what of it faults and supply cost a year.

    records: the latest ones that tell it. losses_W: median of the latest. duty: running over known hours of
    the last 30 days; null where none is metered, and the motor is then taken to run all the time.
    currency: of `[energy]`, empty without one.
    """

    records: int
    losses_W: float | None
    duty: float | None
    running_hours_per_year: float
    currency: str
    efficiencies: Listed[LoadEfficiency]
    causes: Listed[CauseCost]


def losses_document(costs: FaultCosts) -> Losses:
    """Return the document of what a motor's losses cost."""
    found = costs.found
    return Losses(
        records=found.records,
        losses_W=found.losses_W,
        duty=costs.duty,
        running_hours_per_year=found.running_hours_per_year,
        currency=costs.currency,
        efficiencies=[LoadEfficiency.model_validate(one) for one in found.efficiencies],
        causes=[CauseCost.model_validate(one) for one in found.causes],
    )

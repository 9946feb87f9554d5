"""The document of a motor's losses and of what they cost. Fields that are null are not known (yet)."""

from core.losses.cost import CauseCost, LoadEfficiency
from service.api.document import Document, Listed
from service.condition.fault_costs import FaultCosts


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
        efficiencies=list(found.efficiencies),
        causes=list(found.causes),
    )

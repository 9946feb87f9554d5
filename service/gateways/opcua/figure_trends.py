"""What the variables of a motor that have a history told in the past."""

from functools import partial
from typing import NamedTuple, Protocol

from core.diagnosis.verdict import Verdict
from service.storage import Repository
from service.storage.records import ConditionPoint, Page, Quantity, TrendPoint


class PastValue(NamedTuple):
    """What a variable told from a record on. is_good: False where the record does not tell the figure."""

    time_ns: int
    value: float | None
    is_good: bool


class FigureTrend(Protocol):
    """Asks for values, from_ns <= time < to_ns, oldest first or newest first. Raises NotFoundError."""

    def __call__(
        self, *, limit: int, from_ns: int | None = None, to_ns: int | None = None, descending: bool = False
    ) -> tuple[PastValue, ...]: ...


def trend_of(repository: Repository, motor: str, quantity: Quantity) -> FigureTrend:
    """Return what asks for a figure's values.

    The level is that of the motor's condition, as its variable tells it: a record alone may show another.
    The load is each record's own.
    """
    if quantity == "mu_f":
        return partial(_levels, repository, motor)
    return partial(_of_records, repository, motor, quantity)


def _levels(
    repository: Repository,
    motor: str,
    *,
    limit: int,
    from_ns: int | None = None,
    to_ns: int | None = None,
    descending: bool = False,
) -> tuple[PastValue, ...]:
    page: Page[ConditionPoint] = repository.condition_trend(
        motor, limit=limit, from_ns=from_ns, to_ns=to_ns, descending=descending
    )
    return tuple(PastValue(point.time_ns, point.mu_f, point.mu_f is not None) for point in page.items)


def _of_records(
    repository: Repository,
    motor: str,
    quantity: Quantity,
    *,
    limit: int,
    from_ns: int | None = None,
    to_ns: int | None = None,
    descending: bool = False,
) -> tuple[PastValue, ...]:
    page: Page[TrendPoint] = repository.trend(
        motor, quantity, limit=limit, from_ns=from_ns, to_ns=to_ns, descending=descending
    )
    return tuple(
        PastValue(
            point.recorded_ns,
            point.value,
            point.value is not None and point.verdict is not Verdict.UNDIAGNOSABLE,
        )
        for point in page.items
    )

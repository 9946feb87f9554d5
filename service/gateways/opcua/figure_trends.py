"""What the variables of a motor that have a history told in the past."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Generic, NamedTuple, Protocol, TypeVar

from core.diagnosis.verdict import Verdict
from service.storage import Repository
from service.storage.records import ConditionPoint, Page, Quantity, TrendPoint

Point = TypeVar("Point")


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
        return _Values(partial(repository.condition_trend, motor), _level)
    return _Values(partial(repository.trend, motor, quantity), _of_record)


@dataclass(frozen=True, slots=True)
class _Values(Generic[Point]):
    """Asks the database for a page of points, and makes values of them."""

    ask: Callable[..., Page[Point]]
    to_value: Callable[[Point], PastValue]

    def __call__(
        self, *, limit: int, from_ns: int | None = None, to_ns: int | None = None, descending: bool = False
    ) -> tuple[PastValue, ...]:
        page = self.ask(limit=limit, from_ns=from_ns, to_ns=to_ns, descending=descending)
        return tuple(map(self.to_value, page.items))


def _level(point: ConditionPoint) -> PastValue:
    return PastValue(point.time_ns, point.mu_f, point.mu_f is not None)


def _of_record(point: TrendPoint) -> PastValue:
    is_good = point.value is not None and point.verdict != Verdict.UNDIAGNOSABLE
    return PastValue(point.recorded_ns, point.value, is_good)

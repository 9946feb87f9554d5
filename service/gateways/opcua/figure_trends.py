"""What the variables of a motor that have a history told in the past."""

from functools import partial
from typing import NamedTuple, Protocol

from core.diagnosis.verdict import Verdict
from service.storage import Repository
from service.storage.records.history import TrendPoint


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


def trend_of(repository: Repository, motor: str, quantity: str) -> FigureTrend:
    """Return what asks for a figure's values; quantity: its name (core.quantities)."""
    ask = partial(repository.trend, motor, quantity)

    def values(
        *, limit: int, from_ns: int | None = None, to_ns: int | None = None, descending: bool = False
    ) -> tuple[PastValue, ...]:
        page = ask(limit=limit, from_ns=from_ns, to_ns=to_ns, descending=descending)
        return tuple(map(_past_value, page.items))

    return values


def _past_value(point: TrendPoint) -> PastValue:
    is_good = point.value is not None and point.verdict != Verdict.UNDIAGNOSABLE
    return PastValue(point.time_ns, point.value, is_good)

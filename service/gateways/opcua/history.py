"""HistoryRead from the trends of the database."""

import asyncio
from collections.abc import Mapping
from datetime import UTC, datetime, timedelta
from typing import Any, Final

from asyncua import ua
from asyncua.server.history import HistoryStorageInterface

from core.diagnosis.verdict import Verdict
from service.storage import Repository
from service.storage.records import Quantity, TrendPoint

MOST: Final = 1000
"""Values of one answer; the client asks for more with the point that it is given."""

EPOCH: Final = datetime(1970, 1, 1, tzinfo=UTC)
MICROSECOND: Final = timedelta(microseconds=1)


def utc(time_ns: int) -> datetime:
    """Return a time as the library takes it."""
    return EPOCH + timedelta(microseconds=time_ns // 1000)


class TrendHistory(HistoryStorageInterface):  # type: ignore[misc]
    """The values of records, oldest first. Nothing is stored here: the database has it already."""

    def __init__(self, repository: Repository, nodes: Mapping[ua.NodeId, tuple[str, Quantity]]) -> None:
        super().__init__()
        self._repository = repository
        self._nodes = nodes

    async def init(self) -> None:
        """Do nothing."""

    async def stop(self) -> None:
        """Do nothing."""

    async def new_historized_node(self, node_id: ua.NodeId, period: timedelta | None, count: int = 0) -> None:
        """Do nothing: which nodes have a history is known."""

    async def save_node_value(self, node_id: ua.NodeId, datavalue: ua.DataValue) -> None:
        """Do nothing."""

    async def new_historized_event(
        self, source_id: ua.NodeId, evtypes: Any, period: timedelta | None, count: int = 0
    ) -> None:
        """Do nothing."""

    async def save_event(self, event: Any) -> None:
        """Do nothing."""

    async def read_event_history(
        self,
        source_id: ua.NodeId,
        start: datetime | None,
        end: datetime | None,
        nb_values: int,
        evfilter: Any,
    ) -> tuple[list[Any], datetime | None]:
        """Return nothing: alarms have their history in the service."""
        del source_id, start, end, nb_values, evfilter
        return [], None

    async def read_node_history(
        self, node_id: ua.NodeId, start: datetime | None, end: datetime | None, nb_values: int
    ) -> tuple[list[ua.DataValue], datetime | None]:
        """Return values from `start` to `end`, and the time of the first one that is left."""
        place = self._nodes.get(node_id)
        if place is None:
            return [], None
        motor, quantity = place
        limit = min(nb_values, MOST) if nb_values > 0 else MOST
        page = await asyncio.to_thread(
            self._repository.trend,
            motor,
            quantity,
            limit=limit + 1,
            from_ns=_nanoseconds(start),
            to_ns=_nanoseconds(end, included=True),
        )
        rest = utc(page.items[limit].recorded_ns) if len(page.items) > limit else None
        return [_value(point) for point in page.items[:limit]], rest


def _nanoseconds(time: datetime | None, *, included: bool = False) -> int | None:
    """Return a time in nanoseconds; None for the times by which clients say that they name none.

    included: whether what is of that time belongs to it; clients know microseconds.
    """
    if time is None:
        return None
    aware = time if time.tzinfo is not None else time.replace(tzinfo=UTC)
    if aware <= EPOCH:
        return None
    return ((aware - EPOCH) // MICROSECOND + int(included)) * 1000


def _value(point: TrendPoint) -> ua.DataValue:
    is_told = point.value is not None and point.verdict is not Verdict.UNDIAGNOSABLE
    status = ua.StatusCodes.Good if is_told else ua.StatusCodes.BadNoData
    time = utc(point.recorded_ns)
    return ua.DataValue(
        ua.Variant(point.value, ua.VariantType.Double) if point.value is not None else ua.Variant(),
        StatusCode=ua.StatusCode(status),
        SourceTimestamp=time,
        ServerTimestamp=time,
    )

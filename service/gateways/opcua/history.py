"""HistoryRead from the trends of the database."""

import struct
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from functools import partial
from typing import Any, Final

import structlog
from asyncua import Server, ua
from asyncua.server.history import HistoryManager
from asyncua.server.internal_server import InternalServer
from sqlalchemy.exc import SQLAlchemyError

from service.gateways.opcua.figure_trends import FigureTrend, PastValue, trend_of
from service.gateways.opcua.worker_threads import LONGEST_S, TURN_S, WorkerThreads
from service.storage import NotFoundError, Repository
from service.timing.database_silence import database_trouble

log = structlog.get_logger(__name__)

MOST: Final = 1000
"""Values of one answer; the client asks for more with the point that it is given."""

MOST_OF_ALL: Final = 10_000
"""Values of all nodes of one answer: each of a hundred nodes has a hundred, and a point to go on at."""

READS_AT_ONCE: Final = 2
"""Requests that are answered at a time."""

EPOCH: Final = datetime(1970, 1, 1, tzinfo=UTC)
MICROSECOND: Final = timedelta(microseconds=1)
SECOND: Final = timedelta(seconds=1)
RESOLUTION_NS: Final = 1000
LATEST_NS: Final = 2**63 - 1 - RESOLUTION_NS
"""Later times are none that the database can be asked for; clients name the year 9999."""

CONTINUATION: Final = struct.Struct("<qH")
"""Where an answer goes on: time of the next value, and how many of that time were told already."""

_CAPABILITIES: Final = "HistoryServerCapabilities_"
ABLE: Final = ("AccessHistoryData",)
UNABLE: Final = (
    *("AccessHistoryEvents", "InsertData", "ReplaceData", "UpdateData", "DeleteRaw", "DeleteAtTime"),
    *("InsertEvent", "ReplaceEvent", "UpdateEvent", "DeleteEvent", "InsertAnnotation"),
)
"""What clients may ask of histories, and what not."""


def utc(time_ns: int) -> datetime:
    """Return a time as the library takes it."""
    return EPOCH + timedelta(microseconds=time_ns // 1000)


@dataclass(frozen=True, slots=True)
class _Asked:
    """What is asked for, in the direction of reading: all from start on, and what is at end with bounds only.

    start, end: None where it is not named. with_bounds: whether the values at both ends are asked for, or
    those next to them outside. next_ns, told: where it goes on, and how many of that time were told before.
    """

    start: datetime | None
    end: datetime | None
    newest_first: bool
    with_bounds: bool
    next_ns: int | None = None
    told: int = 0


@dataclass(frozen=True, slots=True)
class _Domain:
    """Where values are looked for: from_ns <= time < to_ns. lacks_start, lacks_end: a bound was not found."""

    from_ns: int | None
    to_ns: int | None
    lacks_start: bool
    lacks_end: bool


@dataclass(slots=True)
class _Reading:
    """One request. until_s: when its client has been refused. has_failed: the database does not answer."""

    until_s: float
    has_failed: bool = False

    @property
    def is_in_vain(self) -> bool:
        """Return whether to ask the database for nothing more."""
        return self.has_failed or time.monotonic() > self.until_s


class TrendHistory(HistoryManager):  # type: ignore[misc]
    """The values of records. Nothing is stored here: the database has it already."""

    def __init__(
        self, server: InternalServer, repository: Repository, nodes: Mapping[ua.NodeId, tuple[str, str]]
    ) -> None:
        super().__init__(server)
        self._repository = repository
        self._nodes = nodes
        self._threads = WorkerThreads("history", READS_AT_ONCE)

    def close(self) -> None:
        """Read nothing more."""
        self._threads.close()

    async def read_history(self, params: ua.HistoryReadParameters) -> list[ua.HistoryReadResult]:
        """Return the values of each node, or why there are none."""
        if params.ReleaseContinuationPoints:  # they have all that is needed: nothing is kept here
            return [ua.HistoryReadResult() for _ in params.NodesToRead]
        # A thread is not to go on for a client that is not there any more.
        reading = _Reading(until_s=time.monotonic() + TURN_S + LONGEST_S)
        return await self._threads.run(partial(self._answers, params, reading))

    def _answers(self, params: ua.HistoryReadParameters, reading: _Reading) -> list[ua.HistoryReadResult]:
        most = min(MOST, MOST_OF_ALL // max(len(params.NodesToRead), 1))
        details = params.HistoryReadDetails
        return [self._answer(details, asked, most, reading) for asked in params.NodesToRead]

    def _answer(
        self, details: Any, asked: ua.HistoryReadValueId, most: int, reading: _Reading
    ) -> ua.HistoryReadResult:
        if reading.is_in_vain:
            return _refused(ua.StatusCodes.BadResourceUnavailable)
        try:
            motor, quantity = self._place(details, asked.NodeId)
            trend = trend_of(self._repository, motor, quantity)
            most = min(details.NumValuesPerNode or most, most)
            return _read(trend, _asked(details, asked.ContinuationPoint), most)
        except ua.UaStatusCodeError as refused:
            return _refused(refused.code)
        except NotFoundError:
            return _refused(ua.StatusCodes.BadNodeIdUnknown)
        except SQLAlchemyError as error:
            log.warning("a history cannot be read", error=database_trouble(error))
            reading.has_failed = True
            return _refused(ua.StatusCodes.BadResourceUnavailable)

    def _place(self, details: object, node: ua.NodeId) -> tuple[str, str]:
        """Return the motor and the figure whose values are asked for. Raises UaStatusCodeError."""
        if node not in self.iserver.aspace:
            raise ua.UaStatusCodeError(ua.StatusCodes.BadNodeIdUnknown)
        place = self._nodes.get(node)
        is_raw = isinstance(details, ua.ReadRawModifiedDetails) and not details.IsReadModified
        if place is None or not is_raw:
            raise ua.UaStatusCodeError(ua.StatusCodes.BadHistoryOperationUnsupported)
        return place


async def tell_capabilities(server: Server) -> None:
    """Have the server say what its histories are good for; the library leaves that open."""
    values = {f"{name}Capability": ua.Variant(name in ABLE) for name in (*ABLE, *UNABLE)}
    values["MaxReturnDataValues"] = ua.Variant(MOST, ua.VariantType.UInt32)
    values["MaxReturnEventValues"] = ua.Variant(0, ua.VariantType.UInt32)
    values["ServerTimestampSupported"] = ua.Variant(Value=False)
    for name, value in values.items():
        node_id = ua.NodeId(getattr(ua.ObjectIds, f"{_CAPABILITIES}{name}"))
        await server.write_attribute_value(node_id, ua.DataValue(value))


def _read(trend: FigureTrend, asked: _Asked, most: int) -> ua.HistoryReadResult:
    """Return values in their order, with bounds where they are asked for (OPC 10000-11, 4.6)."""
    domain = _domain(trend, asked)
    is_first = asked.next_ns is None
    values = [_lacking(asked.start)] if domain.lacks_start and is_first else []
    end = asked.told + most - len(values)
    points = trend(from_ns=domain.from_ns, to_ns=domain.to_ns, limit=end + 1, descending=asked.newest_first)
    values += [_value(point) for point in points[asked.told : end]]
    rest = None
    if len(points) > end:
        rest = _continuation(points[end].time_ns, points[:end])
    elif domain.lacks_end:
        last_ns = points[-1].time_ns if points else _nanoseconds(asked.start) or 0
        if len(values) < most:
            values.append(_lacking(asked.end or utc(last_ns) + (-SECOND if asked.newest_first else SECOND)))
        else:
            rest = _continuation(last_ns, points)
    return ua.HistoryReadResult(
        StatusCode=ua.StatusCode(ua.StatusCodes.Good if points else ua.StatusCodes.GoodNoData),
        ContinuationPoint=rest,
        HistoryData=ua.HistoryData(DataValues=values),
    )


def _asked(details: ua.ReadRawModifiedDetails, continuation: bytes | None) -> _Asked:
    """Return what is asked for; newest first where the start is later than the end, or is not named."""
    start, end = _named(details.StartTime), _named(details.EndTime)
    newest_first = start is None or (end is not None and end < start)
    if start is None:
        start, end = end, None
    asked = _Asked(start, end, newest_first, details.ReturnBounds and start is not None)
    if not continuation:
        return asked
    try:
        next_ns, told = CONTINUATION.unpack(continuation)
    except struct.error as error:
        raise ua.UaStatusCodeError(ua.StatusCodes.BadContinuationPointInvalid) from error
    return replace(asked, next_ns=next_ns, told=told)


def _domain(trend: FigureTrend, asked: _Asked) -> _Domain:
    """Return where values are looked for; with bounds it reaches to the values next to both times."""
    start_ns, end_ns = _nanoseconds(asked.start), _nanoseconds(asked.end)
    has_end = asked.with_bounds or start_ns == end_ns
    bounds: tuple[int | None, int | None] = (None, None)
    if asked.with_bounds:
        bounds = (
            _bound(trend, start_ns, is_before=not asked.newest_first),
            _bound(trend, end_ns, is_before=asked.newest_first),
        )
    start_ns = start_ns if bounds[0] is None else bounds[0]
    end_ns = end_ns if bounds[1] is None else bounds[1]
    if asked.newest_first:
        from_ns, to_ns = (end_ns if has_end else _after(end_ns)), _after(start_ns)
    else:
        from_ns, to_ns = start_ns, (_after(end_ns) if has_end else end_ns)
    if asked.next_ns is not None and asked.newest_first:
        to_ns = min(asked.next_ns, LATEST_NS) + 1
    elif asked.next_ns is not None:
        from_ns = asked.next_ns
    lacks_start, lacks_end = (asked.with_bounds and bound is None for bound in bounds)
    return _Domain(from_ns, to_ns, lacks_start, lacks_end)


def _bound(trend: FigureTrend, time_ns: int | None, *, is_before: bool) -> int | None:
    """Return the time of the value at this time, or of the next one before or after it."""
    if time_ns is None:
        return None
    if is_before:
        points = trend(to_ns=_after(time_ns), limit=1, descending=True)
    else:
        points = trend(from_ns=time_ns, limit=1)
    return points[0].time_ns // RESOLUTION_NS * RESOLUTION_NS if points else None


def _after(time_ns: int | None) -> int | None:
    """Return the next time that a client can name."""
    return None if time_ns is None else time_ns + RESOLUTION_NS


def _continuation(next_ns: int, told: Sequence[PastValue]) -> bytes:
    return CONTINUATION.pack(next_ns, sum(point.time_ns == next_ns for point in told))


def _named(time: datetime | None) -> datetime | None:
    """Return a time in UTC; None for the one by which clients say that they name none."""
    if time is None:
        return None
    aware = time if time.tzinfo is not None else time.replace(tzinfo=UTC)
    return None if aware <= ua.get_win_epoch() else aware


def _nanoseconds(time: datetime | None) -> int | None:
    """Return a time as the database can be asked for it."""
    if time is None:
        return None
    return min(max((time - EPOCH) // MICROSECOND * RESOLUTION_NS, 0), LATEST_NS)


def _refused(code: int) -> ua.HistoryReadResult:
    return ua.HistoryReadResult(StatusCode=ua.StatusCode(code))


def _value(point: PastValue) -> ua.DataValue:
    status = ua.StatusCodes.Good if point.is_good else ua.StatusCodes.BadNoData
    time = utc(point.time_ns)
    return ua.DataValue(
        ua.Variant(point.value, ua.VariantType.Double) if point.value is not None else ua.Variant(),
        StatusCode=ua.StatusCode(status),
        SourceTimestamp=time,
        ServerTimestamp=time,
    )


def _lacking(time: datetime | None) -> ua.DataValue:
    """Return what stands for a bound that there is not."""
    status = ua.StatusCode(ua.StatusCodes.BadBoundNotFound)
    return ua.DataValue(ua.Variant(), StatusCode=status, SourceTimestamp=time, ServerTimestamp=time)

"""A controlling station on lib60870, which shares nothing with the server, is told of the motors.

It knows one type for each address and passes over what comes with another one. So two are at work here: one
with the types that answer an interrogation, one with those that tell changes.
"""

import math
from collections.abc import Iterator
from contextlib import contextmanager

import c104
import pytest

from service.gateways.iec104.points import RELAY_ANSWERS
from service.storage import Repository
from testing.ports import LOOPBACK
from testing.service.conditions import FAULT, HEALTHY, tell
from testing.service.plants import NOW_NS, SECOND_NS
from testing.waiting import eventually
from tests.service.gateways.iec104.test_iec104 import PUMP, port

__all__ = ["port"]  # a fixture

Kind = c104.Type
Points = dict[str, c104.Point]


def number(point: c104.Point) -> float:
    """What a point tells, as a number."""
    return float(str(point.value)) if not isinstance(point.value, bool) else float(point.value)


def is_open(connection: c104.Connection) -> bool:
    """Whether data flow. The library now and then loses its own order to begin, also with its own station."""
    if connection.state == c104.ConnectionState.OPEN_MUTED:
        connection.unmute()
    return connection.state == c104.ConnectionState.OPEN


@contextmanager
def connected(
    port: int, single: Kind, measured: Kind, whole: Kind
) -> Iterator[tuple[c104.Connection, Points]]:
    """A controlling station that knows the points of the pump by these types."""
    client = c104.Client()
    connection = client.add_connection(ip=LOOPBACK, port=port, init=c104.Init.NONE)
    assert connection is not None
    station = connection.add_station(common_address=1)
    assert station is not None
    kinds = {
        "fault": (1, single),
        "level": (2, measured),
        "phase": (9, whole),
        "link": (RELAY_ANSWERS, single),
    }
    points = {}
    for name, (offset, kind) in {**kinds, "command": (1000, Kind.C_SC_NA_1)}.items():
        point = station.add_point(io_address=PUMP + offset, type=kind)
        assert point is not None
        points[name] = point
    client.start()
    try:
        assert eventually(lambda: is_open(connection))
        yield connection, points
    finally:
        client.stop()


def test_it_interrogates_and_is_refused(repository: Repository, port: int) -> None:
    tell(repository, FAULT)
    with connected(port, Kind.M_SP_NA_1, Kind.M_ME_NC_1, Kind.M_ME_NB_1) as (connection, points):

        def level() -> float:
            is_answered = connection.interrogation(common_address=1)
            return number(points["level"]) if is_answered else math.nan

        assert eventually(lambda: level() == pytest.approx(1.21))
        assert "Invalid" not in str(points["level"].quality)
        assert (number(points["fault"]), number(points["phase"])) == (1, 2)
        assert eventually(lambda: "Invalid" in str(points["link"].quality))
        assert not points["command"].transmit(cause=c104.Cot.ACTIVATION)
        assert not connection.clock_sync(common_address=1)
        assert connection.is_connected


def test_it_reads_and_hears_changes_with_their_time(repository: Repository, port: int) -> None:
    tell(repository, HEALTHY)
    with connected(port, Kind.M_SP_TB_1, Kind.M_ME_TF_1, Kind.M_ME_TE_1) as (_, points):
        assert eventually(lambda: points["fault"].read() and "Invalid" not in str(points["fault"].quality))
        assert number(points["fault"]) == 0
        tell(repository, FAULT)
        assert eventually(lambda: number(points["fault"]) == 1 and number(points["phase"]) == 2)
        assert number(points["level"]) == pytest.approx(1.21)
        time = points["level"].recorded_at
        assert time is not None
        assert time.timestamp() == NOW_NS / SECOND_NS

"""The IEC 60870-5-104 gateway: follows the plant's state and tells changes by themselves."""

from collections.abc import Mapping
from datetime import datetime
from pathlib import Path
from typing import Final

import c104
import structlog

from service.configuration.gateways.iec104 import Iec104Settings, Iec104Tls
from service.gateways.context import GatewayContext
from service.gateways.iec104.points import (
    GONE,
    MOST_MOTORS,
    POINTS,
    RELAY_ANSWERS,
    SINGLE,
    Said,
    address,
    link_of,
    said_of,
)
from service.gateways.kept_file import write_table
from service.gateways.numbering import MotorNumbers
from service.gateways.plant_state.figures import MotorFigures, PlantChange, PlantState

log = structlog.get_logger(__name__)

NUMBERS: Final = "iec104-numbers.json"
MAP: Final = "iec104-map.csv"
LOOK_S: Final = 1.0
"""Longest wait for a change before it is seen whether the service is gone."""
KINDS: Final = (*(point.kind for point in POINTS), SINGLE)
"""Of the points of a motor, in the order of their addresses."""


def run(context: GatewayContext) -> None:
    """Serve until the service is gone."""
    settings = context.settings.gateways.iec104
    assert settings is not None  # noqa: S101 - it was started for them
    follower = context.follower()
    station = PlantStation(settings, context.settings.data_directory)
    try:
        while not context.stop.is_set():
            change = follower.next_change(context.stop, longest_s=LOOK_S)
            if change is not None:
                station.tell(change)
            context.tell(station.problem or follower.problem)
    finally:
        station.stop()
        follower.close()


class PlantStation:
    """The station with the points of all motors."""

    def __init__(self, settings: Iec104Settings, data_directory: Path) -> None:
        """Raises KeptFileError."""
        self._server = c104.Server(
            ip=str(settings.bind_address),
            port=settings.port,
            max_connections=settings.max_connections,
            transport_security=None if settings.tls is None else _security(settings.tls),
        )
        self._server.on_clock_sync(callable=_refuse_clock)
        self._place = f"{settings.bind_address}:{settings.port}"
        station = self._server.add_station(common_address=settings.common_address)
        assert station is not None  # noqa: S101 - it is the first one
        self._station = station
        self._numbers = MotorNumbers(data_directory / NUMBERS)
        self._map = data_directory / MAP
        self._points: dict[str, list[c104.Point]] = {}
        self._said: dict[int, Said] = {}
        self.problem: str | None = "it starts"

    def tell(self, change: PlantChange) -> None:
        """Tell what has changed to all who are connected; the first time, begin to listen."""
        numbers = self._numbers.of(change.now.motors)
        too_many = [name for name in change.now.motors if numbers[name] >= MOST_MOTORS]
        if change.before.motors.keys() != change.now.motors.keys():
            write_table(self._map, ("motor", "first address"), _map_rows(numbers))
        for motor in change.now.motors.values():
            if numbers[motor.name] < MOST_MOTORS:
                self._tell_motor(motor, numbers[motor.name], change.now)
        for name in change.motors_gone:
            for point in self._points.get(name, []):
                self._put(point, GONE)
        if not self._server.is_running:
            try:
                self._server.start()
            except RuntimeError as error:
                self.problem = f"{self._place}: {error}"
                return
            log.info("serving IEC 60870-5-104", place=self._place)
        self.problem = None
        if too_many:
            self.problem = f"{len(too_many)} motors have no addresses: there is room for {MOST_MOTORS}"

    def stop(self) -> None:
        """End every connection."""
        self._server.stop()

    def _tell_motor(self, motor: MotorFigures, number: int, state: PlantState) -> None:
        points = self._points.get(motor.name)
        if points is None:
            points = [self._added(address(number, offset), kind) for offset, kind in enumerate(KINDS)]
            self._points[motor.name] = points
        for point, meant in zip(points, POINTS, strict=False):
            self._put(point, said_of(meant, motor))
        self._put(points[RELAY_ANSWERS], link_of(motor, state))

    def _added(self, place: int, kind: c104.Type) -> c104.Point:
        point = self._station.add_point(io_address=place, type=kind)
        assert point is not None  # noqa: S101 - each address is given once
        return point

    def _put(self, point: c104.Point, said: Said) -> None:
        """Keep a value, and send it to those who are connected where it is another one."""
        if self._said.get(point.io_address) == said:
            return
        self._said[point.io_address] = said
        point.info = said.information(point.type)
        if self._server.is_running and self._server.has_active_connections:
            point.transmit(cause=c104.Cot.SPONTANEOUS)


def _refuse_clock(server: c104.Server, ip: str, date_time: datetime) -> c104.ResponseState:
    """Refuse to set the clock: that of this machine is not the other system's to set."""
    del server, ip, date_time
    return c104.ResponseState.FAILURE


def _security(tls: Iec104Tls) -> c104.TransportSecurity:
    security = c104.TransportSecurity(validate=True, only_known=True)
    security.set_certificate(cert=str(tls.certificate), key=str(tls.key))
    security.set_ca_certificate(cert=str(tls.ca))
    for pinned in tls.pinned:
        security.add_allowed_remote_certificate(cert=str(pinned))
    security.set_version(min=c104.TlsVersion.TLS_1_2, max=c104.TlsVersion.TLS_1_2)
    return security


def _map_rows(numbers: Mapping[str, int]) -> list[tuple[str, int]]:
    """Return which addresses each motor has."""
    return [(motor, address(number, 0)) for motor, number in sorted(numbers.items(), key=lambda one: one[1])]

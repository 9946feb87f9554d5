"""The IEC 60870-5-104 gateway: follows the plant's state and tells changes by themselves."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

import structlog

from service.configuration.gateways.iec104 import Iec104Settings
from service.gateways.context import GatewayContext
from service.gateways.iec104.points import (
    GONE,
    LIKELY_PHASES,
    MOST_MOTORS,
    POINTS,
    SINGLE,
    Said,
    address,
    link_of,
    said_of,
)
from service.gateways.iec104.security import Security, TlsFileError
from service.gateways.iec104.server import StationServer
from service.gateways.iec104.telegrams import Value
from service.gateways.kept_file import write_table
from service.gateways.numbering import MotorNumbers
from service.gateways.plant_state.figures import MotorFigures, PlantChange, PlantState

log = structlog.get_logger(__name__)

NUMBERS: Final = "iec104-numbers.json"
MAP: Final = "iec104-map.csv"
LOOK_S: Final = 1.0
"""Longest wait for a change before it is seen whether the service is gone."""
KINDS: Final = (*(point.kind for point in POINTS), SINGLE, *(point.kind for point in LIKELY_PHASES))
"""Of the points of a motor, in the order of their addresses."""


def run(context: GatewayContext) -> None:
    """Serve until the service is gone."""
    settings = context.settings.gateways.iec104
    assert settings is not None  # noqa: S101 - it was started for them
    station = _made(context, settings)
    if station is None:
        return
    follower = context.follower()
    try:
        while not context.stop.is_set():
            change = follower.next_change(context.stop, longest_s=LOOK_S)
            if change is not None:
                station.tell(change)
            station.listen()
            context.tell(station.problem or follower.problem)
    finally:
        station.stop()
        follower.close()


def _made(context: GatewayContext, settings: Iec104Settings) -> "PlantStation | None":
    """Return the station as soon as the files of TLS can be used; None where the service is gone before.

    Raises KeptFileError.
    """
    while not context.stop.is_set():
        try:
            return PlantStation(settings, context.settings.data_directory)
        except TlsFileError as error:
            context.tell(str(error))
            context.stop.wait(LOOK_S)
    return None


class PlantStation:
    """The station with the points of all motors."""

    def __init__(self, settings: Iec104Settings, data_directory: Path) -> None:
        """Raises KeptFileError, TlsFileError."""
        self._server = StationServer(
            str(settings.bind_address),
            settings.port,
            station=settings.common_address,
            max_connections=settings.max_connections,
            security=None if settings.tls is None else Security.of(settings.tls),
        )
        self._place = f"{settings.bind_address}:{settings.port}"
        self._numbers = MotorNumbers(data_directory / NUMBERS)
        self._map = data_directory / MAP
        self._said: dict[int, Said] = {}
        self._is_known = False
        self._too_many = 0
        self._deaf: str | None = "it starts"

    @property
    def problem(self) -> str | None:
        """Return what does not work; None while all does."""
        if self._deaf is not None:
            return self._deaf
        if self._too_many:
            return f"{self._too_many} motors have no addresses: there is room for {MOST_MOTORS}"
        return None

    def tell(self, change: PlantChange) -> None:
        """Tell what has changed to all who are connected."""
        numbers = self._numbers.of(change.now.motors)
        self._too_many = sum(numbers[name] >= MOST_MOTORS for name in change.now.motors)
        if change.before.motors.keys() != change.now.motors.keys():
            write_table(self._map, ("motor", "first address"), _map_rows(numbers))
        values: dict[int, Value] = {}
        for motor in change.now.motors.values():
            if numbers[motor.name] < MOST_MOTORS:
                values |= self._changed(numbers[motor.name], _said_of_motor(motor, change.now))
        for name in change.motors_gone:
            if numbers[name] < MOST_MOTORS:
                values |= self._changed(numbers[name], [GONE] * len(KINDS))
        self._server.put(values)
        self._is_known = True

    def listen(self) -> None:
        """Begin to listen as soon as the plant is known; where that cannot be, the next call tries again."""
        if self._server.is_listening or not self._is_known:
            return
        try:
            self._server.start()
        except OSError as error:
            self._deaf = f"{self._place}: {error.strerror or error}"
            return
        self._deaf = None
        log.info("serving IEC 60870-5-104", place=self._place)

    def stop(self) -> None:
        """End every connection."""
        self._server.stop()

    def _changed(self, number: int, said: Sequence[Said]) -> dict[int, Value]:
        """Return the points of a motor that tell something else than before, by their addresses."""
        changed = {}
        for offset, (kind, one) in enumerate(zip(KINDS, said, strict=True)):
            place = address(number, offset)
            if self._said.get(place) != one:
                self._said[place] = one
                changed[place] = one.value(kind)
        return changed


def _said_of_motor(motor: MotorFigures, state: PlantState) -> list[Said]:
    said, likely = ([said_of(point, motor, state) for point in points] for points in (POINTS, LIKELY_PHASES))
    return [*said, link_of(motor, state), *likely]


def _map_rows(numbers: Mapping[str, int]) -> list[tuple[str, int]]:
    """Return which addresses each motor has."""
    return [(motor, address(number, 0)) for motor, number in sorted(numbers.items(), key=lambda one: one[1])]

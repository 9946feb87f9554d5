"""The IEC 60870-5-104 gateway: follows the plant's state and tells changes by themselves."""

import ssl
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

import structlog
from cryptography import x509
from cryptography.hazmat.primitives.serialization import Encoding

from service.configuration.gateways.iec104 import Iec104Settings, Iec104Tls
from service.gateways.context import GatewayContext
from service.gateways.iec104.points import (
    GONE,
    MOST_MOTORS,
    POINTS,
    SINGLE,
    Said,
    address,
    link_of,
    said_of,
)
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
KINDS: Final = (*(point.kind for point in POINTS), SINGLE)
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


class TlsFileError(ValueError):
    """A file of TLS cannot be used; it says why."""


class PlantStation:
    """The station with the points of all motors."""

    def __init__(self, settings: Iec104Settings, data_directory: Path) -> None:
        """Raises KeptFileError, TlsFileError."""
        tls, pinned = (None, frozenset()) if settings.tls is None else _security(settings.tls)
        self._server = StationServer(
            str(settings.bind_address),
            settings.port,
            station=settings.common_address,
            max_connections=settings.max_connections,
            tls=tls,
            pinned=pinned,
        )
        self._place = f"{settings.bind_address}:{settings.port}"
        self._numbers = MotorNumbers(data_directory / NUMBERS)
        self._map = data_directory / MAP
        self._said: dict[int, Said] = {}
        self.problem: str | None = "it starts"

    def tell(self, change: PlantChange) -> None:
        """Tell what has changed to all who are connected; the first time, begin to listen."""
        numbers = self._numbers.of(change.now.motors)
        too_many = [name for name in change.now.motors if numbers[name] >= MOST_MOTORS]
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
        if not self._server.is_listening:
            try:
                self._server.start()
            except OSError as error:
                self.problem = f"{self._place}: {error.strerror}"
                return
            log.info("serving IEC 60870-5-104", place=self._place)
        self.problem = None
        if too_many:
            self.problem = f"{len(too_many)} motors have no addresses: there is room for {MOST_MOTORS}"

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
    return [*(said_of(point, motor, state) for point in POINTS), link_of(motor, state)]


def _security(tls: Iec104Tls) -> tuple[ssl.SSLContext, frozenset[bytes]]:
    """Return the server's side of TLS, and the clients that may connect. Raises TlsFileError."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.minimum_version = ssl.TLSVersion.TLSv1_2
    context.verify_mode = ssl.CERT_REQUIRED
    named = tls.certificate
    try:
        context.load_cert_chain(named, tls.key)
        named = tls.ca
        context.load_verify_locations(named)
        pinned = set()
        for named in tls.pinned:
            octets = named.read_bytes()
            is_text = octets.lstrip().startswith(b"-----BEGIN")
            load = x509.load_pem_x509_certificate if is_text else x509.load_der_x509_certificate
            pinned.add(load(octets).public_bytes(Encoding.DER))
    except (OSError, ValueError) as error:  # that of TLS is one of the system, too
        raise TlsFileError(f"gateways.iec104.tls: {named}: {error}") from error
    return context, frozenset(pinned)


def _map_rows(numbers: Mapping[str, int]) -> list[tuple[str, int]]:
    """Return which addresses each motor has."""
    return [(motor, address(number, 0)) for motor, number in sorted(numbers.items(), key=lambda one: one[1])]
